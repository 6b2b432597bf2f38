#include "point_order.hpp"

#include "../../dispatch/bits.hpp"
#include "morton_code.hpp"
#include "sort_keys.hpp"

namespace raylanes {
namespace {

constexpr float cells = 1024.0f;

// Cells of the box, with half as much on each side; NaN is in the first one.
class Grid {
 public:
  explicit Grid(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float half = 0.5f * box.hi[axis] - 0.5f * box.lo[axis];
      first_[axis] = box.lo[axis] - half;
      per_length_[axis] = cells / (4.0f * half);
    }
  }
  std::uint64_t code(const Float3& point) const {
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float x = (point[axis] - first_[axis]) * per_length_[axis];
      code |= spread_bits(!(x > 0.0f)         ? 0
                          : x >= cells - 1.0f ? std::uint64_t{1023}
                                              : static_cast<std::uint64_t>(x))
              << axis;
    }
    return code;
  }

 private:
  float first_[3], per_length_[3];
};

}  // namespace

void order_points(const VertexView& points, std::size_t begin, const Box& box, LaneBits active,
                  std::span<std::uint64_t> order) {
  constexpr std::uint64_t behind_all = 0xffffffff;
  const Grid grid(box);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint64_t code = takes_part(active, begin + k) ? grid.code(points[begin + k]) : behind_all;
    order[k] = code << 32 | k;
  }
  sort_keys(order);
}

}  // namespace raylanes
