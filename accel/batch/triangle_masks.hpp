// The masks of triangles, from options to kernels.
#pragma once

#include "../../dispatch/table/tree_view.hpp"

namespace raylanes {

// The masks of options as kernels take them; none if these options have none.
template <class Options>
TriangleMasks masks_of(const Options& options) {
  if constexpr (requires { options.masks; })
    if (!options.masks.empty()) return {options.masks.data(), options.masks.size(), options.mask};
  return {};
}

}  // namespace raylanes
