// Hits in scenes, and closest points.
#pragma once

#include <cstdint>
#include <limits>

#include <raylanes/types.hpp>

namespace raylanes {

/// The index of no geometry and of no instance.
inline constexpr std::uint32_t no_part = 0xffffffffu;

/// An instance of one level of scenes within scenes, as Scene::levels_of() returns them: by the numbers of the scene at
/// that level.
struct InstanceLevel {
  std::uint32_t instance = no_part;
  std::uint32_t geometry = no_part;  ///< what it places

  bool operator==(const InstanceLevel&) const = default;
};

/// A hit in a scene: a Hit, and what was hit. A miss has no_primitive and no_part; a default-constructed one is a miss.
struct SceneHit {
  float t = std::numeric_limits<float>::infinity();
  float u = 0;
  float v = 0;
  std::uint32_t primitive = no_primitive;  ///< index within its geometry
  std::uint32_t geometry = no_part;
  std::uint32_t instance = no_part;

  /// Returns whether this is a hit.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(SceneHit) == 24);

/// The point of a scene's triangles that is closest to a query point, and where it is: (1-u-v)·v0 + u·v1 + v·v2 of the
/// triangle `primitive` of an instance. Distance and point are in the space of the scene. If there is none,
/// distance_squared is +infinity, point, u and v are zeros, and the indices are no_primitive and no_part; so is
/// a default-constructed one. u, v and the coordinates are rounded once from doubles. Ties in distance_squared go to
/// the lowest instance, then to the lowest primitive.
///
/// The corners of an instance's triangle are moved to the scene in doubles, by ((a·x + b·y) + c·z) + d. Here a, b, c, d
/// is a row of the transform. So each coordinate is within 2^-51·S, with S the largest |a·x| + |b·y| + |c·z| + |d|.
/// With the identity corners stay as they are. For the triangle with these corners distance_squared has the bounds of
/// ClosestPoint, whatever the transform: with M the distance to its farthest corner, it is off by at most 2^-46·M².
/// For the exact transform it is off by at most 2^-46·M² + 2^-48·M·S + 2^-96·S². The bits are the same on every path.
struct SceneClosestPoint {
  double distance_squared = std::numeric_limits<double>::infinity();
  Float3 point{};
  float u = 0;
  float v = 0;
  std::uint32_t primitive = no_primitive;  ///< index within its geometry
  std::uint32_t geometry = no_part;
  std::uint32_t instance = no_part;

  /// Returns whether there is a closest point.
  explicit operator bool() const { return primitive != no_primitive; }
};
static_assert(sizeof(SceneClosestPoint) == 40);

}  // namespace raylanes
