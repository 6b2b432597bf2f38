// Other libraries that trace rays of doubles, one ray a call: Embree with triangles of the caller's own, and CGAL.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "../support/oracles/exact_doubles.hpp"

namespace raylanes::bench {

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

}  // namespace raylanes::bench
