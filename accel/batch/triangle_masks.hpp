// The masks of triangles, from options to kernels.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "../../dispatch/table/double_rays.hpp"

namespace raylanes {

// The masks of options as kernels take them; none if these options have none.
template <class Options>
TriangleMasks masks_of(const Options& options) {
  if constexpr (requires { options.masks; })
    if (!options.masks.empty()) {
      TriangleMasks masks{options.masks.data(), options.masks.size(), options.mask};
      if constexpr (requires { options.filter_mask; }) masks.filter_mask = options.filter_mask;
      return masks;
    }
  return {};
}

// A view that calls with one ray walk until the tree changes. Assignment gives it a number that no other view has.
template <class View>
struct LastingView : View {
  std::uint64_t number = 0;

  LastingView& operator=(const View& view) {
    static constinit std::atomic<std::uint64_t> last{0};
    View::operator=(view);
    number = ++last;
    return *this;
  }
};
inline TreeView& nodes_of(TreeView& tree) {
  return tree;
}
inline TreeView& nodes_of(DoubleTreeView& tree) {
  return tree.tree;
}
// A tree with masks, until this thread's next call: for kernels that call nobody back. Kernels read parts of a view as
// vectors, which would wait for the stores of a new copy. So each thread keeps one, of the tree that it asked last.
template <class View>
const View& masked_for_call(const LastingView<View>& tree, const TriangleMasks& masks) {
  thread_local constinit LastingView<View> kept{};
  if (kept.number != tree.number) [[unlikely]]
    kept = tree;
  nodes_of(kept).masks = masks;
  return kept;
}

// Kernels of calls, with a tree of their own if options have masks.
template <class Kernels, class Options>
Kernels with_masks(Kernels kernels, const Options& options) {
  if (options.masks.empty()) return kernels;
  auto tree = std::make_shared<std::remove_cvref_t<decltype(*kernels.view)>>(*kernels.view);
  nodes_of(*tree).masks = masks_of(options);
  kernels.view = tree.get(), kernels.masked = std::move(tree);
  return kernels;
}

// Whether a filter is asked about a hit.
struct MayReject {
  TriangleMasks masks;

  template <class AnyHit>
  bool operator()(const AnyHit& hit) const {
    return masks.may_reject(hit.primitive);
  }
};

}  // namespace raylanes
