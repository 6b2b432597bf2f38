#include "refit.hpp"

namespace raylanes {

void refit_tree(WideTree& tree, VertexView vertices, IndexView triangles, int threads) {
  const auto refill = [&](TreeReference leaf) {
    const auto [block, size] = leaf_of(leaf);
    return tree.corners.refill(block, size, vertices, triangles);
  };
  NodeRefitter(tree, refill).refit(threads);
}

}  // namespace raylanes
