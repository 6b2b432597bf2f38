// Packets of rays through a tree: this file makes packets of a batch and walks nodes. Each node is tested with the
// frustum around all rays of a packet, then with the frusta around its vectors. If triangles are smaller than the
// distance of rays, frusta keep little out: then boxes are tested with rays, and the last few go on as single rays.
//
//   batch, say a picture          packet: vectors of rays         frustum: planes through the apex, around the
//   +-------+-------+---+         of one major axis               rays of a packet or of one vector
//   | tile  |       |   |         +---------------------+                          ___----
//   | ----  | ----  |   |         | ray ray .. W lanes  | vector             __----  +--+  node or leaf: a box,
//   | ----  | ----  |   |  ---->  | ray ray             | vector     apex  <____     |__|  widened
//   +-------+-------+---+         | up to 32 rows       |             at 0   z->----____
//   ---- run: 1 or 4 rays         +---------------------+                               ----
//   that follow each other                                        edge planes: through the apex and an edge
//                                                                 of a triangle; rays that hit are within
//   tiles.hpp                     packet_rays.hpp                 frusta.hpp, apex_triangles.hpp, packet_leaves.hpp
//
// The apex is the origin that all rays share, bit for bit, or about their end. Rays without an apex are coherent: their
// planes go through no point. The frame of a packet has its apex at 0 and its major axis as z.
#pragma once

#include "../one_by_one.hpp"
#include "packet_rays.hpp"

namespace raylanes {
namespace {

inline constexpr int max_single_rays = 4;
// Packets that come to more leaves than this test each box with their rays, too: one packet in a hundred, which would
// take half the time.
inline constexpr int leaves_of_frusta = 10;

// A reference that waits for some vectors of rays, or for the few rays that its box is left with.
struct StackEntry {
  static constexpr bool leaves_have_corners = true;  // else leaves have a way of their own to be prefetched
  TreeReference reference;
  float near;             // where the box begins
  std::uint32_t vectors;  // a bit each
  int single_rays;
  std::uint16_t ray[max_single_rays];  // row · W + lane
};

// A class of leaves derives from this one and says what becomes of hits. The walk is compiled once for all leaves, and
// calls these by a table. One object serves one packet after the other.
template <SharedApex apex, class Counters, class Entry = StackEntry>
class PacketWalk {
  using V = Floats<W>;

 public:
  // The functions of the derived class.
  struct Calls {
    void (*begin)(PacketWalk&);  // all vectors are there, not yet their ranges
    void (*visit_leaf)(PacketWalk&, const Entry&);
    void (*trace_rays)(PacketWalk&, const Entry&);      // its single rays, below it
    void (*store_results)(PacketWalk&);                 // the walk has ended
    void (*trace_single)(PacketWalk&, std::size_t);     // a ray of the batch that no packet takes
    void (*prefetch_leaf)(PacketWalk&, TreeReference);  // if leaves have no corners
  };
  template <class Leaves>
  static constexpr Calls calls_of = {
      [](PacketWalk& of) { static_cast<Leaves&>(of).begin(); },
      [](PacketWalk& of, const Entry& at) { static_cast<Leaves&>(of).visit_leaf(at); },
      [](PacketWalk& of, const Entry& at) { static_cast<Leaves&>(of).trace_rays(at); },
      [](PacketWalk& of) { static_cast<Leaves&>(of).store_results(); },
      [](PacketWalk& of, std::size_t index) { static_cast<Leaves&>(of).trace_single(index); },
      [](PacketWalk& of, TreeReference leaf) { static_cast<Leaves&>(of).prefetch_leaf(leaf); }};

  // of: the apex of the batch. rays_left: in the batch and behind it. hits: what leaves write to, null if nothing is to
  // be prefetched. rounding: as in PacketFrame.
  template <class Batch>
  PacketWalk(const Calls& calls, const TreeView& tree, const Batch& batch, RaysOf<apex>& rays,
             const ApexOfRays<apex>& of, std::size_t rays_left, const Hit* hits, float rounding)
      : tree_(tree),
        batch_rays_(batch.rays),
        batch_size_(batch.size),
        batch_hits_(hits),
        rays_left_(rays_left),
        rounding_(rounding),
        counters_(batch),
        rays_(rays),
        of_(of),
        calls_(calls) {}

  [[gnu::noinline]] void trace(TileOrder::Memory& memory) {
    const TileOrder order(memory, batch_rays_, batch_size_, of_);
    const RayRuns runs = rays_.runs = order.runs();
    const std::uint32_t per_packet = max_vectors * runs.per_vector();
    for (std::uint32_t i = 0; i < runs.size; i += per_packet)
      trace_packets(runs.first + i, runs.size - i < per_packet ? runs.size - i : per_packet);
    for (std::size_t i = order.rays_in_runs(); i < batch_size_; ++i) calls_.trace_single(*this, i);
  }
  void prefetch_leaf(TreeReference) {}

 protected:
  const Counters& counters() const { return counters_; }
  const Ray& ray_of(int row, int lane) const { return batch_rays_[rays_.index(row, lane)]; }
  // Calls test(triangle, row) for some triangles of a leaf and the vectors that may meet one. Returns the vectors for
  // which it is true.
  template <class Shapes, class Test>
  std::uint32_t each_met(const Shapes& shapes, std::uint32_t some, std::uint32_t vectors, Test test) const {
    std::uint32_t hit = 0;
    for (std::uint32_t triangles = met_by_any(shapes, vectors) & some; triangles != 0;
         triangles &= triangles - 1) {
      const int triangle = std::countr_zero(triangles);
      for (std::uint32_t met = vectors_met(shapes, triangle, vectors); met != 0; met &= met - 1) {
        const int row = std::countr_zero(met);
        counters().triangles(rays_.active[row]);
        hit |= std::uint32_t{test(triangle, row)} << row;
      }
    }
    return hit;
  }
  // Calls trace(below, row, lane) for the single rays of an entry that are still active.
  template <class Trace>
  void each_single(const Entry& at, Trace trace) {
    TreeView below = tree_;
    below.root = at.reference;
    for (int i = 0; i < at.single_rays; ++i) {
      const int row = at.ray[i] / W, lane = at.ray[i] % W;
      if ((rays_.active[row] >> lane & 1u) == 0) continue;
      trace(below, row, lane);
      rays_.refresh(row);
    }
    all_.far = rays_.farthest();
  }
  // After hits of the rays of vectors.
  void refresh(std::uint32_t vectors) {
    if (vectors == 0) return;
    for (; vectors != 0; vectors &= vectors - 1) rays_.refresh(std::countr_zero(vectors));
    all_.far = rays_.farthest();
  }

  const TreeView& tree_;
  PacketFrame frame_;  // of each packet
  float reach_ = 0.0f;

 private:
  static constexpr int max_single = 12;  // so few rays are no packet

  // Rays that follow each other: a packet for each of their major axes.
  void trace_packets(const std::uint32_t* first, std::uint32_t count) {
    const std::uint32_t per_vector = rays_.runs.per_vector(), vectors = (count + per_vector - 1) / per_vector;
    std::uint32_t left[max_vectors];
    for (std::uint32_t i = 0; i < vectors; ++i) left[i] = rays_.runs.lanes(count - i * per_vector);
    for (std::uint32_t i = 0; i < vectors;) {
      if (left[i] == 0) {
        ++i;
        continue;
      }
      const std::uint32_t* const run = first + i * per_vector;
      if (are_few(left + i, vectors - i)) {
        trace_singly(run, left[i]);
        left[i] = 0;
        continue;
      }
      const int lane = std::countr_zero(left[i]);
      const std::size_t index = rays_.runs.index(run, lane);
      trace_packet(major_axis_of<apex>(batch_rays_[index].direction), first, left, vectors);
      if ((left[i] >> lane & 1u) == 0) continue;
      calls_.trace_single(*this, index);  // of no major axis
      left[i] &= ~(1u << lane);
    }
  }
  static bool are_few(const std::uint32_t* left, std::uint32_t vectors) {
    int count = 0;
    for (std::uint32_t i = 0; i < vectors; ++i)
      for (std::uint32_t lanes = left[i]; lanes != 0; lanes &= lanes - 1)
        if (++count > max_single) return false;
    return true;
  }
  // Rays of the major axis that no packet can have are traced singly; rays of other axes are left.
  void trace_packet(MajorAxis major, const std::uint32_t* first, std::uint32_t* left, std::uint32_t vectors) {
    frame_ = PacketFrame(of_.at, major, of_.reach, rounding_);
    frame_.padding += tree_.origin_share * largest_of(of_.at) + tree_.padding;
    V apex_offset(0.0f);
    if constexpr (apex == SharedApex::none)
      frame_.begin_at(first_begin(first, left, vectors), tree_.bounds, of_.reach);
    rays_.vectors = 0;
    for (std::uint32_t i = 0; i < vectors; ++i)
      if (left[i] != 0)
        apex_offset = max(add_vector(first + i * rays_.runs.per_vector(), left[i]), apex_offset);
    if (rays_.vectors == 0) return;
    calls_.begin(*this);
    rays_.bound_vectors();
    // For a coherent packet also the point where its first ray begins, which no packet may have.
    if constexpr (apex == SharedApex::none)
      apex_offset = max(abs(V(frame_.apex[2] - of_.at[frame_.axes.order[2]])), apex_offset);
    const float farthest = apex == SharedApex::origin ? 0.0f : largest_lane(apex_offset);
    if constexpr (apex == SharedApex::end) frame_.widen(farthest, of_.reach);
    if constexpr (apex == SharedApex::none) frame_.include_origins(farthest, of_.reach);
    reach_ = apex == SharedApex::none ? of_.reach + farthest : of_.reach;
    all_ = rays_.frustum();
    walk();
    calls_.store_results(*this);
  }
  // For the rays of a coherent packet: the first z along theirs.
  float first_begin(const std::uint32_t* run, const std::uint32_t* left, std::uint32_t vectors) const {
    Floats<1> first(std::numeric_limits<float>::infinity());
    const auto& order = frame_.axes.order;
    for (std::uint32_t i = 0; i < vectors; ++i, run += rays_.runs.per_vector())
      for (std::uint32_t lanes = left[i]; lanes != 0; lanes &= lanes - 1) {
        const Ray& ray = batch_rays_[rays_.runs.index(run, std::countr_zero(lanes))];
        const float z = ray.origin[order[2]], along = ray.direction[order[2]] * frame_.sign;
        if (along < __builtin_fabsf(ray.direction[order[0]])) continue;
        if (along < __builtin_fabsf(ray.direction[order[1]])) continue;
        // Rays farther away are in no coherent packet.
        if (__builtin_fabsf(z - of_.at[order[2]]) <= of_.reach * 0x1p10f)
          first = min(Floats<1>(z * frame_.sign), first);
      }
    return first.raw * frame_.sign;
  }
  // Returns how far the rays miss the apex. One function: a call between loading and taking rays costs 25 cycles a ray
  // in row order.
  [[gnu::noinline, gnu::flatten]] V add_vector(const std::uint32_t* first, std::uint32_t& left) {
    const RayColumns columns = rays_.runs.columns(batch_rays_, first);
    const RaysFromApex<apex> from_apex(columns, frame_, of_);
    prefetch_rays(first);
    const std::uint32_t lanes = from_apex.fit & left, single = left & ~(from_apex.fit | from_apex.other_axes);
    left &= from_apex.other_axes;
    if (single != 0) [[unlikely]]
      trace_singly(first, single);
    if (lanes == 0) return V(0.0f);
    if constexpr (apex == SharedApex::none)
      rays_.add(first, lanes, columns, from_apex, frame_);
    else
      rays_.add(first, lanes, columns, from_apex);
    return select(FloatMask<W>::from_bits(lanes), from_apex.apex_offset, V(0.0f));
  }
  // The places of results, the rays of a vector to come, and the rays of the next part.
  void prefetch_rays(const std::uint32_t* first) const {
    const RayRuns& runs = rays_.runs;
    for (std::uint32_t i = 0; i < runs.per_vector(); ++i) {
      // In the second level of caches already.
      const Ray* soon = batch_rays_ + first[i + vectors_ahead * runs.per_vector()];
      __builtin_prefetch(soon);
      if (runs.of_four) __builtin_prefetch(soon + 2);
      const std::size_t index = first[i], next = index + max_sorted_rays;
      if (batch_hits_ != nullptr) __builtin_prefetch(batch_hits_ + index, 1);
      if (next >= rays_left_) continue;
      __builtin_prefetch(batch_rays_ + next, 0, 2);
      if (runs.of_four) __builtin_prefetch(batch_rays_ + next + 2, 0, 2);
    }
  }
  [[gnu::noinline]] void trace_singly(const std::uint32_t* run, std::uint32_t lanes) {
    for (; lanes != 0; lanes &= lanes - 1)
      calls_.trace_single(*this, rays_.runs.index(run, std::countr_zero(lanes)));
  }

  void walk() {
    leaves_ = 0, top_ = stack_;
    Entry root;
    static_cast<StackEntry&>(root) = {tree_.root, 0.0f, ~0u, 0, {}};
    *top_++ = root;
    while (top_ != stack_) {
      Entry at = *--top_;
      if (at.near > all_.far) continue;
      if (at.single_rays != 0) {
        calls_.trace_rays(*this, at);
        continue;
      }
      at.vectors = active_vectors(at.vectors, at.near);
      if (at.vectors == 0) continue;
      if (refers_to_leaf(at.reference))
        ++leaves_, calls_.visit_leaf(*this, at);
      else
        visit_node(at);
    }
  }
  // The vectors among them that still go as far as that.
  std::uint32_t active_vectors(std::uint32_t vectors, float near) const {
    std::uint32_t active = 0;
    for (int row = 0; row < rays_.vectors; row += W)
      active |= bits(V::load(rays_.far + row) >= V(near)) << row;
    return vectors & active;
  }
  [[gnu::noinline, gnu::flatten]] void visit_node(const Entry& at) {
    const WideNode& node = tree_.nodes[at.reference];
    const FrameBoxes boxes(node, frame_);
    counters().node(), counters().frusta(node.occupied, tree_width / node_lanes);
    Entry* const base = top_;
    for (std::uint32_t children = met_by_any(boxes, at.vectors) & node.occupied; children != 0;
         children &= children - 1) {
      const int child = std::countr_zero(children);
      const TreeReference reference = node.child[child];
      Entry entering;
      static_cast<StackEntry&>(entering) = {
          reference, boxes.near[child], vectors_met(boxes, child, at.vectors), 0, {}};
      if (entering.vectors != 0 && leaves_ > leaves_of_frusta) drop_vectors(boxes, child, entering);
      if (entering.vectors == 0) continue;
      if constexpr (requires { entering.box; }) entering.box = boxes.box(child);
      Entry* place = top_++;
      for (; place != base && place[-1].near < entering.near; --place) *place = place[-1];
      *place = entering;
      if (!Entry::leaves_have_corners && refers_to_leaf(reference))
        calls_.prefetch_leaf(*this, reference);
      else
        prefetch<OfCorners>(tree_, reference);
    }
  }
  // Drops vectors without a ray in the box.
  [[gnu::noinline, gnu::flatten]] void drop_vectors(const FrameBoxes& boxes, int child,
                                                    Entry& entering) const {
    const auto box = broadcast<V>(boxes.box(child));
    int count = 0;
    for (std::uint32_t vectors = entering.vectors; vectors != 0; vectors &= vectors - 1) {
      const int row = std::countr_zero(vectors);
      counters().boxes(rays_.active[row]);
      std::uint32_t rays = bits(may_meet(box, rays_.ray_frusta(row))) & rays_.active[row];
      if (rays == 0) entering.vectors &= ~(1u << row);
      for (; rays != 0 && count <= max_single_rays; rays &= rays - 1, ++count)
        if (count < max_single_rays)
          entering.ray[count] = static_cast<std::uint16_t>(row * W + std::countr_zero(rays));
    }
    entering.single_rays = count <= max_single_rays ? count : 0;
  }
  // The boxes or triangles that some vectors may meet. One vector is tested by its own frustum, and that is all.
  static bool is_one(std::uint32_t vectors) {
    return apex != SharedApex::none && (vectors & (vectors - 1)) == 0;
  }
  template <class Shapes>
  std::uint32_t met_by_any(const Shapes& shapes, std::uint32_t vectors) const {
    if constexpr (apex != SharedApex::none)
      return shapes.met_by(is_one(vectors) ? rays_.frustum(std::countr_zero(vectors)) : all_);
    else
      return shapes.met_by(all_);
  }
  template <class Shapes>
  std::uint32_t vectors_met(const Shapes& shapes, int i, std::uint32_t vectors) const {
    if (is_one(vectors)) return vectors;
    counters().frusta(vectors, (rays_.vectors + W - 1) / W);
    return vectors & shapes.vectors_met(i, rays_);
  }

  const Ray* batch_rays_;
  std::size_t batch_size_;
  const Hit* batch_hits_;
  std::size_t rays_left_;
  float rounding_;
  [[no_unique_address]] Counters counters_;
  RaysOf<apex>& rays_;
  ApexOfRays<apex> of_;
  decltype(std::declval<RaysOf<apex>>().frustum()) all_{};  // around all rays
  int leaves_ = 0;
  Entry* top_ = nullptr;
  Calls calls_;
  Entry stack_[max_stack];
};

}  // namespace
}  // namespace raylanes
