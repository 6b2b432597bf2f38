// The update of scenes of doubles.
#pragma once

#include "scene_d_parts.hpp"

namespace raylanes {

// As SceneD::update().
void update_parts(SceneDParts& scene, int threads);

}  // namespace raylanes
