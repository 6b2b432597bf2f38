// A tree in numbers.
#pragma once

#include "wide_tree.hpp"

namespace raylanes {

// The tree's report with all that can be counted of it.
TreeReport report_of(const WideTree& tree);

}  // namespace raylanes
