#include "sort_keys.hpp"

#ifdef RAYLANES_VQSORT
#include <hwy/contrib/sort/vqsort.h>
#endif

#include "../../dispatch/bits.hpp"

namespace raylanes {

void sort_keys(std::span<std::uint64_t> keys) {
#ifdef RAYLANES_VQSORT
  static thread_local hwy::Sorter sorter;  // holds memory, too slow to allocate for each node of a tree
  sorter(keys.data(), keys.size(), hwy::SortAscending());
#else
  std::sort(keys.begin(), keys.end());
#endif
}

namespace {

// Cells of the box, with half as much on each side; NaN is in the first one.
template <class T>
class Grid {
 public:
  explicit Grid(const BoxOf<T>& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T half = T(0.5) * box.hi[axis] - T(0.5) * box.lo[axis];
      first_[axis] = box.lo[axis] - half;
      per_length_[axis] = cells / (4 * half);
    }
  }
  std::uint64_t code(const PointOf<T>& point) const {
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T x = (point[axis] - first_[axis]) * per_length_[axis];
      code |= spread_bits(!(x > 0)         ? 0
                          : x >= cells - 1 ? std::uint64_t{1023}
                                           : static_cast<std::uint64_t>(x))
              << axis;
    }
    return code;
  }

 private:
  static constexpr T cells = 1024;
  T first_[3], per_length_[3];
};

}  // namespace

template <class T>
void order_points(const VertexRecords<T>& points, std::size_t begin, const BoxOf<T>& box, LaneBits active,
                  std::span<std::uint64_t> order) {
  constexpr std::uint64_t behind_all = 0xffffffff;
  const Grid<T> grid(box);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint64_t code = takes_part(active, begin + k) ? grid.code(points[begin + k]) : behind_all;
    order[k] = code << 32 | k;
  }
  sort_keys(order);
}
template void order_points(const VertexView&, std::size_t, const Box&, LaneBits, std::span<std::uint64_t>);
template void order_points(const VertexRecords<double>&, std::size_t, const BoxD&, LaneBits,
                           std::span<std::uint64_t>);

}  // namespace raylanes
