// Trees in files. docs/tree_file.md has the layout.
#pragma once

#include <iosfwd>

#include "../doubles/double_tree.hpp"

namespace raylanes {

// Trees are WideTree or DoubleTree.

// Throws std::runtime_error if the stream does not take it.
template <class Tree>
void save_tree(const Tree& tree, std::ostream& file);

// Reads what save_tree wrote, and nothing behind it. Throws std::runtime_error, in one line, for anything else: memory
// is asked for as the file turns out to hold what it says.
template <class Tree>
Tree load_tree(std::istream& file);

}  // namespace raylanes
