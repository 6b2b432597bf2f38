// Trees over spheres.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/spheres.hpp>

namespace raylanes {

/// A tree over the surfaces of spheres. A default-constructed or moved-from object has no spheres.
/// Many threads may query one object at the same time.
class SphereTree {
 public:
  SphereTree() noexcept;
  /// Builds the tree over a copy of the spheres; options.slack and options.max_in_leaf are ignored.
  /// Spheres with a NaN, a negative radius, or a radius whose square overflows are left out: nothing hits them. Throws
  /// as BoundedTree's constructor does.
  explicit SphereTree(std::span<const Sphere> spheres, const BoundedBuildOptions& options = {});
  ~SphereTree();
  SphereTree(SphereTree&&) noexcept;
  SphereTree& operator=(SphereTree&&) noexcept;

  /// Finds the nearest surface that each ray meets: hits[i] has the bytes that closest_hit() of <raylanes/spheres.hpp>
  /// returns for ray i and all spheres, on every ISA path. Spheres that reach beyond the largest float are not hit.
  /// Inactive rays leave their hit unchanged. Throws as BoundedTree::closest() does.
  void closest(RayView rays, std::span<Hit> hits, const VisitOptions& options = {}) const;
  /// Sets answers[i] to 1 if ray i meets the surface of a sphere, else to 0. A ray inside a sphere does not.
  void occluded(RayView rays, std::span<std::uint8_t> answers, const VisitOptions& options = {}) const;

  Box bounds() const noexcept;        ///< the box around all spheres
  std::size_t size() const noexcept;  ///< the number of spheres that the tree was built over
  /// Returns the number of spheres that nothing hits: those that were left out, and those beyond the largest float.
  std::size_t left_out() const noexcept;
  std::size_t bytes() const noexcept;  ///< the bytes of nodes and spheres

 private:
  friend class Scene;
  std::unique_ptr<struct SphereLeaves> tree_;  // null: none
};

}  // namespace raylanes
