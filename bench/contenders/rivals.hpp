// Other libraries that find closest points: on the same mesh, one point after the other, as their manuals show it.
#pragma once

#include <memory>
#include <span>

#include <raylanes/mesh.hpp>

namespace raylanes::bench {

// Embree's rtcPointQuery with a scalar callback for each primitive, in floats (Ericson 2005, 5.1.5). As Embree's manual
// asks, subnormal numbers count as zero meanwhile; MXCSR is as before afterwards.
class EmbreePoints {
 public:
  // Throws std::runtime_error where this build has no Embree, or Embree reports an error.
  explicit EmbreePoints(const Mesh& mesh);
  ~EmbreePoints();
  // The squared distances; points are finite.
  void closest(std::span<const Float3> points, std::span<double> squared) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

// CGAL's AABB_tree::closest_point with its accelerating k-d tree, in doubles (Simple_cartesian): its fastest kernel.
class CgalPoints {
 public:
  // Triangles with two equal corners are left out.
  explicit CgalPoints(const Mesh& mesh);
  ~CgalPoints();
  void closest(std::span<const Float3> points, std::span<double> squared) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace raylanes::bench
