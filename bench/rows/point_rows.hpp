// How fast points are located, their closest points and signed distances found, beside others on the same points.
#pragma once

#include <raylanes/paths.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/types.hpp>

#include "../support/oracles/winding_sum.hpp"
#include "../support/readers/printable.hpp"
#include "../support/rulers/measure.hpp"
#include "../support/scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

// The grid of points of --grid.
using Grid = std::array<std::uint32_t, 3>;

// The largest number of points in a set: with their answers they take some hundred bytes each.
inline constexpr std::size_t max_points = std::size_t{1} << 24;

// "NxNxN". Throws std::invalid_argument for anything else, and for what is too large.
inline Grid parse_grid(const std::string& text) {
  Grid grid{};
  std::size_t at = 0;
  const std::string wrong = "--grid: \"" + printable(text) +
                            "\" is not NxNxN, each from 1 to 2000, together " + std::to_string(max_points) +
                            " points at most (256x256x256)";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t end = axis < 2 ? text.find('x', at) : text.size();
    if (end == std::string::npos || end == at || end - at > 4) throw std::invalid_argument(wrong);
    for (; at < end; ++at) {
      if (text[at] < '0' || text[at] > '9') throw std::invalid_argument(wrong);
      grid[axis] = 10 * grid[axis] + static_cast<std::uint32_t>(text[at] - '0');
    }
    if (grid[axis] < 1 || grid[axis] > 2000) throw std::invalid_argument(wrong);
    ++at;
  }
  if (std::size_t{grid[0]} * grid[1] * grid[2] > max_points) throw std::invalid_argument(wrong);
  return grid;
}

// The middles of the cells of a grid over the box, x fastest.
inline std::vector<Float3> points_of(const Box& box, const Grid& grid) {
  std::vector<Float3> points;
  points.reserve(std::size_t{grid[0]} * grid[1] * grid[2]);
  const auto at = [&](std::size_t axis, std::uint32_t i) {
    const double share = (i + 0.5) / grid[axis];
    return static_cast<float>((1 - share) * double(box.lo[axis]) + share * double(box.hi[axis]));
  };
  for (std::uint32_t z = 0; z < grid[2]; ++z)
    for (std::uint32_t y = 0; y < grid[1]; ++y)
      for (std::uint32_t x = 0; x < grid[0]; ++x) points.push_back({at(0, x), at(1, y), at(2, z)});
  return points;
}

// Queries of points: TriangleTree::locate(), closest_points(), signed_distances(), winding_numbers().
enum class PointQuery : std::uint8_t { inside, closest, signed_distance, winding };
inline constexpr std::array<std::string_view, 4> point_query_names{"inside", "closest", "signed", "winding"};

// Places of points: anywhere in the box of the scene, enlarged by a tenth on each side; within a hundredth of the
// scene's diagonal of a triangle, with equal chances for each triangle; or in a grid. Neighbours in the batch are not
// neighbours in space.
enum class PointKind : std::uint8_t { box, surface, grid };
inline constexpr std::array<std::string_view, 3> point_kind_names{"box", "surface", "grid"};

struct PointRowsOptions {
  std::vector<const Path*> paths = {};
  std::vector<PointQuery> queries{PointQuery::inside, PointQuery::closest, PointQuery::signed_distance};
  std::vector<PointKind> kinds{PointKind::box, PointKind::surface};
  std::size_t count = 0;
  Grid grid{};
  InsideRule rule = InsideRule::parity;
  int threads = 1;
  bool against_embree = false, against_cgal = false, against_barill = false;
  double accuracy = 1e-6;  // of winding numbers
  double beta = 2;         // of FastWinding
  double seconds = 3;
};

std::vector<Float3> points_of(const Scene& scene, PointKind kind, const PointRowsOptions& options);

struct PointRow {
  PointQuery query;
  PointKind kind;
  std::string contender, path;
  std::size_t points = 0, points_per_call = 0;
  double mpoints_per_second = 0, spread = 0;
  // How many times as fast the BVH on the same points is, on the last of the paths, with the same calls; none of the
  // BVH itself.
  std::optional<Quartiles> behind = {};
  // The largest difference of a distance from that of the BVH, in diagonals of the scene. Infinite if a point is inside
  // for one of ours and not for the BVH.
  double largest_difference = 0;
  // The largest difference of winding numbers from the sums of solid angles of all triangles, at the judged points.
  double winding_error = 0;
  std::size_t inside = 0, on = 0;
  // The points that were judged, and how many results of them are wrong: places that differ from those by rational
  // numbers, which mean nothing if the mesh is not closed, or winding numbers beyond their bound.
  std::size_t judged = 0, wrong = 0;
  bool is_closed = true;

  bool is_ours() const { return contender == "bvh" || contender == "kdtree"; }
  // Whether the row keeps the promises of ours: distances and places equal to the BVH's, and correct.
  bool is_sound() const { return !is_ours() || (largest_difference == 0 && (wrong == 0 || !is_closed)); }
  // Judges the winding number of a point, which may be off by `allowed` and by its rounding to float. Near edges the
  // sum may be off by its error, and the number by twice as much. Points where the sum is no judge do not count.
  void judge_winding(float number, const oracle::WindingSum& sum, double allowed);
};

// The largest difference of distances that are given as their squares, in diagonals. A NaN beside anything is an
// infinite one.
double largest_difference(std::span<const double> a, std::span<const double> b, double diagonal);

// A sentence if the mesh lacks a property that parity or winding numbers need, else nothing.
std::string holes_of(const Mesh& mesh, InsideRule rule);

std::vector<PointRow> measure_points(const Scene& scene, const PointRowsOptions& options);

}  // namespace raylanes::bench
