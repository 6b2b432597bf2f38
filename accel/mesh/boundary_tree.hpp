// The boundary of a mesh as kernels walk it: a tree over short loops, with the moments of their caps.
#pragma once

#include "../../dispatch/table/winding.hpp"
#include "boundary.hpp"

namespace raylanes {

class BoundaryTree {
 public:
  // The boundary of a closed mesh: without nodes.
  BoundaryTree() = default;
  // The same bytes for any number of threads, as in TraceOptions.
  template <class T>
  explicit BoundaryTree(const LoopsOf<T>& boundary, int threads = 1, const Progress* progress = nullptr);

  BoundaryView view() const;

 private:
  std::vector<BoundaryNode> nodes_;
  std::vector<BoundaryLoop> loops_;
  std::vector<double> corners_;
  BoundaryScale scale_;
};

}  // namespace raylanes
