// The volume that triangles enclose.
#pragma once

#include <raylanes/numbers.hpp>

#include "../standard.hpp"

namespace raylanes {

// As Scene::containing_parts() says, without a transform. `corners`: nine numbers for each triangle, within the box.
template <class T>
double volume_of(std::span<const T> corners, const BoxOf<T>& box);

}  // namespace raylanes
