#include <algorithm>

#include "../batch/morton_code.hpp"
#include "../batch/sort_keys.hpp"
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
  ~Morton() { let_go(); }

  std::size_t size() const { return references_.size(); }
  void let_go() {
    memory_.release(references_.bytes() + keys_.bytes());
    references_ = {}, keys_ = {};
  }

  // The box of the references of a leaf, whose primitives go to `order`. Each reference is read once, here, from where
  // it lies: its neighbours in the order of the curve lie anywhere, and are asked for ahead.
  Box4 take_leaf(std::uint32_t begin, std::uint32_t count, std::uint32_t* order) const {
    Box4 box = empty_four_box;
    for (std::size_t i = begin; i < begin + count; ++i) {
      __builtin_prefetch(&reference_of(std::min(i + ahead, keys_.size() - 1)));
      const Reference& reference = reference_of(i);
      extend(box, reference.box);
      order[i] = reference.primitive();
    }
    return box;
  }

  bool split(const Part& part, int, int, Part& left, Part& right) const {
    if (part.count <= max_in_leaf) return false;
    const std::span<const std::uint64_t> keys = keys_.part(part.begin, part.count);
    const std::uint64_t different = (keys.front() ^ keys.back()) >> position_bits;
    auto left_count = part.count / 2;
    if (different != 0) {
      // The highest bit that is not the same in all: zeros before ones.
      const std::uint64_t ones = keys.back() & ~std::uint64_t{0} << (position_bits + highest_bit(different));
      left_count = count_below(keys, ones);
    }
    left = Part{part.begin, left_count, left_count, {}, {}};
    right = Part{part.begin + left_count, part.count - left_count, part.count - left_count, {}, {}};
    return true;
  }

 private:
  // How many of sorted keys are below another. No branch: half of a search's steps would be guessed wrongly.
  static std::uint32_t count_below(std::span<const std::uint64_t> keys, std::uint64_t key) {
    const std::uint64_t* first = keys.data();
    for (std::size_t count = keys.size(); count > 0; count /= 2) {
      const std::size_t half = (count + 1) / 2;
      first += first[half - 1] < key ? half : 0;
    }
    return static_cast<std::uint32_t>(first - keys.data());
  }
  static int highest_bit(std::uint64_t x) { return static_cast<int>(std::bit_width(x)) - 1; }

  const Reference& reference_of(std::size_t position) const {
    return references_[keys_[position] & ((std::uint64_t{1} << position_bits) - 1)];
  }

  void sort() {
    keys_ = Array<std::uint64_t>(size());
    memory_.hold(keys_.bytes());
    make_keys();
    sort_by_buckets();
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

  // Sorts by the highest bits in which keys differ first. Keys with these bits in common fit into a cache; one thread
  // sorts them.
  void sort_by_buckets() {
    if (keys_.size() <= grain) return sort_keys(keys_.part(0, keys_.size()));
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < size(); ++i) different |= keys_[i] ^ keys_[0];
    const int shift = std::max(highest_bit(different) + 1 - bucket_bits, 0);
    const auto bucket_of = [&](std::uint64_t key) { return key >> shift & (buckets - 1); };
    std::vector<std::uint32_t> ends(buckets);
    for (std::size_t i = 0; i < size(); ++i) ++ends[bucket_of(keys_[i])];
    std::uint32_t end = 0;
    for (std::uint32_t& at : ends) end += std::exchange(at, end);
    Array<std::uint64_t> sorted(size());
    const HeldMemory held(memory_, sorted.bytes());
    for (std::size_t i = 0; i < size(); ++i) sorted[ends[bucket_of(keys_[i])]++] = keys_[i];
    in_parallel(buckets, buckets / 64, threads_, [&](std::size_t first, std::size_t last) {
      for (std::size_t bucket = first; bucket < last; ++bucket) {
        const std::uint32_t begin = bucket == 0 ? 0 : ends[bucket - 1];
        sort_keys(sorted.part(begin, ends[bucket] - begin));
      }
    });
    keys_ = std::move(sorted);
  }

  static constexpr std::size_t grain = 1 << 14, ahead = 16;
  static constexpr int bucket_bits = 11;
  static constexpr std::size_t buckets = std::size_t{1} << bucket_bits;

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
