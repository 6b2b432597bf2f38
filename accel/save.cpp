// Trees to streams and back.
#include <raylanes/bvh.hpp>

#include "layout/tree_file.hpp"

namespace raylanes {

void Bvh::save(std::ostream& file) const {
  save_tree(tree_ ? *tree_ : WideTree(), file);
}

Bvh Bvh::load(std::istream& file) {
  Bvh bvh;
  bvh.tree_ = std::make_unique<WideTree>(load_tree(file));
  return bvh;
}

}  // namespace raylanes
