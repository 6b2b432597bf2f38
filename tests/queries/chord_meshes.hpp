// Meshes with large holes, whose boundaries are cut by chords, and points on these chords.
#pragma once

#include "../support/random_input.hpp"

namespace raylanes::testing {

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
inline std::vector<Float3> points_of_chords(const std::vector<Float3>& corners, std::size_t planes,
                                            Random& random) {
  const auto between = [](const Float3& a, const Float3& b, float share) {
    Float3 point;
    for (std::size_t k = 0; k < 3; ++k) point[k] = a[k] * (1 - share) + b[k] * share;
    return point;
  };
  std::vector<Float3> points;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (const float share : {0.25f, 0.5f, 0.75f}) points.push_back(between(corners[i], corners[j], share));
  const auto corner = [&] { return corners[random.index(corners.size())]; };
  const float shares[] = {-0.25f, 0.25f, 0.5f, 1.25f};
  for (std::size_t i = 0; i < planes; ++i)
    points.push_back(between(between(corner(), corner(), 0.5f), corner(), shares[random.integer(0, 3)]));
  return points;
}

// A cone over a ring of 24 corners, each with its opposite. The two on `axis` begin the halves that a chord along that
// axis cuts. Corners rise by up to `most`, so that a direction may be near one half alone.
inline Mesh cone_around(std::size_t axis, int most, std::uint64_t seed) {
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

}  // namespace raylanes::testing
