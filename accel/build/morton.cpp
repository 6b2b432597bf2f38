#include <hwy/contrib/sort/vqsort.h>

#include <algorithm>

#include "../point/morton_code.hpp"
#include "in_place.hpp"

namespace raylanes {
namespace {

// Twelve bits of each coordinate, the highest bits of all three first, above the position: no two keys are equal.
constexpr unsigned position_bits = 28, code_bits = 36;

class Morton {
 public:
  explicit Morton(BuildInput& input)
      : memory_(input.run.memory), threads_(input.run.threads), references_(std::move(input.references)) {
    memory_.hold(references_.bytes());
    sort();
  }
  ~Morton() { memory_.release(references_.bytes() + keys_.bytes()); }

  std::size_t size() const { return references_.size(); }
  std::uint32_t primitive(std::size_t position) const { return references_[position].primitive(); }

  Box4 box_of(std::uint32_t begin, std::uint32_t count) const {
    Box4 box = empty_four_box;
    for (const Reference& reference : references_.part(begin, count)) extend(box, reference.box);
    return box;
  }

  bool split(const Part& part, int, int, Part& left, Part& right) const {
    if (part.count <= most_in_leaf) return false;
    const std::span<const std::uint64_t> keys = keys_.part(part.begin, part.count);
    const std::uint64_t different = (keys.front() ^ keys.back()) >> position_bits;
    auto left_count = part.count / 2;
    if (different != 0) {
      // The highest bit that is not the same in all: zeros before ones.
      const std::uint64_t ones = keys.back() & ~std::uint64_t{0} << (position_bits + highest_bit(different));
      left_count =
          static_cast<std::uint32_t>(std::lower_bound(keys.begin(), keys.end(), ones) - keys.begin());
    }
    left = Part{part.begin, left_count, left_count, {}, {}};
    right = Part{part.begin + left_count, part.count - left_count, part.count - left_count, {}, {}};
    return true;
  }

 private:
  static int highest_bit(std::uint64_t x) { return static_cast<int>(std::bit_width(x)) - 1; }

  void sort() {
    keys_ = Array<std::uint64_t>(size());
    memory_.hold(keys_.bytes());
    make_keys();
    sort_keys();
    const HeldMemory held(memory_, references_.bytes());
    Array<Reference> sorted(size());
    in_parallel(size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        sorted[i] = references_[keys_[i] & ((std::uint64_t{1} << position_bits) - 1)];
    });
    references_ = std::move(sorted);
  }

  void make_keys() {
    const Box4 centres = bounds_of_centres();
    constexpr float cells = 1 << code_bits / 3;
    const Vec4 extent = centres.hi - centres.lo;
    Vec4 scale{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float s = cells / extent[axis];
      if (extent[axis] > 0.0f && extent[axis] < infinite_float && s < infinite_float) scale[axis] = s;
    }
    in_parallel(size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec4 at = (centre(references_[i].box) - centres.lo) * scale;
        // The centre of an empty box is NaN, and falls into the first cell.
        const Vec4i cell =
            __builtin_convertvector(least(greatest(at, Vec4{}), Vec4{} + (cells - 1.0f)), Vec4i);
        std::uint64_t code = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
          code = code | spread_bits(static_cast<std::uint64_t>(cell[axis])) << (2 - axis);
        keys_[i] = code << position_bits | i;
      }
    });
  }

  Box4 bounds_of_centres() const {
    Box4 all = empty_four_box;
    std::mutex mutex;
    in_parallel(size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
      Box4 mine = empty_four_box;
      for (std::size_t i = begin; i < end; ++i) extend(mine, centre(references_[i].box));
      const std::lock_guard lock(mutex);
      extend(all, mine);
    });
    return all;
  }

  void sort_keys() { hwy::Sorter()(keys_.data(), keys_.size(), hwy::SortAscending()); }

  static constexpr std::size_t grain = 1 << 14;

  MemoryMeter& memory_;
  int threads_;
  Array<Reference> references_;
  Array<std::uint64_t> keys_;
};

}  // namespace

BinaryTree build_morton(BuildInput input) {
  Morton splitter(input);
  const auto size = static_cast<std::uint32_t>(splitter.size());
  return TopDown(splitter, size, input).build(Part{0, size, size, {}, {}});
}

}  // namespace raylanes
