// A tree as kernels see it, for what walks it by their text.
#pragma once

#include <raylanes/bvh.hpp>

#include "../../../dispatch/table/tree_view.hpp"

namespace raylanes::bench {

// For tests that read corners. Valid as long as bvh.view() is.
inline TreeView kernel_view(const Bvh& bvh) {
  const BvhView view = bvh.view();
  return {view.nodes.data(), view.leaves.data(), view.root, view.bounds};
}

}  // namespace raylanes::bench
