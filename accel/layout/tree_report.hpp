// A tree in numbers.
#pragma once

#include "bvh_arrays.hpp"

namespace raylanes {

// The tree's report with all that can be counted of it, its leaves and its bytes.
TreeReport report_of(const NodesOfMesh& tree, std::size_t leaves, std::size_t bytes);

}  // namespace raylanes
