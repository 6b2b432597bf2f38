// Trees of any size whose batches of single rays go as in large ones: some rays at a time, where the path has the code.
#pragma once

#include <type_traits>

#include "../../../accel/doubles/bvh_d_arrays.hpp"
#include "../../../accel/queries/traced_tree.hpp"

namespace raylanes::testing {

// Not while others query the tree. Without effect on an empty one.
template <class Tree>
void let_rays_fly(const Tree& tree, bool fly = true) {
  if (const auto* arrays = TreeAccess::arrays(tree); arrays != nullptr)
    const_cast<std::remove_const_t<std::remove_pointer_t<decltype(arrays)>>*>(arrays)->rays_wait = fly;
}

}  // namespace raylanes::testing
