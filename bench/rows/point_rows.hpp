// How fast closest points are found in a scene, beside others on the same points.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <raylanes/paths.hpp>

#include "../support/rulers/measure.hpp"
#include "../support/scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

// Where points are: anywhere in the box of the scene, larger by a tenth on each side; or within a hundredth of its
// diagonal of a triangle, all of which are equally likely. Neighbours in the batch are strangers.
enum class PointKind : std::uint8_t { box, surface };
inline constexpr std::array<std::string_view, 2> point_kind_names{"box", "surface"};

std::vector<Float3> points_of(const Scene& scene, PointKind kind, std::size_t count);

struct PointRowsOptions {
  std::vector<const Path*> paths;
  std::vector<PointKind> kinds{PointKind::box, PointKind::surface};
  std::size_t count = 0;
  int threads = 1;
  bool against_embree = false, against_cgal = false;
  double seconds = 3;
};

struct PointRow {
  PointKind kind;
  std::string contender, path;
  double mpoints_per_second = 0, spread = 0;
  // How many times as fast the BVH on the same points is, on the last of the paths; none of the BVH itself.
  std::optional<Quartiles> behind;
  // The largest difference of a distance from that of the BVH, in diagonals of the scene.
  double largest_difference = 0;

  // Whether ours has the distances that all of ours promise: those of the BVH. Others may round.
  bool is_sound() const { return largest_difference == 0 || (contender != "bvh" && contender != "kdtree"); }
};

// The largest difference of distances that are given as their squares, in diagonals. A NaN beside anything is an
// infinite one.
double largest_difference(std::span<const double> a, std::span<const double> b, double diagonal);

std::vector<PointRow> measure_points(const Scene& scene, const PointRowsOptions& options);

}  // namespace raylanes::bench
