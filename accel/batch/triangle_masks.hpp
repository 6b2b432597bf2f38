// The masks of triangles, from options to kernels.
#pragma once

#include "../../dispatch/table/tree_view.hpp"

namespace raylanes {

// The masks of options as kernels take them; none if these options have none.
template <class Options>
TriangleMasks masks_of(const Options& options) {
  if constexpr (requires { options.masks; })
    if (!options.masks.empty()) {
      TriangleMasks masks{options.masks.data(), options.masks.size(), options.mask};
      if constexpr (requires { options.filter_mask; }) masks.filter_mask = options.filter_mask;
      return masks;
    }
  return {};
}
// Whether a filter is asked about a hit.
struct MayReject {
  TriangleMasks masks;

  template <class AnyHit>
  bool operator()(const AnyHit& hit) const {
    return masks.may_reject(hit.primitive);
  }
};

}  // namespace raylanes
