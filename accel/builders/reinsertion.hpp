// A better tree from one that is there.
#pragma once

#include "../batch/meters.hpp"
#include "../layout/binary_tree.hpp"

namespace raylanes {

// Large subtrees cut out and hung again where the sum of all boxes' areas grows least (Bittner, Hapala, Havran 2013),
// in batches (Meister, Bittner 2018): the same references in a tree that is expected to cost less. No leaf is deeper
// than max_binary_depth; parts of a primitive may come to lie side by side. The tree is the same for any number of
// threads; the one given where nothing can be gained. The memory of the result is held for that of the argument.
BinaryTree reinserted(BinaryTree tree, const BuildRun& run);

}  // namespace raylanes
