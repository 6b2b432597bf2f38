// Hits in scenes.
#pragma once

#include <cstdint>
#include <limits>

#include <raylanes/types.hpp>

namespace raylanes {

/// The index of no geometry and of no instance.
inline constexpr std::uint32_t no_part = 0xffffffffu;

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

}  // namespace raylanes
