// Callers may let floating-point exceptions trap: no call does, and the traps are there again behind it.
#include <sstream>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/boxes.hpp>
#include <raylanes/closed_mesh.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/points.hpp>
#include <raylanes/roots.hpp>
#include <raylanes/scene.hpp>
#include <raylanes/sphere_tree.hpp>
#include <raylanes/spheres.hpp>

#include "../../doubles/double_cases.hpp"
#include "../query_trees.hpp"
#include "traps.hpp"

namespace raylanes::testing {
namespace {

std::vector<Float3> origins_of(const std::vector<Ray>& rays) {
  std::vector<Float3> points;
  for (const Ray& ray : rays) points.push_back(ray.origin);
  return points;
}

// Along axes, in planes of triangles, from corners, and anywhere.
std::vector<Ray> rays_of_all_kinds(const Mesh& mesh, std::size_t count) {
  Random random(501);
  std::vector<Ray> rays = mixed_rays(mesh, count, 2, {0, 0, 0}, 502);
  for (std::size_t i = 0; i < rays.size(); i += 3) {
    rays[i].direction = {0, 0, 0};
    rays[i].direction[random.index(3)] = 1;
    if (i % 2 == 0) rays[i].origin = mesh.vertices[i % mesh.vertices.size()];
  }
  return rays;
}

template <class Tree>
void ask_all(const Tree& tree, const std::vector<Ray>& rays, const Path* path, int threads) {
  const std::vector<Float3> points = origins_of(rays);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  std::vector<CrossingCount> counts(rays.size());
  std::vector<Location> locations(rays.size());
  std::vector<ClosestPoint> closest(rays.size());
  std::vector<float> numbers(rays.size());
  const Traps traps;
  for (const TriangleTestInfo& info : triangle_tests) {
    if (!info.serves_trees) continue;
    for (const TraversalMode mode :
         {TraversalMode::automatic, TraversalMode::single, TraversalMode::packet, TraversalMode::stream}) {
      const TraceOptions options{.test = info.test, .mode = mode, .path = path, .threads = threads};
      tree.closest(rays, hits, options);
      tree.occluded(rays, occluded, options);
      tree.occluded_from({0.25f, 0.5f, 3}, points, occluded, {}, options);
      tree.occluded_from({3e38f, -3e38f, 1e-40f}, points, occluded, {}, options);
      tree.occluded_towards({3e38f, 1e-40f, 0}, points, occluded, options);
    }
  }
  for (std::size_t i = 0; i < 50; ++i) {
    tree.closest(rays[i], {.path = path}), tree.occluded(rays[i], {.path = path});
    tree.closest(rays[i], {.path = path, .facing = Facing::back});
    tree.closest_point(points[i], {.path = path});
  }
  tree.closest(rays, hits, {.grade = Grade::fast, .path = path, .threads = threads});
  tree.closest(rays, hits, {.path = path, .threads = threads, .facing = Facing::front});
  tree.closest(rays, hits, {.path = path, .threads = threads, .after = hits});
  const ListOptions lists{.path = path, .threads = threads};
  tree.all_hits(rays, lists), tree.crossings(rays, lists), tree.count_crossings(rays, counts, lists);
  tree.closest_points(points, closest, {.path = path, .threads = threads});
  tree.winding_numbers(points, numbers, {.path = path, .threads = threads});
  for (const InsideRule rule :
       {InsideRule::parity, InsideRule::nonzero, InsideRule::vote, InsideRule::winding}) {
    tree.locate(points, locations, {.rule = rule, .path = path, .threads = threads});
    tree.signed_distances(points, numbers, {.rule = rule, .path = path, .threads = threads});
  }
}

TEST(Trapped, trees_are_built_asked_and_saved) {
  if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  for (Mesh mesh : {without(ellipsoid(2, {0, 0, 0}, {1.25f, 1, 1}), 0.1, 503), cube(-1, 1), Mesh{}}) {
    const std::vector<Ray> rays =
        mesh.vertices.empty() ? std::vector<Ray>(60) : rays_of_all_kinds(mesh, rays_for_streams);
    if (!mesh.vertices.empty()) append(mesh, make_triangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0}));
    on_each_path([&](const Path* path, int threads) {
      const auto built = [&] {
        const Traps traps;
        closed_report(mesh.vertices, mesh.triangles);
        Bvh bvh(mesh, {.builder = TreeBuilder::spatial_splits, .threads = threads, .optimize = true});
        bvh = Bvh(mesh, {.threads = threads});
        bvh.refit(mesh.vertices, mesh.triangles, threads);
        bvh.sah_cost(), bvh.decay(), bvh.report();
        std::stringstream file;
        bvh.save(file);
        return Bvh::load(file);
      };
      ask_all(built(), rays, path, threads);
      ask_all(KdTree(mesh), rays, path, threads);
    });
  }
}

TEST(Trapped, trees_of_doubles_are_asked) {
  if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  const DoubleMesh mesh = moved(without(double_fan(24, 0.3f), 0.1, 506), 1e-3, {5e6, -4e6, 1e5});
  const std::vector<RayD> rays = aimed_rays(mesh, 200, 504);
  std::vector<Double3> points;
  for (const RayD& ray : rays) points.push_back(ray.origin);
  on_each_path([&](const Path* path, int threads) {
    std::vector<HitD> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    std::vector<Location> locations(rays.size());
    std::vector<ClosestPointD> closest(rays.size());
    std::vector<double> distances(rays.size());
    const Traps traps;
    BvhD tree(mesh.vertices, mesh.triangles, {.threads = threads});
    tree.refit(mesh.vertices, mesh.triangles, threads);
    std::stringstream file;
    tree.save(file);
    tree = BvhD::load(file);
    const TraceOptionsD options{.path = path, .threads = threads};
    tree.closest(rays, hits, options), tree.occluded(rays, occluded, options);
    tree.closest(rays[0], options), tree.occluded(rays[0], options);
    tree.all_hits(rays, {.path = path}), tree.crossings(rays, {.path = path});
    std::vector<double> numbers(rays.size());
    tree.winding_numbers(points, numbers, {.path = path, .threads = threads});
    for (const InsideRule rule : {InsideRule::parity, InsideRule::winding})
      tree.locate(points, locations, {.rule = rule, .path = path, .threads = threads});
    tree.closest_point(points[0], {.path = path});
    tree.closest_points(points, closest, {.path = path, .threads = threads});
    tree.signed_distances(points, distances, {.path = path, .threads = threads});
  });
}

TEST(Trapped, scenes_and_trees_of_primitives_are_asked) {
  if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  const Mesh mesh = ellipsoid(1, {0, 0, 0}, {1, 1, 1});
  const std::vector<Ray> rays = rays_of_all_kinds(mesh, 300);
  const std::vector<Sphere> spheres = {{{0, 0, 0}, 0.5f}, {{1, 0, 0}, 0.25f}, {{0, 1, 1}, -1}};
  on_each_path([&](const Path* path, int threads) {
    std::vector<SceneHit> hits(rays.size());
    std::vector<Hit> own(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    const Traps traps;
    Scene scene;
    scene.place(scene.add(Bvh(mesh)));
    scene.place(0, {{{1, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 1, 0}}});
    scene.place(scene.add(SphereTree(spheres)));
    scene.update();
    scene.closest(rays, hits, {.path = path, .threads = threads});
    scene.occluded(rays, occluded, {.path = path, .threads = threads});
    for (const Ray& ray : rays) {
      scene.closest(ray, {.path = path});
      scene.occluded(ray, {.path = path});
    }
    SphereTree(spheres).closest(rays, own, {.path = path, .threads = threads});
  });
}

// Roots do not mask. Normal numbers but the largest raise nothing to trap, in arrays that the instruction takes
// and in those that kernels take, tails included.
template <class T>
void take_roots(const Path* path) {
  const T least = std::numeric_limits<T>::min(), most = std::numeric_limits<T>::max() / 4;
  for (const T number : {least, 2 * least, T(0.25), T(3), most / 2, most})
    for (const std::size_t size : {1, 16, 17, 100, 1000}) {
      std::vector<T> x(size, T(3)), y(size);
      x[size / 2] = number;
      const Traps traps;
      for (const AccuracyInfo& info : accuracies) {
        sqrt(std::span<const T>(x), std::span<T>(y), info.accuracy, path);
        reciprocal(std::span<const T>(x), std::span<T>(y), info.accuracy, path);
        if (sizeof(T) == sizeof(float) || info.accuracy != Accuracy::correctly_rounded)
          rsqrt(std::span<const T>(x), std::span<T>(y), info.accuracy, path);
      }
    }
}

TEST(Trapped, roots_of_normal_numbers_are_taken) {
  if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  on_each_path([&](const Path* path, int) {
    take_roots<float>(path);
    take_roots<double>(path);
  });
}

// The flags of arrays with one special number, as docs/guide/arrays.md names them. Methods refine estimates of it
// before they see that it is special: they may raise invalid and overflow. The instruction raises what IEEE 754 says.
template <class T, class Method>
void raise_flags(const Path* path, Method hardware) {
  const T infinity = std::numeric_limits<T>::infinity(), least = std::numeric_limits<T>::denorm_min();
  const auto flags_of = [](const auto& call) {
    feclearexcept(FE_ALL_EXCEPT);
    call();
    return fetestexcept(usual_traps);
  };
  for (const T number : {T(0), -T(0), infinity, -infinity, T(-2), least, std::numeric_limits<T>::quiet_NaN()})
    for (const std::size_t size : {1, 16, 17, 100, 1000})
      for (const AccuracyInfo& info : accuracies) {
        std::vector<T> values(size, T(3)), y(size);
        values[size / 2] = number;
        const std::span<const T> x(values);
        const int of_roots = flags_of([&] { sqrt(x, std::span<T>(y), info.accuracy, path); });
        EXPECT_EQ(of_roots & FE_DIVBYZERO, 0) << number << " of " << size << " on " << path->name;
        const bool is_exact = number >= 0 || std::isnan(number);
        if (size <= 16 && is_exact) {
          EXPECT_EQ(of_roots, 0) << number << " of " << size;
        }
        const int of_reciprocals = flags_of([&] { reciprocal(x, std::span<T>(y), info.accuracy, path); });
        if (number != 0) {
          EXPECT_EQ(of_reciprocals & FE_DIVBYZERO, 0) << number << " on " << path->name;
        }
        const int of_instruction = flags_of([&] { sqrt(x, std::span<T>(y), hardware, path); });
        EXPECT_EQ(of_instruction, number < 0 ? FE_INVALID : 0) << number << " on " << path->name;
      }
}

TEST(Trapped, roots_of_special_numbers_raise_the_flags_of_the_page) {
  on_each_path([&](const Path* path, int) {
    raise_flags<float>(path, SqrtMethod::hardware);
    raise_flags<double>(path, DoubleSqrtMethod::hardware);
  });
}

TEST(Trapped, arrays_are_asked) {
  if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  constexpr std::size_t n = 37;
  std::vector<float> number[9], out[6];
  Random random(505);
  for (std::vector<float>& numbers : number)
    for (std::size_t i = 0; i < n; ++i) numbers.push_back(random.number(-2, 2));
  for (std::vector<float>& numbers : out) numbers.resize(n);
  const auto at = [&](int k) { return static_cast<const float*>(number[k].data()); };
  const TriangleArrays triangles{{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}}, n};
  const BoxArrays boxes{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, n};
  const SphereArrays spheres{{at(0), at(1), at(2)}, at(3), n};
  const RayArrays rays{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, at(6), at(7), n};
  std::vector<std::uint8_t> bits((n + 7) / 8);
  const Ray along_axis = make_ray({0, 0, 0}, {1, 0, 0}), anywhere = make_ray({0, 0, 0}, {1, 0.5f, 0.25f});
  on_each_path([&](const Path* path, int) {
    const Traps traps;
    for (const Ray& ray : {along_axis, anywhere})
      for (const Grade grade : {Grade::reproducible, Grade::fast}) {
        for (const TriangleTestInfo& info : triangle_tests) {
          const TriangleOptions options{info.test, grade, path};
          closest_hit(ray, triangles, options), hit_mask(ray, triangles, bits, options);
          closest_hits(rays, floor_triangle, {bits, out[0], out[1], out[2]}, options);
        }
        for (const BoxTestInfo& info : box_tests) {
          hit_mask(ray, boxes, bits, {info.test, grade, path});
          intervals(ray, boxes, bits, out[0], out[1], {info.test, grade, path});
          hit_mask(rays, {{-1, -1, -1}, {1, 1, 1}}, bits, {info.test, grade, path});
        }
        for (const SphereTestInfo& info : sphere_tests) {
          hit_mask(ray, spheres, bits, {info.test, grade, path});
          closest_hit(ray, spheres, {info.test, grade, path});
          distances(ray, spheres, bits, out[0], out[1], {info.test, grade, path});
        }
        line_hits(ray, spheres, bits, {.path = path});
      }
    closest_point({1, 2, 3}, triangles, {.path = path});
    distances({1, 2, 3}, triangles, {out[0], {out[1], out[2], out[3]}, out[4], out[5]}, {.path = path});
  });
}

}  // namespace
}  // namespace raylanes::testing
