#include "refit.hpp"

namespace raylanes {

void refit_tree(WideTree& tree, VertexView vertices, IndexView triangles, int threads) {
  const TriangleRow* const prepares = tree.prepared.count() > 0 ? &tree.prepared.row() : nullptr;
  const auto refill = [&](TreeReference leaf) {
    const auto [block, size] = leaf_of(leaf);
    const Box box = tree.corners.refill(block, size, vertices, triangles);
    if (prepares != nullptr) tree.prepared.prepare_again(*prepares, block, size, tree.corners);
    return box;
  };
  NodeRefitter(tree, refill).refit(threads);
}

}  // namespace raylanes
