
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
    std::mutex mutex;
    in_parallel(size(), grain, threads_, [&](std::size_t begin, std::size_t end) {
      std::uint64_t all = 0, common = ~std::uint64_t{0};
      for (std::size_t i = begin; i < end; ++i) {
        const Vec4 at = (centre(references_[i].box) - centres.lo) * scale;
        // The centre of an empty box is NaN, and falls into the first cell.
        const Vec4i cell =
            __builtin_convertvector(least(greatest(at, Vec4{}), Vec4{} + (cells - 1.0f)), Vec4i);
        std::uint64_t code = 0;
        for (std::size_t axis = 0; axis < 3; ++axis)
          code = code | spread_bits(static_cast<std::uint64_t>(cell[axis])) << (2 - axis);
        keys_[i] = code << position_bits | i;
        all |= keys_[i], common &= keys_[i];
      }
      const std::lock_guard lock(mutex);
      any_bits_ |= all, common_bits_ &= common;
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
  // sorts them. A small mesh has few buckets: each sort of more than some keys asks the system for a random seed.
  void sort_by_buckets() {
    if (size() <= grain) return sort_keys(keys_.part(0, size()));
    const int bits = std::min(highest_bit(size() / keys_of_bucket) + 1, max_bucket_bits);
    const std::size_t buckets = std::size_t{1} << bits;
    const int shift = std::max(highest_bit(any_bits_ ^ common_bits_) + 1 - bits, 0);
    const auto bucket_of = [&](std::uint64_t key) { return key >> shift & (buckets - 1); };
    // For each chunk of keys, and each bucket, where its next key goes.
    const std::size_t chunk = std::max(grain, (size() + max_chunks - 1) / max_chunks),
                      chunks = (size() + chunk - 1) / chunk;
    std::vector<std::uint32_t> next(chunks * buckets);
    const auto each_chunk = [&](const auto& visit) {
      in_parallel(chunks, 1, threads_, [&](std::size_t first, std::size_t last) {
        for (std::size_t c = first; c < last; ++c)
          for (std::size_t i = c * chunk; i < std::min((c + 1) * chunk, size()); ++i)
            visit(keys_[i], next[c * buckets + bucket_of(keys_[i])]++);
      });
    };
    each_chunk([](std::uint64_t, std::uint32_t) {});
    std::uint32_t end = 0;
    for (std::size_t bucket = 0; bucket < buckets; ++bucket)
      for (std::size_t c = 0; c < chunks; ++c) end += std::exchange(next[c * buckets + bucket], end);
    Array<std::uint64_t> sorted(size());
    const HeldMemory held(memory_, sorted.bytes());
    each_chunk([&](std::uint64_t key, std::uint32_t to) { sorted[to] = key; });
    const std::uint32_t* const ends = &next[(chunks - 1) * buckets];
    in_parallel(buckets, std::max(buckets / 64, std::size_t{1}), threads_,
                [&](std::size_t first, std::size_t last) {
                  for (std::size_t bucket = first; bucket < last; ++bucket) {
                    const std::uint32_t begin = bucket == 0 ? 0 : ends[bucket - 1];
                    sort_keys(sorted.part(begin, ends[bucket] - begin));
                  }
                });
    keys_ = std::move(sorted);
  }

  static constexpr std::size_t grain = 1 << 14, ahead = 16;
  static constexpr std::size_t keys_of_bucket = 1 << 12, max_chunks = 64;
  static constexpr int max_bucket_bits = 11;

  MemoryMeter& memory_;
  int threads_;
  Array<Reference> references_;
  Array<std::uint64_t> keys_;
  std::uint64_t any_bits_ = 0, common_bits_ = ~std::uint64_t{0};  // of any key, of all
};

}  // namespace

BinaryTree build_morton(BuildInput input) {
  Morton splitter(input);
  const auto size = static_cast<std::uint32_t>(splitter.size());
  return TopDown(splitter, size, input).build(Part{0, size, size, {}, {}});
}

}  // namespace raylanes
