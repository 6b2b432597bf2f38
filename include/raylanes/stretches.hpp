// The stretches of rays within solids: from entry to exit, with winding numbers. docs/crossings.md has the definition.
#pragma once

#include <cstdint>

#include <raylanes/doubles.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/scene_d.hpp>
#include <raylanes/triangle_tree.hpp>

namespace raylanes {

/// A stretch of a ray along which the winding number is one number other than 0.
template <class Number>
struct StretchRecord {
  Number entry, exit;  ///< where it begins and ends: entry < exit
  std::uint32_t entered_by,
      left_by;           ///< the triangles crossed there; no_primitive where the ray itself begins or ends
  std::int32_t winding;  ///< the winding number; 1 in a closed mesh whose normals point out

  bool operator==(const StretchRecord&) const = default;
};
/// A stretch of a ray of floats.
using Stretch = StretchRecord<float>;
/// A stretch of a ray of doubles.
using StretchD = StretchRecord<double>;
/// A stretch of a ray within an instance of a scene.
struct SceneStretch : Stretch {
  std::uint32_t geometry, instance;  ///< of the scene, as in SceneHit

  bool operator==(const SceneStretch&) const = default;
};
/// A stretch of a ray within an instance of a scene of doubles.
struct SceneStretchD : StretchD {
  std::uint32_t geometry, instance;  ///< of the scene, as in SceneHitD

  bool operator==(const SceneStretchD&) const = default;
};

/// Returns the stretches of each ray within the solids of a tree, in order: each entry with its exit.
/// They are made of crossings(): the winding number is 0 at the far end of the ray's line, and changes by the sides of
/// the crossings. So it is right from tmin on, also where the ray begins in a solid or on a surface. Crossings at one t
/// count together: where the ray touches an edge, or passes from one solid into the next that shares a face, nothing
/// ends. Stretches whose ends round to one number are left out.
/// The sum of (exit − entry)·winding is that of exact arithmetic, but for the rounding of each crossing's t.
/// Undecided are rays with tmin < 0 whose origin lies on an edge: crossings() does not count a crossing at t = 0 there.
/// Takes the time and memory of crossings() of rays without an end. options.skip leaves out a crossing of that triangle
/// from the sums. Throws as crossings() does, and std::invalid_argument if options.facing is not Facing::any.
RayLists<Stretch> stretches(const TriangleTree& tree, RayView rays, const ListOptions& options = {});
/// Returns the stretches of each ray of doubles within the solids of a tree, in order.
RayLists<StretchD> stretches(const BvhD& tree, RayViewD rays, const ListOptions& options = {});
/// Returns the stretches of each ray within the instances of a scene that options.mask sees, in the
/// order of entries, then of instances. Each instance has stretches of its own, as stretches() of its tree and the ray
/// in its space: where instances overlap, so do their stretches. options.skip takes hits in scenes.
/// Throws as stretches() of a tree, std::invalid_argument if a geometry does not consist of triangles, and
/// std::logic_error if the scene was changed without update().
RayLists<SceneStretch> stretches(const Scene& scene, RayView rays, const ListOptions& options = {});
/// Returns the stretches of each ray of doubles within the instances of a scene.
RayLists<SceneStretchD> stretches(const SceneD& scene, RayViewD rays, const ListOptions& options = {});

}  // namespace raylanes
