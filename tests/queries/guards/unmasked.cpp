// Every call of trees and scenes with all exceptions unmasked, inexact results and subnormal operands as well: none
// ends the program. The gate `matrix` compares the names with the public headers.
#include <raylanes/raylanes.h>
#include <unistd.h>

#include <csignal>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/closed_mesh.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/scene_d.hpp>
#include <raylanes/sphere_tree.hpp>

#include "../../doubles/double_cases.hpp"
#include "../../support/filtered.hpp"
#include "../query_trees.hpp"
#include "traps.hpp"

namespace raylanes::testing {
namespace {

// The calls of a class, by its name and theirs.
using Calls = std::map<std::string, std::function<void()>>;

const char* running = "";
void say_what_ran(int) {
  const auto ignored = write(STDERR_FILENO, running, std::strlen(running));
  _exit(ignored < 0 ? 3 : 2);
}

void run(const Calls& calls) {
  const auto before = std::signal(SIGFPE, say_what_ran);
  for (const auto& [name, call] : calls) {
    running = name.c_str();
    const Traps traps(FE_ALL_EXCEPT);
    call();
  }
  std::signal(SIGFPE, before);
}

template <class T>
std::vector<RayOf<T>> some_rays() {
  Random random(801);
  constexpr T tiny = std::numeric_limits<T>::denorm_min(), huge = std::numeric_limits<T>::max();
  const T odd[] = {0,
                   -T(0),
                   tiny,
                   huge,
                   -huge,
                   std::numeric_limits<T>::infinity(),
                   std::numeric_limits<T>::quiet_NaN(),
                   std::numeric_limits<T>::signaling_NaN(),
                   T(1) / 3};
  std::vector<RayOf<T>> rays(600);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Float3 origin = random.point(2), direction = random.point(1);
    for (std::size_t k = 0; k < 3; ++k) rays[i].origin[k] = origin[k], rays[i].direction[k] = direction[k];
    if (i % 5 == 0) rays[i].origin[i % 3] = odd[i / 5 % std::size(odd)];
    if (i % 7 == 0) rays[i].direction[i % 3] = odd[i / 7 % std::size(odd)];
    if (i % 11 == 0)
      rays[i].tmin = -odd[i / 11 % std::size(odd)], rays[i].tmax = odd[i / 22 % std::size(odd)];
  }
  return rays;
}

// The arrays that queries read and write.
template <class T, class AnyHit>
struct Batch {
  std::vector<RayOf<T>> rays = some_rays<T>();
  RayColumns<RayOf<T>> columns{rays};
  RayArraysOf<T> arrays = columns.view();
  std::vector<std::array<T, 3>> points;
  std::vector<AnyHit> hits{rays.size()};
  std::vector<std::uint8_t> occluded = std::vector<std::uint8_t>(rays.size());
  std::vector<CrossingCount> counts{rays.size()};
  std::vector<Location> locations{rays.size()};
  std::vector<ClosestPointOf<T>> closest{rays.size()};
  std::vector<T> numbers = std::vector<T>(rays.size());

  Batch() {
    for (const auto& ray : rays) points.push_back(ray.origin);
  }
};

// `rest` is what calls take before their options: the test of primitives.
template <class T, class AnyHit, class Tree, class Options, class... Rest>
void add_nearest(Calls& calls, const std::string& of, const Tree& tree, Batch<T, AnyHit>& b,
                 const Options& by, const Rest&... rest) {
  calls[of + "::closest"] = [&, by] {
    for (const auto& ray : b.rays) tree.closest(ray, rest..., by);
    tree.closest(b.rays, b.hits, rest..., by);
    Options again = by;
    again.skip = b.hits;
    tree.closest(b.rays, b.hits, rest..., again);
    again.after = b.hits;
    tree.closest(b.rays, b.hits, rest..., again);
    again.skip = b.hits[0], again.after = b.hits[0];
    tree.closest(b.rays[0], rest..., again);
    if constexpr (sizeof...(rest) == 0) {
      tree.closest(b.arrays, b.hits, by), tree.closest(b.rays, b.hits, reject_even<AnyHit>, by);
      tree.closest(
          b.rays[0], [](const AnyHit& hit) { return hit.primitive % 2 == 0; }, by);
    }
  };
  calls[of + "::occluded"] = [&, by] {
    for (const auto& ray : b.rays) tree.occluded(ray, rest..., by);
    tree.occluded(b.rays, b.occluded, rest..., by);
    if constexpr (sizeof...(rest) == 0) {
      tree.occluded(b.arrays, b.occluded, by), tree.occluded(b.rays, b.occluded, reject_even<AnyHit>, by);
      tree.occluded(
          b.rays[0], [](const AnyHit& hit) { return hit.primitive % 2 == 0; }, by);
    }
  };
  if constexpr (sizeof...(rest) == 0)
    calls[of + "::occluded_from"] = [&, by] {
      tree.occluded_from(b.points[1], b.points, b.occluded, {}, by);
      tree.occluded_from(b.points[1], b.points, b.occluded, reject_even<AnyHit>, {}, by);
    };
  if constexpr (sizeof...(rest) == 0)
    calls[of + "::occluded_towards"] = [&, by] {
      tree.occluded_towards(b.points[1], b.points, b.occluded, by);
    };
  if constexpr (requires { tree.calls(by); })
    calls[of + "::calls"] = [&, by] {
      const auto prepared = tree.calls(by);
      for (const auto& ray : b.rays) prepared.closest(ray), prepared.occluded(ray);
    };
  if constexpr (requires { tree.closest_crossing(b.rays[0], by); })
    calls[of + "::closest_crossing"] = [&, by] {
      for (const auto& ray : b.rays) tree.closest_crossing(ray, by);
      tree.closest_crossing(b.rays, b.hits, by);
    };
  calls[of + "::bounds"] = [&] { tree.bounds(); };
  calls[of + "::bytes"] = [&] { tree.bytes(); };
}

// The calls with points; `closest` are for their results.
template <class T, class AnyHit, class Tree, class Closest>
void add_points(Calls& calls, const std::string& of, const Tree& tree, Batch<T, AnyHit>& b,
                std::vector<Closest>& closest, const Path* path, int threads) {
  calls[of + "::locate"] = [&, path, threads] {
    for (std::size_t rule = 0; rule < inside_rule_names.size(); ++rule)
      tree.locate(b.points, b.locations,
                  {.rule = static_cast<InsideRule>(rule), .path = path, .threads = threads});
  };
  calls[of + "::winding_numbers"] = [&, path, threads] {
    tree.winding_numbers(b.points, b.numbers, {.path = path, .threads = threads});
  };
  calls[of + "::closest_points"] = [&, path, threads] {
    tree.closest_points(b.points, closest, {.path = path, .threads = threads});
  };
  calls[of + "::closest_point"] = [&, path] {
    for (const auto& point : b.points) tree.closest_point(point, {.path = path});
    tree.closest_point(b.points[0]);
  };
  calls[of + "::signed_distances"] = [&, path, threads] {
    for (std::size_t rule = 0; rule < inside_rule_names.size(); ++rule)
      tree.signed_distances(b.points, b.numbers,
                            {.rule = static_cast<InsideRule>(rule), .path = path, .threads = threads});
  };
}

template <class T, class Tree>
void add_queries(Calls& calls, const std::string& of, const Tree& tree, Batch<T, HitOf<T>>& b,
                 const Path* path, int threads) {
  const ListOptions lists{.path = path, .threads = threads};
  calls[of + "::all_hits"] = [&, lists] { tree.all_hits(b.rays, lists), tree.all_hits(b.arrays, lists); };
  calls[of + "::crossings"] = [&, lists] { tree.crossings(b.rays, lists), tree.crossings(b.arrays, lists); };
  calls[of + "::count_crossings"] = [&, lists] { tree.count_crossings(b.rays, b.counts, lists); };
  add_points<T>(calls, of, tree, b, b.closest, path, threads);
  calls[of + "::corners"] = [&] {
    std::vector<std::conditional_t<sizeof(T) == 4, Triangle, TriangleD>> triangles(b.hits.size());
    tree.corners(b.hits, triangles);
  };
  calls[of + "::report"] = [&] { tree.report(); };
  calls[of + "::node_count"] = [&] { tree.node_count(); };
  calls[of + "::leaf_count"] = [&] { tree.leaf_count(); };
  const auto reloaded = [&] {
    std::stringstream file;
    tree.save(file);
    return Tree::load(file);
  };
  calls[of + "::save"] = calls[of + "::load"] = [=] { reloaded(); };
}

// The calls of trees that follow their mesh.
template <class Tree, class AnyMesh>
void add_refits(Calls& calls, const std::string& of, Tree& tree, const AnyMesh& mesh, int threads) {
  calls[of + "::refit"] = [&, threads] { tree.refit(mesh.vertices, mesh.triangles, threads); };
  calls[of + "::refitted"] = [&, threads] { tree.refitted(mesh.vertices, mesh.triangles, threads); };
  calls[of + "::sah_cost"] = [&] { tree.sah_cost(); };
  calls[of + "::decay"] = [&] { tree.decay(); };
  calls[of + "::" + of] = [&, threads] {
    for (std::size_t builder = 0; builder < tree_builder_names.size(); ++builder)
      for (const bool optimize : {false, true}) {
        const auto by = static_cast<TreeBuilder>(builder);
        if (by == TreeBuilder::spatial_splits && std::is_same_v<Tree, BvhD>) continue;
        Tree(mesh.vertices, mesh.triangles, {.builder = by, .threads = threads, .optimize = optimize});
      }
    Tree(mesh.vertices, mesh.triangles, {.threads = threads, .choose = true, .rays = 1e3});
    validate_mesh(mesh.vertices, mesh.triangles);
  };
}

// The calls of scenes of triangles, but nearest hits; part 0 is of the mesh.
template <class T, class AnyScene, class AnyMesh, class AnyHit, class Closest>
void add_scene(Calls& calls, const std::string& of, AnyScene& scene, const AnyMesh& mesh, Batch<T, AnyHit>& b,
               std::vector<Closest>& closest, const Path* path, int threads) {
  const ListOptions lists{.path = path, .threads = threads};
  const LocateOptions places{.path = path, .threads = threads};
  using Tree = std::conditional_t<sizeof(T) == 4, Bvh, BvhD>;
  const auto part = std::make_shared<const Tree>(mesh.vertices, mesh.triangles);
  calls[of + "::all_hits"] = [&, lists] { scene.all_hits(b.rays, lists), scene.all_hits(b.arrays, lists); };
  calls[of + "::crossings"] = [&, lists] { scene.crossings(b.arrays, lists); };
  calls[of + "::count_crossings"] = [&, lists] { scene.count_crossings(b.rays, b.counts, lists); };
  calls[of + "::normals"] = [&, threads] {
    std::vector<PointOf<T>> normals(b.hits.size());
    scene.normals(b.hits, normals, threads);
  };
  calls[of + "::corners"] = [&, threads] {
    std::vector<std::conditional_t<sizeof(T) == 4, Triangle, TriangleD>> triangles(b.hits.size());
    scene.corners(b.hits, triangles, threads);
  };
  add_points<T>(calls, of, scene, b, closest, path, threads);
  calls[of + "::innermost_parts"] = [&, places] {
    std::vector<ContainingPart> parts(b.points.size());
    scene.innermost_parts(b.points, parts, places);
  };
  calls[of + "::containing_parts"] = [&, places] { scene.containing_parts(b.points, places); };
  calls[of + "::place"] = calls[of + "::add"] = [part] {
    AnyScene other;
    other.add(part);
    using Numbers = std::numeric_limits<T>;
    for (const T x :
         {T(0), Numbers::denorm_min(), T(1) / 3, Numbers::max(), Numbers::infinity(), Numbers::quiet_NaN()})
      other.place(0, {{{1, x, 0, 1}, {0, T(0.3), x, 0}, {0, 0, 1, x}}});
    other.update(), other.bounds();
  };
  calls[of + "::replace"] = [&, part] { scene.replace(0, part), scene.update(); };
  calls[of + "::move"] = [&] {
    scene.move(1, {{{1, 0, 0, T(0.7)}, {0, T(0.3), 0, 0}, {0, 0, 1, 0}}}), scene.update();
  };
  calls[of + "::update"] = [&, threads] { scene.update(threads); };
  calls[of + "::set_mask"] = [&] { scene.set_mask(0, scene.mask_of(0)), scene.update(); };
  calls[of + "::tree"] = [&] { scene.tree(0); };
  calls[of + "::geometry_count"] = [&] { scene.geometry_count(); };
  calls[of + "::instance_count"] = [&] { scene.instance_count(); };
  calls[of + "::geometry_of"] = [&] { scene.geometry_of(0); };
  calls[of + "::transform_of"] = [&] { scene.transform_of(0); };
  calls[of + "::mask_of"] = [&] { scene.mask_of(0); };
  calls[of + "::refit"] = [&, threads] {
    scene.refit(0, mesh.vertices, mesh.triangles, threads), scene.update();
  };
  calls[of + "::set_triangle_masks"] = [&, path, threads] {
    const std::vector<std::uint32_t> masks(3, 1);
    AnyScene other = scene;
    other.set_triangle_masks(0, masks), other.update(threads);
    std::vector<typename AnyScene::Hit> hits(b.rays.size());
    other.closest(b.rays, hits, {.path = path, .threads = threads});
  };
  calls[of + "::set_moving"] = [&, threads] { scene.set_moving(1, true), scene.update(threads); };
  calls[of + "::report"] = [&] { scene.report(); };
  calls[of + "::levels_of"] = [&] { scene.levels_of(0); };
  calls[of + "::save"] = calls[of + "::load"] = [&] {
    std::stringstream file;
    scene.save(file), AnyScene::load(file);
  };
  calls[of + "::add of a scene"] = [&, threads] {
    using Numbers = std::numeric_limits<T>;
    AnyScene other;
    other.place(other.add(scene), {{{Numbers::max(), Numbers::denorm_min(), 0, Numbers::max()},
                                    {0, 3, 0, 0},
                                    {0, 0, Numbers::min() / 3, 1}}});
    other.update(threads);
  };
}

// Meshes with all that is odd: holes, tiny and huge coordinates, triangles without area; all on a line; nothing.
std::vector<Mesh> meshes() {
  Mesh odd = without(ellipsoid(2, {0, 0, 0}, {1.25f, 1, 1}), 0.1, 802), line, flat = cube(-1, 1);
  append(odd, make_triangle({0, 0, 0}, {0, 0, 0}, {1, 0, 0}));
  append(odd, make_triangle({1e-40f, 0, 0}, {0, 1e-42f, 0}, {1, 0, 1e-45f}));
  append(odd, make_triangle({1e38f, 0, 0}, {0, -3e38f, 0}, {1, 0, 1e30f}));
  for (int i = 0; i < 60; ++i) {
    const auto x = static_cast<float>(i) / 3;
    append(line, make_triangle({x, 0, 0}, {x + 0.1f, 0, 0}, {x + 0.3f, 0, 0}));
  }
  return {odd, flat, line, Mesh{}};
}

class Unmasked : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Traps::are_there()) GTEST_SKIP() << no_traps;
  }
};

TEST_F(Unmasked, trees) {
  for (const Mesh& mesh : meshes()) {
    Bvh bvh(mesh);
    const KdTree cells(mesh);
    on_each_path([&](const Path* path, int threads) {
      Batch<float, Hit> b;
      Calls calls;
      for (const TraversalMode mode :
           {TraversalMode::automatic, TraversalMode::single, TraversalMode::packet, TraversalMode::stream}) {
        const TraceOptions by{.mode = mode, .path = path, .threads = threads};
        add_nearest<float>(calls, "Bvh", bvh, b, by), add_nearest<float>(calls, "KdTree", cells, b, by);
        run(calls);
      }
      add_queries<float>(calls, "Bvh", bvh, b, path, threads);
      add_queries<float>(calls, "KdTree", cells, b, path, threads);
      add_refits(calls, "Bvh", bvh, mesh, threads);
      calls["Bvh::view"] = [&] { bvh.view(); };
      calls["KdTree::view"] = [&] { cells.view(); };
      calls["KdTree::KdTree"] = [&] {
        for (const KdBuilder builder : {KdBuilder::sah, KdBuilder::midpoint})
          KdTree(mesh, {.builder = builder, .threads = threads});
      };
      calls["closed_report"] = [&] { closed_report(mesh.vertices, mesh.triangles), is_closed(mesh); };
      run(calls);
    });
  }
}

TEST_F(Unmasked, trees_of_doubles) {
  for (const Mesh& floats : meshes()) {
    const DoubleMesh mesh = moved(floats, 1e-3, {5e6, -4e6, 1e-310});
    BvhD tree(mesh.vertices, mesh.triangles);
    on_each_path([&](const Path* path, int threads) {
      Batch<double, HitD> b;
      Calls calls;
      add_nearest<double>(calls, "BvhD", tree, b, TraceOptionsD{.path = path, .threads = threads});
      add_queries<double>(calls, "BvhD", tree, b, path, threads);
      add_refits(calls, "BvhD", tree, mesh, threads);
      calls["BvhD::each_triangle"] = [&] {
        tree.each_triangle([](std::uint32_t, const std::array<Double3, 3>&) {});
      };
      run(calls);
    });
  }
}

TEST_F(Unmasked, scenes_of_doubles) {
  const DoubleMesh mesh = moved(cube(-1, 1), 1, {0, 0, 0});  // few triangles: integers take their time
  on_each_path([&](const Path* path, int threads) {
    for (const bool stands : {true, false}) {
      Batch<double, SceneHitD> b;
      std::vector<SceneClosestPointD> closest(b.points.size());
      Calls calls;
      SceneD scene;
      scene.add(mesh.vertices, mesh.triangles), scene.place(0);
      scene.place(0, stands ? TransformD() : TransformD{{{1, 0, 0, 1}, {0, 0.3, 0, 0}, {0, 0, 1, 1e-310}}});
      scene.update(threads);
      add_nearest<double>(calls, "SceneD", scene, b, TraceOptionsD{.path = path, .threads = threads});
      add_scene<double>(calls, "SceneD", scene, mesh, b, closest, path, threads);
      run(calls);
    }
  });
}

TEST_F(Unmasked, scenes_spheres_and_boxes) {
  Random random(803);
  std::vector<Sphere> spheres(100);
  for (Sphere& sphere : spheres) sphere = {random.point(1), random.number(-0.1f, 0.3f)};
  spheres[0].radius = infinity, spheres[1].centre[0] = 1e-42f, spheres[2].radius = std::nanf("");
  std::vector<Box> boxes(100);
  for (Box& box : boxes) box.lo = random.point(1), box.hi = {box.lo[0] + 0.1f, box.lo[1] + 0.2f, 1e-43f};
  const auto never = [](std::uint32_t, const Ray&, Hit&) { return false; };
  const Mesh mesh = meshes()[0], ball = ellipsoid(2, {0, 0, 0}, {1, 1, 1});
  on_each_path([&](const Path* path, int threads) {
    Batch<float, Hit> b;
    Batch<float, SceneHit> of_scene;
    const SphereTree tree(spheres);
    const BoundedTree bounded(boxes);
    Scene scene, solid;
    scene.add(Bvh(mesh)), scene.add(SphereTree(spheres)), solid.add(Bvh(ball));
    scene.place(0), scene.place(1), solid.place(0),
        solid.place(0, {{{1, 0, 0, 1}, {0, 0.3f, 0, 0}, {0, 0, 1, 1e-42f}}});
    scene.update(), solid.update();
    Calls calls;
    const VisitOptions visit{.path = path, .threads = threads};
    add_nearest<float>(calls, "SphereTree", tree, b, visit);
    add_nearest<float>(calls, "BoundedTree", bounded, b, visit, never);
    add_nearest<float>(calls, "Scene", scene, of_scene, TraceOptions{.path = path, .threads = threads});
    calls.erase("Scene::closest_crossing");  // of triangles alone
    calls["SphereTree::size"] = [&] { tree.size(); };
    calls["SphereTree::left_out"] = [&] { tree.left_out(); };
    calls["SphereTree::SphereTree"] = [&] { SphereTree(spheres, {.threads = threads}); };
    calls["BoundedTree::size"] = [&] { bounded.size(); };
    calls["BoundedTree::order"] = [&] { bounded.order(); };
    calls["BoundedTree::BoundedTree"] = [&] { BoundedTree(boxes, {.threads = threads, .slack = 1e-3f}); };
    run(calls);
    calls.clear();
    add_nearest<float>(calls, "Scene", solid, of_scene, TraceOptions{.path = path, .threads = threads});
    std::vector<SceneClosestPoint> closest(of_scene.points.size());
    add_scene<float>(calls, "Scene", solid, ball, of_scene, closest, path, threads);
    calls["Scene::all_hits of spheres"] = [&] {
      scene.all_hits(of_scene.rays, {.path = path, .threads = threads});
    };
    calls["Scene::add of others"] = [&] {
      Scene().add(SphereTree(spheres));
      std::stringstream file;
      scene.save(file), Scene::load(file);
    };
    run(calls);
  });
}

// Options of C are doubles where C++ has floats.
TEST_F(Unmasked, the_interface_of_c) {
  const Mesh mesh = meshes()[0];
  const Batch<float, Hit> b;
  Calls calls;
  calls["raylanes_bvh"] = [&] {
    raylanes_bvh* tree = nullptr;
    ASSERT_EQ(raylanes_bvh_create(&tree, mesh.vertices.data(), mesh.vertices.size(), 0, mesh.triangles.data(),
                                  mesh.triangles.size(), 0, nullptr),
              RAYLANES_OK);
    raylanes_point_options options;
    raylanes_init_point_options(&options, sizeof options);
    std::vector<float> distances(b.points.size());
    for (const double most : {1e-310, 0.1, 1e300}) {
      options.max_distance = most;
      raylanes_bvh_signed_distances(tree, b.points.data(), b.points.size(), 0, distances.data(), &options);
    }
    raylanes_bvh_destroy(tree);
  };
  calls["raylanes_scene"] = [&] {
    raylanes_scene* scene = nullptr;
    std::uint32_t part = 0;
    ASSERT_EQ(raylanes_scene_create(&scene), RAYLANES_OK);
    raylanes_scene_add_mesh(scene, mesh.vertices.data(), mesh.vertices.size(), 0, mesh.triangles.data(),
                            mesh.triangles.size(), 0, nullptr, &part);
    for (const float x : {0.0f, 1e-42f, 1.0f / 3, 3e38f, infinity}) {
      const float transform[] = {1, x, 0, 1, 0, 0.3f, x, 0, 0, 0, 1, x};
      raylanes_scene_place(scene, part, transform, ~0u, &part);
      part = 0;
    }
    ASSERT_EQ(raylanes_scene_update(scene, 1), RAYLANES_OK);
    std::vector<SceneHit> hits(b.rays.size());
    raylanes_scene_closest(scene, b.rays.data(), b.rays.size(), 0, hits.data(), 0, nullptr);
    for (const Ray& ray : b.rays) {
      const void* const given = &ray;
      void* const hit = hits.data();
      raylanes_scene_closest1(scene, static_cast<const raylanes_ray*>(given),
                              static_cast<raylanes_scene_hit*>(hit), nullptr);
    }
    raylanes_scene_destroy(scene);
  };
  const Batch<double, HitD> of_doubles;
  const DoubleMesh wide = moved(mesh, 1, {});
  calls["raylanes_scene_d"] = [&] {
    raylanes_scene_d* scene = nullptr;
    std::uint32_t part = 0;
    ASSERT_EQ(raylanes_scene_d_create(&scene), RAYLANES_OK);
    raylanes_scene_d_add_mesh(scene, wide.vertices.data(), wide.vertices.size(), 0, wide.triangles.data(),
                              wide.triangles.size(), 0, nullptr, &part);
    for (const double x : {0.0, 1e-310, 1.0 / 3, 1e308, HUGE_VAL}) {
      const double transform[] = {1, x, 0, 1, 0, 0.3, x, 0, 0, 0, 1, x};
      raylanes_scene_d_place(scene, 0, transform, ~0u, &part);
    }
    ASSERT_EQ(raylanes_scene_d_update(scene, 1), RAYLANES_OK);
    std::vector<SceneHitD> hits(of_doubles.rays.size());
    raylanes_scene_d_closest(scene, of_doubles.rays.data(), hits.size(), 0, hits.data(), 0, nullptr);
    raylanes_scene_d_destroy(scene);
  };
  run(calls);
}

}  // namespace
}  // namespace raylanes::testing
