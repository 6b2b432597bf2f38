// Shadows of lights at any distance: segments begin at their points, in every tree, call and mode. Single rays from the
// points judge batches, and rational numbers judge some of these rays.
#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>
#include <raylanes/numbers.hpp>
#include <raylanes/scene.hpp>

#include "../../bench/support/oracles/exact_rays.hpp"
#include "../../bench/support/scenes/shapes.hpp"
#include "../support/filtered.hpp"
#include "../support/random_input.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {
namespace {

// Hills of 250 m with towers.
Mesh city() {
  Mesh mesh;
  Random random(17);
  bench::append_grid(mesh, 24, 24, [&](double u, double v) {
    const bool is_tower = std::fmod(u * 24, 6) < 1.5 && std::fmod(v * 24, 5) < 1.5;
    return bench::Double3{250 * u, 250 * v,
                          5 * std::sin(9 * u) * std::cos(7 * v) + random.real(0, 1) + (is_tower ? 30 : 0)};
  });
  return mesh;
}

// The number, options and contents of each tree.
template <class AnyTree>
struct Kind {
  using Number = float;
  using Options = TraceOptions;
  using AnyHit = Hit;
  static std::unique_ptr<AnyTree> tree(const Mesh& mesh) { return std::make_unique<AnyTree>(mesh); }
};
template <>
struct Kind<BvhD> {
  using Number = double;
  using Options = TraceOptionsD;
  using AnyHit = HitD;
  static std::unique_ptr<BvhD> tree(const Mesh& mesh) {
    std::vector<Double3> vertices;
    for (const Float3& v : mesh.vertices) vertices.push_back({v[0], v[1], v[2]});
    return std::make_unique<BvhD>(vertices, mesh.triangles);
  }
};
template <>
struct Kind<Scene> : Kind<Bvh> {
  using AnyHit = SceneHit;
  static std::unique_ptr<Scene> tree(const Mesh& mesh) {
    auto scene = std::make_unique<Scene>();
    const std::uint32_t hills = scene->add(Bvh(mesh)),
                        ball = scene->add(SphereTree(std::vector<Sphere>{{{0, 0, 0}, 9}}));
    scene->place(hills, Transform{});
    scene->place(hills, {{{0.6f, 0.8f, 0, 20}, {-0.8f, 0.6f, 0, 260}, {0, 0, 0.5f, 25}}});
    scene->place(ball, {{{1, 0, 0, 60}, {0, 1, 0, 90}, {0, 0, 1, 50}}});
    scene->update();
    return scene;
  }
};
template <>
struct Kind<SphereTree> : Kind<Bvh> {
  using Options = VisitOptions;
  static std::unique_ptr<SphereTree> tree(const Mesh& mesh) {
    std::vector<Sphere> spheres;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 2) spheres.push_back({mesh.vertices[i], 4});
    return std::make_unique<SphereTree>(spheres);
  }
};

template <class AnyTree>
class Shadows : public ::testing::Test {
 protected:
  using Real = typename Kind<AnyTree>::Number;
  using Options = typename Kind<AnyTree>::Options;
  using Point = PointOf<Real>;
  using AnyRay = RayOf<Real>;

  Shadows() : mesh(city()), tree(Kind<AnyTree>::tree(mesh)) {
    Random random(18);
    for (int i = 0; i < 4000; ++i) {
      const Triangle t = random.triangle_of(mesh);
      const double u = random.real(0, 0.5), v = random.real(0, 0.5);
      Point& point = points.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        point[k] = static_cast<Real>((1 - u - v) * double{t.corner[0][k]} + u * double{t.corner[1][k]} +
                                     v * double{t.corner[2][k]});
      point[2] += i % 4 == 0 ? Real(0) : Real(0.01 * (i % 4));
      skip.push_back(i % 3 == 0 ? no_primitive : static_cast<std::uint32_t>(i % 1000));
      active[static_cast<std::size_t>(i) / 8] |= static_cast<std::uint8_t>((i % 7 != 0) << (i % 8));
    }
  }

  static Point light_at(double distance) {
    return {static_cast<Real>(125 + 0.6 * distance), static_cast<Real>(125 - 0.48 * distance),
            static_cast<Real>(0.64 * distance)};
  }
  AnyRay segment(const Point& light, std::size_t i, const SegmentEndsOf<Real>& ends = {}) const {
    return segment_to<Real>(light, points[i], ends);
  }
  AnyRay towards(const Point& direction, std::size_t i) const {
    AnyRay ray;
    ray.origin = points[i], ray.direction = direction;
    return ray;
  }
  // check(options) for all modes, paths and some numbers of threads.
  template <class Check>
  void each_way(const Check& check) const {
    for (const Path* path : paths_with_own_queries())
      for (const int threads : {1, 3}) {
        Options options{.path = path, .threads = threads};
        SCOPED_TRACE(std::string(path->name) + ", threads: " + std::to_string(threads));
        if constexpr (requires { options.mode; })
          for (std::size_t mode = 0; mode < traversal_mode_names.size(); ++mode) {
            options.mode = static_cast<TraversalMode>(mode);
            check(options);
          }
        else
          check(options);
      }
  }
  // Expects the results of ray(i) from a batch, with and without the points that are inactive.
  template <class Ask, class RayOfPoint>
  void expect(const Ask& ask, const RayOfPoint& ray, const Options& of_rays = {}) const {
    std::vector<std::uint8_t> expected(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      Options one = of_rays;
      if (one.skip.first != nullptr) one.skip = PrimitiveView(skip[i]);
      expected[i] = tree->occluded(ray(i), one) ? 1 : 0;
    }
    each_way([&](Options options) {
      options.skip = of_rays.skip;
      std::vector<std::uint8_t> dark(points.size(), 9), some(points.size(), 9);
      ask(dark, options);
      for (std::size_t i = 0; i < dark.size(); ++i) ASSERT_EQ(dark[i], expected[i]) << "point " << i;
      options.active = active;
      ask(some, options);
      for (std::size_t i = 0; i < dark.size(); ++i) ASSERT_EQ(some[i], i % 7 != 0 ? expected[i] : 9) << i;
    });
    shadows += static_cast<std::size_t>(std::ranges::count(expected, 1));
  }

  Mesh mesh;
  std::unique_ptr<AnyTree> tree;
  std::vector<Point> points;
  std::vector<std::uint32_t> skip;
  std::uint8_t active[500] = {};
  mutable std::size_t shadows = 0;
};

using Trees = ::testing::Types<Bvh, KdTree, BvhD, Scene, SphereTree>;
TYPED_TEST_SUITE(Shadows, Trees);

// Near, beyond what frusta bear, and at the distance of the sun.
constexpr double distances[] = {120, 900, 1e4, 1e5, 1e6, 1e7, 1e9, 1.5e11};

TYPED_TEST(Shadows, of_a_light_at_any_distance) {
  for (const double distance : distances) {
    SCOPED_TRACE(distance);
    const auto light = this->light_at(distance);
    this->shadows = 0;
    this->expect(
        [&](auto& dark, const auto& options) {
          this->tree->occluded_from(light, this->points, dark, {}, options);
        },
        [&](std::size_t i) { return this->segment(light, i); });
    EXPECT_GT(this->shadows, this->points.size() / 20);
    EXPECT_LT(this->shadows, this->points.size() * 19 / 20);
  }
}

TYPED_TEST(Shadows, of_a_part_of_segments) {
  using Ends = SegmentEndsOf<typename TestFixture::Real>;
  const auto light = this->light_at(150);
  for (const Ends& ends : {Ends{0.25f, 0.75f}, Ends{0, 0.999f}, Ends{1e-20f, 1}, Ends{-0.5f, 1},
                           Ends{0, 1.25f}, Ends{0.5f, 0.25f}})
    this->expect(
        [&](auto& dark, const auto& options) {
          this->tree->occluded_from(light, this->points, dark, ends, options);
        },
        [&](std::size_t i) { return this->segment(light, i, ends); });
  EXPECT_GT(this->shadows, 100u);
}

TYPED_TEST(Shadows, in_a_direction) {
  using T = typename TestFixture::Real;
  for (const auto& direction :
       {PointOf<T>{0.6f, -0.48f, 0.64f}, PointOf<T>{0, 0, 1}, PointOf<T>{3e5f, 1e5f, 2e5f}})
    this->expect(
        [&](auto& dark, const auto& options) {
          this->tree->occluded_towards(direction, this->points, dark, options);
        },
        [&](std::size_t i) { return this->towards(direction, i); });
  EXPECT_GT(this->shadows, 100u);
}

TYPED_TEST(Shadows, without_a_primitive_for_each_point) {
  if constexpr (!std::is_same_v<TypeParam, Scene>) {
    typename TestFixture::Options skips;
    skips.skip = this->skip;
    for (const double distance : {200.0, 1e7}) {
      const auto light = this->light_at(distance);
      this->expect(
          [&](auto& dark, const auto& options) {
            this->tree->occluded_from(light, this->points, dark, {}, options);
          },
          [&](std::size_t i) { return this->segment(light, i); }, skips);
      this->expect(
          [&](auto& dark, const auto& options) {
            this->tree->occluded_towards(light, this->points, dark, options);
          },
          [&](std::size_t i) { return this->towards(light, i); }, skips);
    }
  }
}

// Sides are those that the light sees: for rays from the points the others.
TYPED_TEST(Shadows, of_one_side) {
  typename TestFixture::Options options, of_rays;
  if constexpr (requires { options.facing; } && !std::is_same_v<TypeParam, Scene>)
    for (const auto& [side, other] :
         {std::pair(Facing::front, Facing::back), std::pair(Facing::back, Facing::front)}) {
      options.facing = side, of_rays.facing = other;
      const auto light = this->light_at(1e6);
      std::vector<std::uint8_t> dark(this->points.size()), kept(dark), sun(dark);
      const auto keep_all = [](auto, auto, auto) {};
      this->tree->occluded_from(light, this->points, dark, {}, options);
      this->tree->occluded_from(light, this->points, kept, keep_all, {}, options);
      this->tree->occluded_towards(light, this->points, sun, of_rays);
      std::size_t dark_count = 0;
      for (std::size_t i = 0; i < dark.size(); ++i) {
        ASSERT_EQ(dark[i], this->tree->occluded(this->segment(light, i), of_rays) ? 1 : 0) << i;
        ASSERT_EQ(kept[i], dark[i]) << i;
        ASSERT_EQ(sun[i], this->tree->occluded(this->towards(light, i), of_rays) ? 1 : 0) << i;
        dark_count += dark[i];
      }
      EXPECT_GT(dark_count, 100u);
    }
}

TYPED_TEST(Shadows, that_a_filter_keeps) {
  using AnyHit = typename Kind<TypeParam>::AnyHit;
  const auto is_even = [](const AnyHit& hit) { return hit.primitive % 2 == 0; };
  for (const double distance : {200.0, 1.5e11}) {
    const auto light = this->light_at(distance);
    std::vector<std::uint8_t> dark(this->points.size()), sun(dark);
    this->tree->occluded_from(light, this->points, dark, reject_even<AnyHit>);
    this->tree->occluded_towards(light, this->points, sun, reject_even<AnyHit>);
    for (std::size_t i = 0; i < dark.size(); ++i) {
      ASSERT_EQ(dark[i], this->tree->occluded(this->segment(light, i), is_even) ? 1 : 0) << i;
      ASSERT_EQ(sun[i], this->tree->occluded(this->towards(light, i), is_even) ? 1 : 0) << i;
    }
  }
}

TYPED_TEST(Shadows, of_lights_that_are_no_lights) {
  using T = typename TestFixture::Real;
  constexpr T none = std::numeric_limits<T>::quiet_NaN(), far = std::numeric_limits<T>::infinity();
  std::vector<std::uint8_t> dark(this->points.size());
  const std::vector<std::uint8_t> lit(dark);
  for (const PointOf<T>& light :
       {PointOf<T>{0, none, 0}, PointOf<T>{0, 0, far}, PointOf<T>{-far, far, none}}) {
    std::ranges::fill(dark, std::uint8_t{9});
    this->tree->occluded_from(light, this->points, dark);
    EXPECT_EQ(dark, lit);
    std::ranges::fill(dark, std::uint8_t{9});
    this->tree->occluded_towards(light, this->points, dark);
    EXPECT_EQ(dark, lit);
  }
  std::ranges::fill(dark, std::uint8_t{9});
  this->tree->occluded_towards(PointOf<T>{}, this->points, dark);
  EXPECT_EQ(dark, lit);
  std::ranges::fill(this->points, PointOf<T>(this->points[0]));
  this->tree->occluded_from(this->points[0], this->points, dark);
  EXPECT_EQ(dark, lit) << "the light is at the point, which is on a triangle";
  std::vector<std::uint8_t> two(2);
  EXPECT_THROW(this->tree->occluded_from(this->points[0], this->points, two), std::invalid_argument);
  EXPECT_THROW(this->tree->occluded_towards(this->points[0], this->points, two), std::invalid_argument);
  EXPECT_THROW(this->tree->occluded_towards(this->points[0], {nullptr, 2}, two), std::invalid_argument);
  this->tree->occluded_towards(this->points[0], {}, {});
}

// Rational numbers know the segments whose differences doubles hold exactly, whatever their light.
TYPED_TEST(Shadows, as_rational_numbers_have_them) {
  using T = typename TestFixture::Real;
  if constexpr (std::is_base_of_v<TriangleTree, TypeParam> || std::is_same_v<TypeParam, BvhD>) {
    oracle::DoubleMesh hills;
    for (const Float3& v : this->mesh.vertices) hills.vertices.push_back({v[0], v[1], v[2]});
    hills.triangles = this->mesh.triangles;
    for (const double distance : distances) {
      const auto light = this->light_at(distance);
      std::vector<std::uint8_t> dark(this->points.size());
      this->tree->occluded_from(light, this->points, dark);
      for (std::size_t i = 0; i < dark.size(); i += 131) {
        RayD ray{{}, 0, {}, 1};
        for (std::size_t k = 0; k < 3; ++k)
          ray.origin[k] = this->points[i][k], ray.direction[k] = T(light[k] - this->points[i][k]);
        ASSERT_EQ(dark[i], exact_hits(hills, ray).empty() ? 0 : 1)
            << "point " << i << ", light at " << distance;
      }
    }
  }
}

// By rays of half the length and twice the ends, whose directions are rounded here from numbers that are exact.
TYPED_TEST(Shadows, of_segments_longer_than_the_largest_number) {
  using T = typename TestFixture::Real;
  using Ends = SegmentEndsOf<T>;
  if constexpr (std::is_base_of_v<TriangleTree, TypeParam> || std::is_same_v<TypeParam, BvhD>) {
    constexpr T largest = std::numeric_limits<T>::max(), size = T(0.66) * largest;
    const Mesh fan = double_fan(9, 0.2f);
    oracle::MeshOf<T> wide;
    for (const Float3& v : fan.vertices) wide.vertices.push_back({size * v[0], size * v[1], size * v[2]});
    wide.triangles = fan.triangles;
    const TypeParam wide_tree(wide.vertices, wide.triangles);
    const PointOf<T> from{T(0.97) * largest, -size, 3};
    Random random(8);
    const auto some = [&](double least, double most) { return static_cast<T>(random.real(least, most)); };
    std::vector<PointOf<T>> far_points;
    for (int i = 0; i < 300; ++i) {
      const PointOf<T>& at = wide.vertices[random.index(wide.vertices.size())];
      const T scale = i % 3 == 0 ? 1 : some(0.5, 1.2);  // to corners, or anywhere near them
      far_points.push_back({T(-0.94) * largest * some(0.3, 1), scale * at[1], at[2] * some(-1, 1)});
      if (i % 3 == 1) far_points.back() = {-from[0], -from[1] - at[1], -at[2]};  // often through zero
    }
    for (const Ends& ends : {Ends{}, Ends{0.25f, 0.625f}}) {
      std::vector<std::uint8_t> expected;
      std::size_t overflows = 0;
      for (const PointOf<T>& point : far_points) {
        RayOf<T> ray{point, 2 * (1 - ends.end), {}, 2 * (1 - ends.start)};
        for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = from[k] / 2 - point[k] / 2;
        expected.push_back(oracle::exact_hits(wide, ray).empty() ? 0 : 1);
        overflows += std::isinf(point[0] - from[0]) ? 1 : 0;
      }
      this->each_way([&](const auto& options) {
        std::vector<std::uint8_t> dark(far_points.size(), 9);
        wide_tree.occluded_from(from, far_points, dark, ends, options);
        EXPECT_EQ(dark, expected);
      });
      const auto hits = std::ranges::count(expected, 1);
      EXPECT_TRUE(30 < hits && hits < 270) << hits;
      EXPECT_GT(overflows, 200u);
    }
  }
}

}  // namespace
}  // namespace raylanes::testing
