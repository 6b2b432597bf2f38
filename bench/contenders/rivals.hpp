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

// Whether a filter rejects a hit: the hits of `share` of 256 triangles, spread by a hash; or, by the share of_alpha, as
// a texture would that cuts a leaf out of each pair of triangles.
inline constexpr unsigned of_alpha = ~0u;
inline bool is_rejected(const Hit& hit, unsigned share) {
  if (share != of_alpha) return (hit.primitive * 2654435761u) >> 24 < share;
  const bool is_first = hit.primitive % 2 == 0;
  const float across = is_first ? hit.u + hit.v : hit.u, along = is_first ? hit.v : hit.u + hit.v;
  return std::abs(across - 0.5f) > 0.5f * std::sqrt(along * (1 - along));
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

// A test of one's own: whether a ray meets a sphere, and where it enters or else leaves it.
inline bool meets(const Sphere& sphere, const Ray& ray, Hit& hit) {
  float squared = 0, along = 0, off_axis = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += ray.direction[axis] * ray.direction[axis];
    along += (sphere.centre[axis] - ray.origin[axis]) * ray.direction[axis];
  }
  const float middle = along / squared;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float x = sphere.centre[axis] - ray.origin[axis] - middle * ray.direction[axis];
    off_axis += x * x;
  }
  const float free = sphere.radius * sphere.radius - off_axis;
  if (!(free >= 0)) return false;
  const float half = std::sqrt(free / squared), entry = middle - half;
  hit = {entry >= ray.tmin ? entry : middle + half, 0, 0, 0};
  return hit.t >= ray.tmin && hit.t <= ray.tmax;
}
// Embree with spheres: its sphere points, or user geometries with the test above. Spheres outlive it.
class EmbreeSpheres {
 public:
  // Throws std::runtime_error where this build has no Embree, or Embree reports an error.
  EmbreeSpheres(std::span<const Sphere> spheres, bool are_own);
  ~EmbreeSpheres();

  // One ray a call, or packets of 16.
  void closest(std::span<const Ray> rays, std::span<Hit> hits, bool in_packets) const;
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> flags, bool in_packets) const;

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
