// The state that the walk of a stream and its leaves share: the rays of an octant. The walk is compiled once for all
// leaves, and calls these by a table.
#pragma once

#include <bit>

#include "../exact/leaf_screen.hpp"
#include "one_by_one.hpp"
#include "stream_boxes.hpp"

namespace raylanes {
namespace {

inline constexpr int stream_lanes = native_lanes;
using StreamFloats = Floats<stream_lanes>;
using StreamBits = FloatBits<stream_lanes>;

// A member of a list: where the ray enters the box, its upper half, which is not later; and the ray's index.
using ListEntry = std::uint32_t;
inline constexpr std::uint32_t index_mask = 0xffffu;
inline float entry_of(ListEntry m) {
  return std::bit_cast<float>(m & ~index_mask);
}
inline std::uint32_t index_of(ListEntry m) {
  return m & index_mask;
}

// A list that waits at a node or a leaf. Lists made from it begin at `end`.
struct WaitingList {
  TreeReference reference;
  std::uint32_t begin, size, end;
};

// The work that a walk does for its leaves.
struct StreamNeeds {
  bool only_decides;                    // any order of lists will do
  bool shortens_rays = true;            // hits end rays, which then leave lists
  bool packs_rays = false;              // for triangles: rays as PackedRow,
  bool packs_lengths = false;           // with length_above() of the direction,
  bool packs_numbers = false;           // and the number of the ray in the batch
  const std::uint32_t* skip = nullptr;  // not null: what each ray skips, packed in place of lengths
  float rounding = 0.0f;                // as in stream_padding()
  float scale = 1.0f;                   // of packed rays
};

struct StreamColumns;

// A class of leaves derives from this one and says what becomes of hits. The same object serves one octant after the
// other.
template <class Counters>
class StreamOctant {
 public:
  // The functions of the derived class.
  struct Calls {
    void (*begin)(StreamOctant&);
    // The list may be read in whole registers.
    void (*visit_leaf)(StreamOctant&, TreeReference leaf, const ListEntry* list, std::uint32_t size);
    // The whole batch, if its rays are few and of one octant; else false. The memory is for them. Null: they are never.
    bool (*trace_few)(StreamOctant&, const OctantRays& memory);
    // Some of them, a bit each.
    void (*visit_few)(StreamOctant&, TreeReference leaf, std::uint64_t rays);
    // Rays that go on alone.
    void (*trace_singly)(StreamOctant&, TreeReference from, const ListEntry* list, std::uint32_t size);
    void (*store_results)(StreamOctant&);                     // the walk has ended
    void (*trace_single)(StreamOctant&, std::size_t number);  // a ray of the batch that no stream takes
    void (*prefetch_leaf)(StreamOctant&, TreeReference);      // null: blocks of corners
    void (*move)(const StreamOctant&, std::size_t number, Ray& to);  // null: rays are as the batch has them
  };
  template <class Leaves>
  static constexpr Calls calls_of = [] {
    Calls calls{};
    calls.begin = [](StreamOctant& of) { static_cast<Leaves&>(of).begin(); };
    calls.visit_leaf = [](StreamOctant& of, TreeReference leaf, const ListEntry* list, std::uint32_t size) {
      static_cast<Leaves&>(of).visit_leaf(leaf, list, size);
    };
    calls.trace_singly = [](StreamOctant& of, TreeReference from, const ListEntry* list, std::uint32_t size) {
      static_cast<Leaves&>(of).trace_singly(from, list, size);
    };
    calls.store_results = [](StreamOctant& of) { static_cast<Leaves&>(of).store_results(); };
    calls.trace_single = [](StreamOctant& of, std::size_t number) {
      static_cast<Leaves&>(of).trace_single(number);
    };
    if constexpr (requires { &Leaves::visit_few; }) {
      calls.trace_few = [](StreamOctant& of, const OctantRays& memory) {
        return static_cast<Leaves&>(of).trace_few(memory);
      };
      calls.visit_few = [](StreamOctant& of, TreeReference leaf, std::uint64_t rays) {
        static_cast<Leaves&>(of).visit_few(leaf, rays);
      };
    }
    if constexpr (requires(Leaves & leaves) { leaves.prefetch_leaf(TreeReference{}); })
      calls.prefetch_leaf = [](StreamOctant& of, TreeReference leaf) {
        static_cast<Leaves&>(of).prefetch_leaf(leaf);
      };
    if constexpr (requires(const Leaves& leaves, Ray& ray) { leaves.move(std::size_t{}, ray); })
      calls.move = [](const StreamOctant& of, std::size_t number, Ray& to) {
        static_cast<const Leaves&>(of).move(number, to);
      };
    return calls;
  }();

  template <class Batch>
  StreamOctant(const Calls& calls, const StreamNeeds& needs, const TreeView& tree, const Batch& batch)
      : calls_(calls),
        needs_(needs),
        tree_(tree),
        batch_rays_(batch.rays),
        batch_size_(batch.size),
        counters_(batch) {}

  const Counters& counters() const { return counters_; }

  // Number 6 of packed rays, the rays of the batch from `first` on.
  StreamFloats length_or_skipped(const StreamFloats (&packed)[row_floats], std::size_t first) const {
    return needs_.skip == nullptr ? length_above(vec3(packed + 3)) : skipped_from(first);
  }
  [[gnu::noinline]] StreamFloats skipped_from(std::size_t first) const {
    std::uint32_t skipped[stream_lanes];
    for (std::size_t lane = 0; lane < stream_lanes; ++lane)
      skipped[lane] = needs_.skip[first + lane < batch_size_ ? first + lane : batch_size_ - 1];
    return as<float>(StreamBits::load(skipped));
  }

  // trace(below, boxes, i, cost) for each ray of a list, from a node or a leaf on.
  template <class Trace>
  void each_single(TreeReference from, const ListEntry* list, std::uint32_t size, Trace trace) {
    TreeView below = tree_;
    below.root = from;
    Counters cost = counters();
    for (std::uint32_t k = 0; k < size; ++k) {
      const std::uint32_t i = index_of(list[k]);
      trace(below, SingleBoxes(rays_.rows[i], octant_, padding_), i, cost);
    }
  }
  // A packed ray again as a test of triangles wants it.
  template <class Test>
  TreeRay<Test, SingleBoxes> unpacked(std::uint32_t i, const SingleBoxes& boxes) const {
    const auto numbers = [&](int first) {
      const float back = 1.0f / needs_.scale, *const xyz = rays_.packed[i] + first;
      return Float3{xyz[0] * back, xyz[1] * back, xyz[2] * back};
    };
    return {LeafRay<Test>(numbers(0), numbers(3), farthest_, rays_.rows[i].tmin), boxes};
  }

  Calls calls_;
  StreamNeeds needs_;
  const TreeView& tree_;
  const Ray* batch_rays_;
  std::size_t batch_size_;
  [[no_unique_address]] Counters counters_;
  // For each octant:
  OctantRays rays_{};
  const StreamColumns* columns_ = nullptr;  // of few rays
  int octant_ = 0;
  float farthest_ = 0.0f;  // at least the distance along an axis from any origin to a corner
  float padding_ = 0.0f;   // of boxes
};

}  // namespace
}  // namespace raylanes
