// Trees of any size whose batches of single rays go as in large ones: some rays at a time, where the path has the code.
#pragma once

#include "../../../accel/layout/bvh_arrays.hpp"
#include "../../../accel/queries/traced_tree.hpp"

namespace raylanes::testing {

// Not while others query the tree. Without effect on an empty one.
inline void let_rays_fly(Bvh& bvh) {
  const TracedTree tree = TreeOf::bvh(bvh);
  if (tree.view.root == empty_reference) return;
  const_cast<BvhArrays&>(static_cast<const BvhArrays&>(*tree.leaves)).rays_wait = true;
}

}  // namespace raylanes::testing
