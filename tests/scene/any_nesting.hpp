// Scenes of floats or doubles within others, by any bytes.
#pragma once

#include <raylanes/scene_d.hpp>

#include "../fuzz/bytes.hpp"
#include "../fuzz/targets.hpp"

namespace raylanes::testing {

// Often one that others have.
inline std::uint32_t any_mask(Bytes& bytes) {
  return bytes.chance(100)   ? ~0u
         : bytes.chance(200) ? static_cast<std::uint32_t>(bytes.below(5))
                             : bytes.byte();
}

// As a scene within another one, some times, beside its own parts alone. Then that changes as it may.
template <class AnyScene, class AnyTransform>
AnyScene within_another(Bytes& bytes, const AnyScene& scene, const AnyTransform& any_transform) {
  AnyScene outer;
  outer.add(scene);
  for (std::size_t places = 1 + bytes.below(3); places > 0; --places)
    outer.place(bytes.chance(200) ? 0 : static_cast<std::uint32_t>(bytes.below(outer.geometry_count())),
                any_transform(), any_mask(bytes));
  outer.update();
  for (std::size_t steps = bytes.below(4); steps > 0; --steps) {
    const auto instance = static_cast<std::uint32_t>(bytes.below(outer.instance_count()));
    const std::size_t kind = bytes.below(3), levels = outer.levels_of(instance).size();
    try {
      if (kind == 0) outer.set_mask(instance, any_mask(bytes));
      if (kind == 1) outer.set_moving(instance, bytes.chance(128));
      if (kind == 2) outer.move(instance, any_transform());
      if (levels > 1) fail("a part of a scene was changed by itself");
    } catch (const std::invalid_argument&) {
      if (levels == 1) fail("an instance could not be changed");
    }
    if (kind == 2 || bytes.chance(64) || std::is_same_v<AnyScene, SceneD>) outer.update();
  }
  return outer;
}

}  // namespace raylanes::testing
