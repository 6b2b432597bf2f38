// Points and arrays of triangles, against rationals.
#include <raylanes/points.hpp>

#include "../support/float_modes.hpp"
#include "../support/level.hpp"
#include "../support/message_of.hpp"
#include "../support/same_bytes.hpp"
#include "../support/soa.hpp"
#include "../support/supported_paths.hpp"
#include "point_cases.hpp"

namespace raylanes::testing {
namespace {

struct Distances {
  FloatColumns columns;
  std::size_t size;
  explicit Distances(std::size_t n, Place place = Place::unguarded) : columns(6, n, place), size(n) {}
  PointDistances out() {
    const auto span = [&](std::size_t k) { return std::span(columns[k], size); };
    return {span(0), {span(1), span(2), span(3)}, span(4), span(5)};
  }
  float number(std::size_t k, std::size_t i) { return columns[k][i]; }
};

std::vector<Triangle> triangles_for(std::size_t n, Random& random) {
  std::vector<Triangle> triangles;
  while (triangles.size() < n) triangles.push_back(any_triangle(random));
  return triangles;
}

void expect_bounds(const PointCase& at, double found, double unit, double slack, const std::string& name) {
  const mpq_class exact = oracle::exact_square_of_distance(at.point, at.triangle),
                  reach = square_of_reach(at);
  const mpq_class off = abs(mpq_class(found) - exact);
  EXPECT_LE(off, mpq_class(128 * unit) * reach + mpq_class(slack)) << name << ' ' << found;
  const double d = std::sqrt(exact.get_d()), m = unit * std::sqrt(reach.get_d()), root = std::sqrt(found),
               sine = sine_at_v0(at.triangle), rounding = 0x1p-50 * (d + root) + std::sqrt(slack);
  EXPECT_GE(root, d - 11 * m - rounding) << name;
  if (sine > 1000 * unit) {
    EXPECT_LE(root, std::hypot(d + 20 * m, 100 * m / sine) + rounding) << name << " sine " << sine;
  }
}

TEST(PointArrays, distances_in_floats_are_within_the_bound_and_the_same_on_every_path) {
  Random random(2701);
  for (int round = 0; round < static_cast<int>(by_level(4000)); ++round) {
    const int exponent = std::array{-60, -30, 0, 0, 20, 45}[static_cast<std::size_t>(round) % 6];
    PointCase at{{}, any_triangle(random)};
    at.point = any_point(at.triangle, random);
    scale(at, exponent);
    std::vector<Triangle> triangles{at.triangle};
    for (const FloatMode mode : float_modes) {
      Distances of_scalar(1);
      for (const Path* path : paths_with_own_queries()) {
        Distances found(1);
        {
          const FloatModeScope scope(mode);
          distances(at.point, TriangleColumns(triangles).arrays(), found.out(), {.path = path});
          if (path == paths_with_own_queries().front())
            distances(at.point, TriangleColumns(triangles).arrays(), of_scalar.out(), {.path = path});
        }
        for (std::size_t k = 0; k < 6; ++k)
          EXPECT_TRUE(same_bytes(*found.columns[k], *of_scalar.columns[k])) << path->name << ' ' << k;
      }
      const std::string name = std::string(name_of(mode)) + " round " + std::to_string(round);
      expect_bounds(at, static_cast<double>(of_scalar.number(0, 0)), 0x1p-24, 0x1p-78, name);
      const double u = static_cast<double>(of_scalar.number(4, 0)),
                   v = static_cast<double>(of_scalar.number(5, 0));
      EXPECT_TRUE(u >= 0 && v >= 0 && u + v <= 1 + 0x1p-23) << name;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        double most = 0, x = 0;
        const double weights[] = {1 - u - v, u, v};
        for (int c = 0; c < 3; ++c) {
          const double corner = static_cast<double>(at.triangle.corner[c][axis]);
          most = std::max(most, std::abs(corner)), x += weights[c] * corner;
        }
        for (const Float3& corner : at.triangle.corner)
          for (const float y : corner) most = std::max(most, static_cast<double>(std::abs(y)));
        EXPECT_NEAR(static_cast<double>(of_scalar.number(1 + axis, 0)), x, 0x1p-21 * most + 0x1p-120) << name;
      }
    }
    if (HasFailure()) return;
  }
}

TEST(PointArrays, closest_points_are_within_the_bound_of_doubles_at_every_scale) {
  Random random(2702);
  for (int round = 0; round < static_cast<int>(by_level(6000)); ++round) {
    const int exponent = std::array{-100, -80, 0, 0, 60, 100}[static_cast<std::size_t>(round) % 6];
    PointCase at{{}, any_triangle(random)};
    at.point = any_point(at.triangle, random);
    scale(at, exponent);
    const std::vector<Triangle> triangles{at.triangle};
    const auto& [a, b, c] = at.triangle.corner;
    for (const FloatMode mode : float_modes) {
      if (mode == FloatMode::flush && exponent == -100) continue;  // subnormal coordinates count as zeros
      ClosestPoint of_scalar;
      for (const Path* path : paths_with_own_queries()) {
        ClosestPoint found;
        {
          const FloatModeScope scope(mode);
          found = closest_point(at.point, TriangleColumns(triangles).arrays(), {.path = path});
        }
        if (path == paths_with_own_queries().front()) of_scalar = found;
        EXPECT_TRUE(same_bytes(found, of_scalar)) << path->name;
      }
      const std::string name = std::string(name_of(mode)) + " round " + std::to_string(round);
      const bool has_equal = a == b || b == c || a == c;
      EXPECT_EQ(of_scalar.primitive, has_equal ? no_primitive : 0u) << name;
      if (has_equal) continue;
      expect_bounds(at, of_scalar.distance_squared, 0x1p-53, 0, name);
      if (at.point == a || at.point == b || at.point == c) {
        EXPECT_EQ(of_scalar.distance_squared, 0) << name;
      }
    }
    if (HasFailure()) return;
  }
}

// Beside guards, with every mask: what takes no part is neither read nor written.
TEST(PointArrays, any_length_with_any_mask) {
  constexpr std::size_t most = 37;
  Random random(2703);
  const std::vector<Triangle> triangles = triangles_for(most, random);
  const Float3 point = random.point(2);
  const auto inputs = [&](std::size_t n, Place place) {
    return std::make_unique<TriangleColumns>(std::span<const Triangle>(triangles).first(n), place);
  };
  for (const Path* path : paths_with_own_queries())
    for_all_masks(most, inputs, [&](const auto& in, Place place, LaneBits active) {
      const std::size_t n = in->size();
      Distances found(n, place), untouched(n);
      const PointOptions options{.path = path, .active = active};
      distances(point, in->arrays(), found.out(), options);
      ClosestPoint expected;
      for (std::size_t i = 0; i < n; ++i) {
        const bool takes_part = active == nullptr || is_set({active, (n + 7) / 8}, i);
        Distances alone(1);
        const TriangleColumns one(std::span<const Triangle>(triangles).subspan(i, 1));
        distances(point, one.arrays(), alone.out(), {.path = path});
        for (std::size_t k = 0; k < 6; ++k) {
          const float wanted = takes_part ? alone.number(k, 0) : untouched.number(k, i);
          ASSERT_TRUE(same_bytes(found.number(k, i), wanted))
              << path->name << ' ' << n << ' ' << i << ' ' << k;
        }
        ClosestPoint of_one = closest_point(point, one.arrays(), {.path = path});
        if (takes_part && of_one.distance_squared < expected.distance_squared)
          of_one.primitive = static_cast<std::uint32_t>(i), expected = of_one;
      }
      const ClosestPoint closest = closest_point(point, in->arrays(), options);
      ASSERT_TRUE(same_bytes(closest, expected)) << path->name << ' ' << n;
      ASSERT_TRUE(found.columns.are_intact());
      const PointDistances squares_alone{
          .distance_squared = found.out().distance_squared, .point = {}, .u = {}, .v = {}};
      distances(point, in->arrays(), squares_alone, options);
      ASSERT_TRUE(found.columns.are_intact());
    });
}

TEST(PointArrays, say_that_nothing_is_close_to_what_is_no_number) {
  const Triangle good = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const Path* path : paths_with_own_queries())
    for (const float wrong : {nan, infinity, -infinity}) {
      for (std::size_t k = 0; k < 12; ++k) {
        Triangle triangle = good;
        Float3 point{0.25f, 0.25f, 1};
        (k < 9 ? triangle.corner[k / 3][k % 3] : point[k % 3]) = wrong;
        const std::vector<Triangle> triangles{triangle};
        const TriangleColumns columns(triangles);
        EXPECT_EQ(closest_point(point, columns.arrays(), {.path = path}).primitive, no_primitive) << k;
        Distances found(1);
        distances(point, columns.arrays(), found.out(), {.path = path});
        EXPECT_EQ(found.number(0, 0), infinity) << k;
        for (std::size_t n = 1; n < 4; ++n) EXPECT_TRUE(std::isnan(found.number(n, 0))) << k;
        EXPECT_EQ(found.number(4, 0), 0) << k;
        EXPECT_EQ(found.number(5, 0), 0) << k;
      }
      EXPECT_EQ(closest_point({0, 0, 1}, TriangleColumns(std::vector{good}).arrays(),
                              {.max_distance = wrong, .path = path})
                    .primitive,
                wrong == infinity ? 0u : no_primitive);
    }
}

TEST(PointArrays, keep_to_the_most_distance_and_take_the_least_of_equal_ones) {
  const Triangle floor = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const std::vector<Triangle> triangles{make_triangle({0, 0, -1}, {1, 0, -1}, {0, 1, -1}), floor, floor};
  const TriangleColumns columns(triangles);
  for (const Path* path : paths_with_own_queries()) {
    const auto primitive = [&](const Float3& point, float most) {
      return closest_point(point, columns.arrays(), {.max_distance = most, .path = path}).primitive;
    };
    EXPECT_EQ(primitive({0.25f, 0.25f, 1}, infinity), 1u);
    EXPECT_EQ(primitive({0.25f, 0.25f, 1}, 1), 1u);
    EXPECT_EQ(primitive({0.25f, 0.25f, 1}, std::nextafter(1.0f, 0.0f)), no_primitive);
    EXPECT_EQ(primitive({0.25f, 0.25f, -0.5f}, infinity), 0u);
    EXPECT_EQ(primitive({1, 0, 0}, 0), 1u);
    EXPECT_EQ(primitive({1, 0, 0}, -0.0f), 1u);
    EXPECT_EQ(primitive({1, 0, 0}, -0x1p-149f), no_primitive);
  }
  const ClosestPoint closest = closest_point({2, 0, 0}, columns.arrays());
  EXPECT_EQ(closest.distance_squared, 1);
  EXPECT_EQ(closest.point, (Float3{1, 0, 0}));
  EXPECT_EQ(closest.u, 1);
  EXPECT_EQ(closest.v, 0);
}

TEST(PointArrays, refuse_other_sizes) {
  const std::vector<Triangle> triangles(3, make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  const TriangleColumns columns(triangles);
  std::vector<float> few(2), right(3);
  const auto message = [&](const PointDistances& out) {
    return message_of([&] { distances({0, 0, 0}, columns.arrays(), out); });
  };
  const std::span<float> none, two(few), three(right);
  EXPECT_NE(message({two, {none, none, none}, none, none}).find("distance_squared"), std::string::npos);
  EXPECT_NE(message({three, {two, none, none}, none, none}).find("x has 2"), std::string::npos);
  EXPECT_NE(message({three, {none, two, none}, none, none}).find("y has 2"), std::string::npos);
  EXPECT_NE(message({three, {none, none, two}, none, none}).find("z has 2"), std::string::npos);
  EXPECT_NE(message({three, {none, none, none}, two, none}).find("u has 2"), std::string::npos);
  EXPECT_NE(message({three, {none, none, none}, none, two}).find("v has 2"), std::string::npos);
}

TEST(PointArrays, refuse_paths_of_other_machines) {
  const TriangleColumns columns(std::vector{make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})});
  expect_foreign_path_refused<PointOptions>([&](const PointOptions& options, const auto& check) {
    check("closest_point", [&] { closest_point({0, 0, 0}, columns.arrays(), options); });
  });
}

}  // namespace
}  // namespace raylanes::testing
