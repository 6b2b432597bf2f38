// Winding numbers at points where the library's own division of a boundary has edges and caps: on chords between
// corners of a hole, which cut long loops and bound fans, and in planes through three corners. The mesh has nothing
// there.
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "open_meshes.hpp"

namespace raylanes::testing {
namespace {

// A closed cube from -24 to 24, each face of 12 × 12 squares, without a square hole of 6 × 6 in the middle of the face
// at the end of `axis`. Corners are multiples of 4 and moved inwards by up to `roughness` of them, so that points
// halfway and at quarters between two corners are floats.
struct HoledCube {
  static constexpr int cells = 12, from = 3, to = 9;
  Mesh mesh;
  std::vector<Float3> rim;  // the corners of the hole

  HoledCube(std::size_t axis, int roughness, std::uint64_t seed) : random_(seed), roughness_(roughness) {
    for (std::size_t k = 0; k < 3; ++k)
      for (const bool upper : {false, true}) add_face(k, upper, k == axis && upper);
    std::ranges::sort(rim);
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  }

 private:
  void add_face(std::size_t axis, bool upper, bool has_hole) {
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const auto corner = [&](int di, int dj) { return corner_at(axis, upper, i + di, j + dj); };
        const Float3 a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
        if (has_hole && i >= from && i < to && j >= from && j < to) {
          const auto is_rim = [](int x) { return x == from || x == to; };
          for (const auto& [x, y, at] :
               {std::tuple{i, j, a}, {i + 1, j, b}, {i + 1, j + 1, c}, {i, j + 1, d}})
            if (is_rim(x) || is_rim(y)) rim.push_back(at);
        } else if (upper) {
          append(mesh, make_triangle(a, b, c)), append(mesh, make_triangle(a, c, d));
        } else {
          append(mesh, make_triangle(a, c, b)), append(mesh, make_triangle(a, d, c));
        }
      }
  }
  Float3 corner_at(std::size_t axis, bool upper, int i, int j) {
    Float3 at;
    at[axis] = upper ? 24.0f : -24.0f;
    at[(axis + 1) % 3] = static_cast<float>(4 * i - 24), at[(axis + 2) % 3] = static_cast<float>(4 * j - 24);
    const auto [place, is_new] = moved_.try_emplace(at, at);
    if (is_new)
      for (float& x : place->second)
        if (std::abs(x) == 24.0f) x *= static_cast<float>(6 - random_.integer(0, roughness_)) / 6;
    return place->second;
  }
  Random random_;
  int roughness_;
  std::map<Float3, Float3> moved_;
};

// Points between each two corners, at quarters, and in planes through three.
std::vector<Float3> points_of_chords(const std::vector<Float3>& corners, std::size_t planes, Random& random) {
  const auto between = [](const Float3& a, const Float3& b, float share) {
    Float3 point;
    for (std::size_t k = 0; k < 3; ++k) point[k] = a[k] * (1 - share) + b[k] * share;
    return point;
  };
  std::vector<Float3> points;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (const float share : {0.25f, 0.5f, 0.75f}) points.push_back(between(corners[i], corners[j], share));
  const auto corner = [&] {
    return corners[static_cast<std::size_t>(random.integer(0, static_cast<int>(corners.size()) - 1))];
  };
  const float shares[] = {-0.25f, 0.25f, 0.5f, 1.25f};
  for (std::size_t i = 0; i < planes; ++i)
    points.push_back(between(between(corner(), corner(), 0.5f), corner(), shares[random.integer(0, 3)]));
  return points;
}

// In any order, so that most have rays of their own, and sorted, so that many share the rays of rows.
void expect_windings_in_both_orders(const Mesh& mesh, std::vector<Float3> points, std::size_t count,
                                    Random& random) {
  for (std::size_t i = points.size(); i > 1; --i)
    std::swap(points[i - 1], points[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  points.resize(std::min(points.size(), count));
  EXPECT_GT(expect_windings(mesh, points), points.size() / 4);
  std::ranges::sort(points);
  EXPECT_GT(expect_windings(mesh, points), points.size() / 4);
}

TEST(WindingChords, between_corners_of_flat_and_rough_holes) {
  Random random(401);
  for (const auto& [axis, roughness] : {std::pair<std::size_t, int>{2, 0}, {0, 0}, {1, 1}, {2, 3}}) {
    SCOPED_TRACE(::testing::Message() << "axis " << axis << ", roughness " << roughness);
    const HoledCube cube(axis, roughness, 402 + axis);
    EXPECT_EQ(cube.rim.size(), 24u);
    expect_windings_in_both_orders(cube.mesh, points_of_chords(cube.rim, 400, random), by_level(600), random);
  }
}

// One by one they have the rays to the nearest side; as a grid those along x.
TEST(WindingChords, the_plane_of_a_flat_hole_has_one_half) {
  const HoledCube cube(2, 0, 1);
  std::vector<Float3> grid;
  for (int y = -10; y <= 10; ++y)
    for (int x = -10; x <= 10; ++x) grid.push_back({static_cast<float>(x), static_cast<float>(y), 24});
  each_tree(cube.mesh, [&](const auto& tree, const Path* path) {
    std::vector<float> numbers(grid.size());
    tree.winding_numbers(grid, numbers, {.path = path});
    float alone = 0;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      tree.winding_numbers(std::span(grid).subspan(i, 1), std::span(&alone, 1), {.path = path});
      wrong += std::abs(numbers[i] - 0.5f) > 1e-6f || std::abs(alone - 0.5f) > 1e-6f ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u);
  });
}

// A cone over a ring of 24 corners, each with its opposite. The two on `axis` begin the halves that a chord along that
// axis cuts. Corners rise by up to `most`, so that a direction may be near one half alone.
Mesh cone_around(std::size_t axis, int most, std::uint64_t seed) {
  constexpr float ring[][2] = {{8, 0}, {8, 2}, {7, 4}, {6, 6}, {4, 7}, {2, 8}};
  Random random(seed);
  std::vector<Float3> corners;
  for (int i = 0; i < 12; ++i) {
    const float x = ring[i % 6][0], y = ring[i % 6][1];
    const float rise = i == 0 ? 0.0f : static_cast<float>(random.integer(-most, most));
    corners.push_back(i < 6 ? Float3{x, y, rise} : Float3{-y, x, rise});
  }
  for (std::size_t i = 0; i < 12; ++i)
    corners.push_back({-corners[i][0], -corners[i][1], 0.0f - corners[i][2]});
  Mesh cone;
  for (std::size_t i = 0; i < corners.size(); ++i)
    append(cone, make_triangle({1, 2, 16}, corners[i], corners[(i + 1) % corners.size()]));
  for (Float3& vertex : cone.vertices)
    std::rotate(vertex.begin(), vertex.end() - static_cast<std::ptrdiff_t>(axis), vertex.end());
  return cone;
}

// Chords that pass the origin, and points so near to it that differences to corners lose them.
TEST(WindingChords, points_beside_chords_at_all_distances) {
  Random random(403);
  const Mesh cone = cone_around(0, 2, 404);
  const float steps[] = {0.0f, 0x1p-149f, 0x1p-100f, 0x1p-60f, 0x1p-40f, 0x1p-26f, 0x1p-13f, 0x1p-3f};
  std::vector<Float3> points;
  for (std::size_t i = 0; i < by_level(600); ++i) {
    Float3 point;
    for (float& x : point) x = steps[random.integer(0, 7)] * random.number(-2, 2);
    points.push_back(point);
  }
  expect_windings_in_both_orders(cone, points, points.size(), random);
}

// Rows on chords along an axis, whose rays go along the chord.
TEST(WindingChords, rows_along_chords) {
  for (std::uint64_t seed = 0; seed < (quick() ? 3u : 8u); ++seed)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      SCOPED_TRACE(axis);
      std::vector<Float3> points;
      for (int k = -15; k <= 15; ++k) {
        Float3 point{};
        point[axis] = static_cast<float>(k) / 2;
        points.push_back(point);
      }
      EXPECT_GE(expect_windings(cone_around(axis, 9, seed), points), 20u);
    }
}

// The edge passes so near to the point that the triangle is a lune: from below the point, along −z, to the third
// corner. Products of the large coordinate hide the small ones.
TEST(WindingChords, a_point_beside_an_edge_of_large_and_small_coordinates) {
  const double lune = (std::numbers::pi / 2 + std::atan(0.25 / 4)) / (2 * std::numbers::pi);
  for (const float large : {0x1p40f, 0x1p56f, 0x1p60f, 0x1p100f})
    for (const bool is_turned : {false, true}) {
      SCOPED_TRACE(large);
      const Float3 near{0, 1, 0.5f}, far{0, -large, 0}, third{4, 0, 0.75f};
      Mesh mesh;
      append(mesh, is_turned ? make_triangle(far, near, third) : make_triangle(near, far, third));
      const std::vector<Float3> points = {{0, 0, 0.5f}};
      each_tree(mesh, [&](const auto& tree, const Path* path) {
        std::vector<float> numbers(1);
        tree.winding_numbers(points, numbers, {.path = path});
        EXPECT_NEAR(numbers[0], is_turned ? lune : -lune, 1.5e-6);
      });
    }
}

}  // namespace
}  // namespace raylanes::testing
