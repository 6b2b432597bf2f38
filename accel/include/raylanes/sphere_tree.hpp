// Trees over spheres.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/spheres.hpp>

namespace raylanes {

// A tree over the surfaces of spheres. Default-constructed or moved from, it has none.
class SphereTree {
 public:
  SphereTree() noexcept;
  // Has its own copy. Spheres that nothing hits are left out: with a negative or infinite radius, or one whose square
  // overflows, or a NaN. Options and exceptions as of BoundedTree; slack and max_in_leaf are not looked at.
  explicit SphereTree(std::span<const Sphere> spheres, const BoundedBuildOptions& options = {});
  ~SphereTree();
  SphereTree(SphereTree&&) noexcept;
  SphereTree& operator=(SphereTree&&) noexcept;

  // What closest_hit() of <raylanes/spheres.hpp> returns of the ray and all spheres, bit for bit, on any path; but
  // spheres that reach beyond the largest float are not hit. occluded: whether there is such a hit, so that a ray that
  // ends inside hits nothing. All else as of BoundedTree.
  void closest(RayView rays, std::span<Hit> hits, const VisitOptions& options = {}) const;
  void occluded(RayView rays, std::span<std::uint8_t> answers, const VisitOptions& options = {}) const;

  Box bounds() const noexcept;
  std::size_t size() const noexcept;  // spheres that it was built over
  std::size_t bytes() const noexcept;

 private:
  friend class Scene;
  std::unique_ptr<struct SphereLeaves> tree_;  // null: none
};

}  // namespace raylanes
