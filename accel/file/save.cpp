// Trees to streams and back.
#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>
#include <raylanes/kdtree.hpp>

#include "cell_file.hpp"
#include "tree_file.hpp"

namespace raylanes {

void Bvh::save(std::ostream& file) const {
  const WideTree empty;
  save_tree(tree_ ? *tree_ : empty, file);
}

Bvh Bvh::load(std::istream& file) {
  return Bvh(std::make_unique<WideTree>(load_tree<WideTree>(file)));
}

void BvhD::save(std::ostream& file) const {
  const DoubleTree empty{};
  save_tree(tree_ ? *tree_ : empty, file);
}

BvhD BvhD::load(std::istream& file) {
  return BvhD(std::make_unique<DoubleTree>(load_tree<DoubleTree>(file)));
}

void KdTree::save(std::ostream& file) const {
  const CellTree empty;
  save_cells(tree_ ? *tree_ : empty, file);
}

KdTree KdTree::load(std::istream& file) {
  return KdTree(std::make_unique<CellTree>(load_cells(file)));
}

}  // namespace raylanes
