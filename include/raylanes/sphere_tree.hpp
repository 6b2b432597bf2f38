// Trees over spheres.
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <span>

#include <raylanes/bounded_tree.hpp>
#include <raylanes/mesh.hpp>
#include <raylanes/queries.hpp>
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

  /// Returns the nearest surface that the ray meets, with the bytes that closest_hit() of <raylanes/spheres.hpp>
  /// returns for all spheres, on every ISA path. Spheres that reach beyond the largest float are not hit.
  /// A sphere has two hits, in and out: options.after finds one behind the other. If options.skip names a sphere, its
  /// hit nearer to tmin, where the ray begins, is not there; the other one is. Throws as BoundedTree::closest() does.
  Hit closest(const Ray& ray, const VisitOptions& options = {}) const;
  /// Returns whether the ray meets the surface of a sphere. A ray inside a sphere does not. Throws as closest() does.
  bool occluded(const Ray& ray, const VisitOptions& options = {}) const;
  /// Finds the nearest surface that each ray meets: hits[i] belongs to ray i.
  /// Inactive rays leave their hit unchanged. Throws as BoundedTree::closest() does.
  void closest(RayView rays, HitView hits, const VisitOptions& options = {}) const;
  /// Finds the nearest surface that each ray meets, given as one array per number.
  void closest(const RayArrays& rays, HitView hits, const VisitOptions& options = {}) const;
  /// Sets occluded[i] to 1 if ray i meets the surface of a sphere, else to 0. A ray inside a sphere does not.
  void occluded(RayView rays, std::span<std::uint8_t> occluded, const VisitOptions& options = {}) const;
  /// Sets occluded[i] for each ray, given as one array per number.
  void occluded(const RayArrays& rays, std::span<std::uint8_t> occluded,
                const VisitOptions& options = {}) const;
  /// Sets occluded[i] to 1 if the surface of a sphere lies between `from` and points[i], else to 0, as
  /// TriangleTree::occluded_from(). Throws as occluded() does.
  void occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                     const SegmentEnds& ends = {}, const VisitOptions& options = {}) const;
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction meets the surface of a sphere, else to 0: as
  /// TriangleTree::occluded_towards(). Throws as occluded() does.
  void occluded_towards(const Float3& direction, VertexView points, std::span<std::uint8_t> occluded,
                        const VisitOptions& options = {}) const;

  /// Finds the nearest hit of each ray that the filter does not reject; otherwise as TriangleTree::closest() with a
  /// filter.
  template <class Rays, std::convertible_to<HitFilter> Filter>
  void closest(const Rays& rays, HitView hits, const Filter& filter, const VisitOptions& options = {}) const {
    filtered_closest(rays, hits, filter, options);
  }
  /// Sets occluded[i] to 1 if the segment of ray i has a hit that the filter does not reject, else to 0.
  template <class Rays, std::convertible_to<HitFilter> Filter>
  void occluded(const Rays& rays, std::span<std::uint8_t> occluded, const Filter& filter,
                const VisitOptions& options = {}) const {
    filtered_occluded(rays, occluded, filter, options);
  }
  /// Sets occluded[i] to 1 if the segment from `from` to points[i] has a hit that the filter keeps, else to 0.
  template <std::convertible_to<HitFilter> Filter>
  void occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                     const Filter& filter, const SegmentEnds& ends = {},
                     const VisitOptions& options = {}) const {
    filtered_occluded_from(from, points, occluded, filter, ends, options);
  }
  /// Sets occluded[i] to 1 if the ray from points[i] in that direction has a hit that the filter keeps, else to 0.
  template <std::convertible_to<HitFilter> Filter>
  void occluded_towards(const Float3& direction, VertexView points, std::span<std::uint8_t> occluded,
                        const Filter& filter, const VisitOptions& options = {}) const {
    filtered_occluded_towards(direction, points, occluded, filter, options);
  }
  /// Returns the nearest hit of the ray for which rejects(hit) is false. If it is true, the ray goes on behind the hit.
  template <std::predicate<const Hit&> Rejects>
  Hit closest(const Ray& ray, Rejects&& rejects, const VisitOptions& options = {}) const {
    return detail::with_rejection<Hit>(rejects, [&](const detail::Rejection<Hit>& rejection) {
      return closest_kept(ray, rejection, options);
    });
  }
  /// Returns whether the ray's segment has a hit for which rejects(hit) is false.
  template <std::predicate<const Hit&> Rejects>
  bool occluded(const Ray& ray, Rejects&& rejects, const VisitOptions& options = {}) const {
    return detail::with_rejection<Hit>(
        rejects, [&](const detail::Rejection<Hit>& rejection) { return any_kept(ray, rejection, options); });
  }

  Box bounds() const noexcept;        ///< the box around all spheres
  std::size_t size() const noexcept;  ///< the number of spheres that the tree was built over
  /// Returns the number of spheres that nothing hits: those that were left out, and those beyond the largest float.
  std::size_t left_out() const noexcept;
  std::size_t bytes() const noexcept;  ///< the bytes of nodes and spheres

 private:
  Hit closest_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                   const VisitOptions& options) const;
  bool any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection, const VisitOptions& options) const;
  void filtered_closest(RayView rays, HitView hits, const HitFilter& filter,
                        const VisitOptions& options) const;
  void filtered_closest(const RayArrays& rays, HitView hits, const HitFilter& filter,
                        const VisitOptions& options) const;
  void filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                         const VisitOptions& options) const;
  void filtered_occluded(const RayArrays& rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                         const VisitOptions& options) const;
  void filtered_occluded_from(const Float3& from, VertexView points, std::span<std::uint8_t> occluded,
                              const HitFilter& filter, const SegmentEnds& ends,
                              const VisitOptions& options) const;
  void filtered_occluded_towards(const Float3& direction, VertexView points, std::span<std::uint8_t> occluded,
                                 const HitFilter& filter, const VisitOptions& options) const;
  friend class Scene;
  std::unique_ptr<struct SphereTreeArrays> tree_;  // null: none
};

}  // namespace raylanes
