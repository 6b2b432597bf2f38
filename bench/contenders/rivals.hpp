// Other libraries on the same mesh, one ray or point a call, as their manuals show it: Embree with triangles of the
// caller's own and for closest points, CGAL's trees (Alliez, Tayeb, Wormser 2009).
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/queries.hpp>

#include "../support/oracles/exact_rays.hpp"

namespace raylanes::bench {

// CGAL with the kernel of exact predicates and inexact constructions.
class CgalContender {
 public:
  CgalContender(std::span<const Float3> vertices, std::span<const Index3> triangles);
  ~CgalContender();

  // How many intersections of each ray from its origin to infinity all_intersections() finds, which also constructs the
  // points; tmin and tmax are not asked.
  void count_hits(std::span<const Ray> rays, std::span<std::uint32_t> counts) const;
  // Side_of_triangle_mesh; the mesh is closed and oriented. Throws std::invalid_argument if it is not.
  void locate(std::span<const Float3> points, std::span<Location> locations) const;

 private:
  struct Trees;
  std::unique_ptr<Trees> trees_;
};

// Embree over triangles of doubles in a callback, as programs for transport of radiation use it: boxes of floats are
// widened, and each triangle that Embree offers is tested in doubles, by the edges' signs in a fixed order of their
// ends (Platis, Theoharis 2003). Subnormal numbers count as zero meanwhile, as Embree's manual asks.
class EmbreeDoubles {
 public:
  // Boxes are widened by 2^-22 of the largest coordinate, which is what rounding an origin there takes. The mesh must
  // outlive it. Throws std::runtime_error where this build has no Embree, or Embree reports an error.
  explicit EmbreeDoubles(const oracle::DoubleMesh& mesh);
  ~EmbreeDoubles();

  // For the same number of rays and results.
  void closest(std::span<const RayD> rays, std::span<HitD> hits) const;
  void occluded(std::span<const RayD> rays, std::span<std::uint8_t> occluded) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

// Whether a filter rejects a triangle: of any mesh `share` of 256, spread by a hash.
inline bool is_rejected(std::uint32_t primitive, unsigned share) {
  return (primitive * 2654435761u) >> 24 < share;
}
// Embree with filters, one ray a call.
class EmbreeFilters {
 public:
  // Throws std::runtime_error where this build has no Embree, or Embree reports an error.
  EmbreeFilters(const Mesh& mesh, bool is_robust);
  ~EmbreeFilters();

  // All hits of each ray, sorted as ours are: a filter callback records each hit and rejects it, as Embree's manual
  // says.
  void all_hits(std::span<const Ray> rays, RayLists<Hit>& lists) const;
  // Whether each ray has a hit that is_rejected() does not reject: the nearest one is looked for, or any.
  void keep(std::span<const Ray> rays, bool only_decides, unsigned share,
            std::span<std::uint8_t> found) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

// CGAL's AABB_tree with exact predicates and inexact constructions: first_intersected_primitive().
// Rays begin at their origin and have no end.
class CgalDoubles {
 public:
  explicit CgalDoubles(const oracle::DoubleMesh& mesh);
  ~CgalDoubles();

  // The primitives of hits are those that are nearest by CGAL; their other numbers are not set.
  void closest(std::span<const RayD> rays, std::span<HitD> hits) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

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
