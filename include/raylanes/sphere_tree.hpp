// Trees over spheres.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/ray_queries.hpp>
#include <raylanes/spheres.hpp>

namespace raylanes {

class SphereTree;
namespace detail {
template <>
struct QueryTypes<SphereTree> {
  using Number = float;
  using Hit = raylanes::Hit;
  using Options = VisitOptions;
};
}  // namespace detail

/// A tree over the surfaces of spheres. A default-constructed or moved-from object has no spheres.
/// The nearest hit has the bytes that closest_hit() of <raylanes/spheres.hpp> returns for all spheres, on every ISA
/// path. Spheres that reach beyond the largest float are not hit. A sphere does not occlude a ray within it.
/// A sphere has two hits, in and out: options.after finds one after the other. If options.skip names a sphere, the hit
/// nearer to tmin, where the ray begins, is not there; the other one is. If a caller rejects a hit, the ray goes on
/// behind it.
class SphereTree : public RayQueries<SphereTree> {
 public:
  SphereTree() noexcept;
  /// Builds the tree over a copy of the spheres; options.slack and options.max_in_leaf are ignored.
  /// Spheres with a NaN, a negative radius, or a radius whose square overflows are left out: nothing hits them. Throws
  /// as BoundedTree's constructor does.
  explicit SphereTree(std::span<const Sphere> spheres, const BoundedBuildOptions& options = {});
  ~SphereTree();
  SphereTree(SphereTree&&) noexcept;
  SphereTree& operator=(SphereTree&&) noexcept;

  Box bounds() const noexcept;        ///< the box around all spheres
  std::size_t size() const noexcept;  ///< the number of spheres that the tree was built over
  /// Returns the number of spheres that nothing hits: those that were left out, and those beyond the largest float.
  std::size_t left_out() const noexcept;
  std::size_t bytes() const noexcept;  ///< the bytes of nodes and spheres

 private:
  friend class Scene;
  friend struct TreeAccess;
  std::unique_ptr<struct SphereTreeArrays> tree_;  // null: none
};

}  // namespace raylanes
