// Trees in files. docs/tree_file.md has the layout.
#pragma once

#include <iosfwd>

#include "../layout/wide_tree.hpp"

namespace raylanes {

// Throws std::runtime_error if the stream does not take it.
void save_tree(const WideTree& tree, std::ostream& file);

// Reads what save_tree wrote, and nothing behind it. Throws std::runtime_error, in one line, for anything else: memory
// is asked for as the file turns out to hold what it says.
WideTree load_tree(std::istream& file);

}  // namespace raylanes
