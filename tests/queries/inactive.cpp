// Inactive elements are neither read nor written: they lie in pages without access, in every call that takes a mask.
#include <raylanes/boxes.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/points.hpp>
#include <raylanes/scene.hpp>
#include <raylanes/sphere_tree.hpp>
#include <raylanes/spheres.hpp>

#include "../doubles/both_numbers.hpp"
#include "../support/system/guard_pages.hpp"
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

// Active are the elements before and behind so many others, whose bytes are whole pages whatever their size is.
constexpr std::size_t before = 67, inactive = 8192, behind = 73, all = before + inactive + behind;
constexpr bool is_active(std::size_t i) {
  return i < before || i >= before + inactive;
}

std::vector<std::uint8_t> make_mask() {
  std::vector<std::uint8_t> mask((all + 7) / 8, 0);
  for (std::size_t i = 0; i < all; ++i)
    if (is_active(i)) mask[i / 8] = static_cast<std::uint8_t>(mask[i / 8] | 1u << i % 8);
  return mask;
}
const std::vector<std::uint8_t> mask = make_mask();

template <class T>
class PagedArray {
 public:
  explicit PagedArray(const T& value = {}) {
    EXPECT_EQ(closed % page_size(), 0u);
    each([&](std::size_t i) { first_[i] = value; });
    memory_.forbid(lead(), closed);
  }

  // take(i) for active elements.
  template <class Take>
  static void each(const Take& take) {
    for (std::size_t i = 0; i < all; ++i)
      if (is_active(i)) take(i);
  }
  T* data() { return first_; }
  T& operator[](std::size_t i) { return first_[i]; }
  std::span<T> span() { return {first_, all}; }

 private:
  static constexpr std::size_t closed = inactive * sizeof(T);
  static std::size_t lead() { return (before * sizeof(T) + page_size() - 1) / page_size() * page_size(); }

  Pages memory_{lead() + closed + behind * sizeof(T)};
  T* first_ = reinterpret_cast<T*>(memory_.data() + lead()) - before;
};

// Rays and points, the former also as an array for each number; most points are in rows.
struct Elements {
  PagedArray<Ray> rays;
  PagedArray<RayD> double_rays;
  PagedArray<Float3> points;
  PagedArray<Double3> double_points;
  PagedArray<float> number[8];
  RayArrays arrays{{number[0].data(), number[1].data(), number[2].data()},
                   {number[3].data(), number[4].data(), number[5].data()},
                   number[6].data(),
                   number[7].data(),
                   all};

  Elements() {
    Random random(301);
    Float3 origin;
    PagedArray<Ray>::each([&](std::size_t i) {
      if (i % 40 == 0) origin = random.point(1.5f);
      const Float3 direction = random.point(1);
      rays[i] = make_ray(random.point(2), direction, 0, 100);
      points[i] = {random.number(-1.5f, 1.5f), origin[1], origin[2]};
      for (std::size_t k = 0; k < 3; ++k) {
        double_points[i][k] = double{points[i][k]};
        double_rays[i].origin[k] = double{rays[i].origin[k]};
        double_rays[i].direction[k] = double{direction[k]};
        number[k][i] = rays[i].origin[k], number[3 + k][i] = direction[k];
      }
      number[6][i] = 0, number[7][i] = 100;
    });
  }
  RayView view() { return {rays.data(), all}; }
  VertexView places() { return {points.data(), all, sizeof(Float3)}; }
  // Views of rays and points of numbers T.
  template <class T>
  auto of() {
    if constexpr (std::is_same_v<T, float>)
      return std::pair(view(), places());
    else
      return std::pair(RayViewD(double_rays.data(), all),
                       VertexViewD(double_points.data(), all, sizeof(Double3)));
  }
};

const auto reject_some = [](std::span<const std::size_t> rays, auto, std::span<std::uint8_t> rejected) {
  for (std::size_t k = 0; k < rays.size(); ++k) rejected[k] = static_cast<std::uint8_t>(rays[k] % 2);
};

// Hits, whether there are any, hits behind hits, and filters: of trees and scenes of any number.
template <class AnyHit, class Tree, class Rays, class Points, class Point, class Options>
void trace_all(const Tree& tree, const Rays& rays, const Points& points, const Point& from, Options options) {
  PagedArray<AnyHit> hits, next;
  PagedArray<std::uint8_t> occluded(9);
  const HitRecords<AnyHit> out(hits.data(), all), hits_after(next.data(), all);
  tree.closest(rays, out, options);
  tree.closest(rays, hits_after, reject_some, options);
  tree.occluded(rays, occluded.span(), options);
  tree.occluded(rays, occluded.span(), reject_some, options);
  tree.occluded_towards(from, points, occluded.span(), options);
  tree.occluded_towards(from, points, occluded.span(), reject_some, options);
  tree.occluded_from(from, points, occluded.span(), {}, options);
  tree.occluded_from(from, points, occluded.span(), reject_some, {}, options);
  PagedArray<AnyHit>::each([&](std::size_t i) { ASSERT_LE(occluded[i], 1); });
  options.after = out;
  tree.closest(rays, hits_after, options);
  std::size_t found = 0;
  PagedArray<AnyHit>::each([&](std::size_t i) { found += hits[i] ? 1 : 0; });
  EXPECT_GT(found, 20u);
}

// All calls of a tree of numbers T; trees of floats also in each mode, and of rays as arrays.
template <class T, class Tree>
void ask_all(Elements& elements, const Tree& tree) {
  const auto views = elements.of<T>();
  const auto& rays = views.first;
  const auto& points = views.second;
  on_each_path([&](const Path* path, int threads) {
    TraceOptionsOf<T> options{.path = path, .threads = threads, .active = mask.data()};
    if constexpr (std::is_same_v<T, float>) {
      for (const TraversalMode mode : {TraversalMode::packet, TraversalMode::stream}) {
        options.mode = mode;
        trace_all<Hit>(tree, rays, points, Float3{}, options);
      }
      options.mode = TraversalMode::automatic;
      PagedArray<Hit> hits;
      PagedArray<std::uint8_t> occluded;
      tree.closest(elements.arrays, HitView(hits.data(), all), options);
      tree.occluded(elements.arrays, occluded.span(), options);
    }
    trace_all<HitOf<T>>(tree, rays, points, PointOf<T>{}, options);
    const ListOptions lists{.path = path, .threads = threads, .active = mask.data()};
    PagedArray<CrossingCount> counts;
    EXPECT_GT(tree.all_hits(rays, lists).items.size(), 40u);
    EXPECT_GT(tree.crossings(rays, lists).items.size(), 40u);
    tree.count_crossings(rays, counts.span(), lists);
    PagedArray<Location> locations;
    for (std::size_t rule = 0; rule < inside_rule_names.size(); ++rule) {
      tree.locate(points, locations.span(),
                  {.rule = InsideRule(rule), .path = path, .threads = threads, .active = mask.data()});
      std::size_t inside = 0;
      PagedArray<Location>::each([&](std::size_t i) { inside += locations[i] == Location::inside ? 1 : 0; });
      EXPECT_GT(inside, 10u);
    }
    PagedArray<ClosestPointOf<T>> closest;
    PagedArray<T> numbers;
    tree.closest_points(points, closest.span(), {.path = path, .threads = threads, .active = mask.data()});
    tree.winding_numbers(points, numbers.span(), {.path = path, .threads = threads, .active = mask.data()});
    tree.signed_distances(points, numbers.span(), {.path = path, .threads = threads, .active = mask.data()});
    PagedArray<T>::each([&](std::size_t i) {
      const auto distance = std::sqrt(closest[i].distance_squared);
      ASSERT_TRUE(closest[i] && (numbers[i] == 0 || std::abs(std::abs(numbers[i]) - distance) < 1e-6));
    });
  });
}

TEST(Inactive, elements_of_trees_are_not_touched) {
  Elements elements;
  const Mesh open = without(ellipsoid(2, {0, 0, 0}, {1.25f, 1, 1}), 0.1, 302);
  for (const Mesh& mesh : {cube(-1, 1), open}) {
    ask_all<float>(elements, Bvh(mesh));
    ask_all<float>(elements, KdTree(mesh));
  }
  ask_all<double>(elements, tree_of<double>(mesh_of<double>(open)));
}

TEST(Inactive, elements_of_scenes_are_not_touched) {
  Elements elements;
  Scene scene;
  const std::uint32_t geometry = scene.add(Bvh(cube(-1, 1)));
  scene.place(geometry);
  scene.place(geometry, {{{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
  scene.update();
  on_each_path([&](const Path* path, int threads) {
    const TraceOptions options{.path = path, .threads = threads, .active = mask.data()};
    trace_all<SceneHit>(scene, elements.view(), elements.places(), Float3{}, options);
    PagedArray<SceneHit> hits;
    PagedArray<std::uint8_t> occluded;
    scene.closest(elements.arrays, SceneHitView(hits.data(), all), options);
    scene.occluded(elements.arrays, occluded.span(), options);
  });
}

TEST(Inactive, elements_of_trees_over_primitives_are_not_touched) {
  Elements elements;
  const std::vector<Sphere> spheres = {{{0, 0, 0}, 1.5f}, {{1, 0, 0}, 0.25f}, {{0, 1, 1}, 0.5f}};
  const std::vector<Box> boxes = {{{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}}};
  const SphereTree tree(spheres);
  const BoundedTree bounded(boxes);
  const auto test = [](std::uint32_t, const Ray&, Hit& hit) {
    hit.t = 1;
    return true;
  };
  on_each_path([&](const Path* path, int threads) {
    const VisitOptions options{.path = path, .threads = threads, .active = mask.data()};
    PagedArray<Hit> hits;
    PagedArray<std::uint8_t> occluded;
    trace_all<Hit>(tree, elements.view(), elements.places(), Float3{}, options);
    tree.closest(elements.arrays, HitView(hits.data(), all), options);
    tree.occluded(elements.arrays, occluded.span(), options);
    bounded.closest(elements.view(), hits.span(), test, options);
    bounded.occluded(elements.view(), occluded.span(), test, options);
  });
}

// The arrays of floats serve as numbers of any primitive.
TEST(Inactive, elements_of_arrays_are_not_touched) {
  Elements elements;
  PagedArray<float> number[9], out[6];
  Random random(303);
  for (PagedArray<float>& numbers : number)
    PagedArray<float>::each([&](std::size_t i) { numbers[i] = random.number(-2, 2); });
  const auto at = [&](int k) { return static_cast<const float*>(number[k].data()); };
  const TriangleArrays triangles{{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}}, all};
  const BoxArrays boxes{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, all};
  const SphereArrays spheres{{at(0), at(1), at(2)}, at(3), all};
  const Ray ray = make_ray({0, 0, 0}, {1, 0.5f, 0.25f});
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  std::vector<std::uint8_t> bits((all + 7) / 8);
  const auto room = [&](int k) { return out[k].span(); };
  on_each_path([&](const Path* path, int) {
    for (const Grade grade : {Grade::reproducible, Grade::fast}) {
      for (const TriangleTestInfo& info : triangle_tests) {
        const TriangleOptions options{info.test, grade, path, mask.data()};
        closest_hit(ray, triangles, options);
        hit_mask(ray, triangles, bits, options);
        closest_hits(elements.arrays, floor_triangle, {bits, room(0), room(1), room(2)}, options);
        hit_mask(elements.arrays, floor_triangle, bits, options);
      }
      for (const BoxTestInfo& info : box_tests) {
        const BoxOptions options{info.test, grade, path, mask.data()};
        hit_mask(ray, boxes, bits, options);
        hit_mask(elements.arrays, box, bits, options);
        intervals(ray, boxes, bits, room(0), room(1), options);
        intervals(elements.arrays, box, bits, room(0), room(1), options);
      }
      for (const SphereTestInfo& info : sphere_tests) {
        const SphereOptions options{info.test, grade, path, mask.data()};
        const Sphere sphere{{1, 0, 0}, 0.5f};
        hit_mask(ray, spheres, bits, options);
        hit_mask(elements.arrays, sphere, bits, options);
        closest_hit(ray, spheres, options);
        distances(ray, spheres, bits, room(0), room(1), options);
        distances(elements.arrays, sphere, bits, room(0), room(1), options);
        line_hits(ray, spheres, bits, options);
      }
    }
    const PointOptions options{.path = path, .active = mask.data()};
    closest_point({1, 2, 3}, triangles, options);
    distances({1, 2, 3}, triangles, {room(0), {room(1), room(2), room(3)}, room(4), room(5)}, options);
  });
}

}  // namespace
}  // namespace raylanes::testing
