// Trees to streams and back.
#include <raylanes/bvh.hpp>

#include "file/tree_file.hpp"

namespace raylanes {

void Bvh::save(std::ostream& file) const {
  const WideTree empty;
  save_tree(tree_ ? *tree_ : empty, file);
}

Bvh Bvh::load(std::istream& file) {
  Bvh bvh;
  bvh.tree_ = std::make_unique<WideTree>(load_tree(file));
  return bvh;
}

}  // namespace raylanes
