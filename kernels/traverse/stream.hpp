// Many rays of one octant of directions through a tree together: each node is met by a list of rays, and gives each of
// its children a list of those that enter it (streams: Barringer, Akenine-Möller 2014; Fuetterling et al. 2015). Nodes
// are tested a register of rays against one child at a time, leaves a register against one triangle, lists of a few
// rays one ray at a time.
#pragma once

#include "single.hpp"
#include "stream_boxes.hpp"

namespace raylanes {
namespace {

inline constexpr int stream_lanes = native_lanes;
using StreamFloats = Floats<stream_lanes>;
using StreamBits = FloatBits<stream_lanes>;

// A member of a list: where the ray enters the box, its upper half, which is not later; and the ray's index.
using Member = std::uint32_t;
inline constexpr std::uint32_t index_mask = 0xffffu;
inline float entry_of(Member m) {
  return std::bit_cast<float>(m & ~index_mask);
}
inline std::uint32_t index_of(Member m) {
  return m & index_mask;
}

// A list that waits at a node or a leaf. Lists made from it begin at `end`.
struct Waiting {
  TreeReference reference;
  std::uint32_t begin, size, end;
};

// Fewer rays than this are traced one by one.
inline constexpr std::uint32_t least_stream = stream_lanes < 8 ? 2 : 4;
// Members that all waiting lists have room for together, a ray of the stream; where they do not, rays go on alone.
inline constexpr std::size_t members_per_ray = 48;

// A ray of a stream that goes on alone, as a SingleRay.
template <class Test>
struct LoneRay {
  using V = Floats<node_lanes>;
  LoneBoxes boxes;
  AxesOfRay<Test> axes;
  RayOf<Test, V, AxesOfRay<Test>> triangles;
  float tmin;

  LoneRay(const StreamRow& row, const BroadcastRay<Test, V>& ray, int octant, float padding)
      : boxes(row, octant, padding), axes(ray.axes), triangles(ray.triangles), tmin(row.tmin) {}
};

template <class Test, bool only_decides, class Counters>
class Stream {
 public:
  Stream(const TreeView& tree, const TraceBatch& batch, OctantRays& rays, Member* members,
         std::size_t most_members, int octant, float farthest)
      : tree_(tree),
        batch_(batch),
        rays_(rays),
        members_(members),
        most_members_(most_members),
        octant_(octant),
        farthest_(farthest),
        padding_(stream_padding<Test>(tree.bounds, farthest)) {}

  void trace() {
    for (std::uint32_t i = 0; i < rays_.size; ++i) members_[i] = i;
    top_ = stack_;
    *top_++ = {tree_.root, 0, rays_.size, rays_.size + stream_lanes};
    bool is_new = true;  // a list just made holds nothing that another leaf has ended
    while (top_ != stack_) {
      Waiting at = *--top_;
      if (!is_new) at.size = without_late_ones(members_ + at.begin, at.size);
      is_new = false;
      if (at.size < least_stream)
        trace_alone(at);
      else if (is_leaf(at.reference))
        visit_leaf(at);
      else
        is_new = visit_node(at);
    }
  }

 private:
  Counters counters() const { return Counters(batch_); }

  // Without a branch: half of them may stay.
  [[gnu::noinline]] std::uint32_t without_late_ones(Member* list, std::uint32_t size) const {
    std::uint32_t left = 0;
    for (std::uint32_t i = 0; i < size; ++i) {
      const Member m = list[i];
      list[left] = m;
      left += entry_of(m) <= rays_.rows[index_of(m)].tmax ? 1u : 0u;
    }
    return left;
  }

  // A list that may be read in whole registers: its last member again behind its end.
  Member* whole_registers(const Waiting& at) const {
    Member* const list = members_ + at.begin;
    for (std::uint32_t i = 0; i < stream_lanes; ++i) list[at.size + i] = list[at.size - 1];
    return list;
  }

  // True if a child waits on top.
  [[gnu::noinline, gnu::flatten]] bool visit_node(const Waiting& at) {
    const WideNode& node = tree_.nodes[at.reference];
    const std::uint32_t room = at.size + stream_lanes;
    if (at.end + std::size_t{tree_width} * room > most_members_) {
      trace_alone(at);
      return false;
    }
    counters().node();
    OctantNode planes(node, octant_, padding_);
    Member* list = whole_registers(at);
    Member* lists[tree_width];
    for (std::uint32_t child = 0; child < tree_width; ++child)
      lists[child] = members_ + at.end + child * room;
    for (std::uint32_t i = 0; i < at.size; i += stream_lanes)
      enter_children(planes, node.occupied, list + i, at.size - i, lists);
    return push_children(node, at, room, lists);
  }

  // Appends a register of rays, or the first `size`, to the lists of the children that they enter.
  void enter_children(const OctantNode& planes, std::uint32_t occupied, const Member* list,
                      std::uint32_t size, Member* (&lists)[tree_width]) const {
    const float* rows[stream_lanes];
    for (int lane = 0; lane < stream_lanes; ++lane) rows[lane] = rays_.rows[index_of(list[lane])].inverse;
    StreamFloats ray[row_floats];
    load_rows(rows, ray);
    StreamBits index = StreamBits::load(list) & StreamBits(index_mask);
    auto taking_part = FloatMask<stream_lanes>::first(size < stream_lanes ? size : stream_lanes);
    for (int child = 0; child < tree_width; ++child) {
      if ((occupied >> child & 1u) == 0) continue;
      counters().boxes(first_lanes<stream_lanes>(size));
      const auto distance = [&](const float(&plane)[3][tree_width], int axis) {
        return multiply_add<Grade::fast>(StreamFloats(plane[axis][child]), ray[axis], ray[3 + axis]);
      };
      StreamFloats entry =
          max(max(distance(planes.near, 0), distance(planes.near, 1)), max(distance(planes.near, 2), ray[6]));
      StreamFloats exit =
          min(min(distance(planes.far, 0), distance(planes.far, 1)), min(distance(planes.far, 2), ray[7]));
      StreamBits member = (as<std::uint32_t>(entry) & StreamBits(~index_mask)) | index;
      lists[child] += compress_store(lists[child], (entry <= exit) & taking_part, member);
    }
  }

  // The nearest on top, by where the first ray of each list enters; where any hit will do, the first.
  bool push_children(const WideNode& node, const Waiting& at, std::uint32_t room,
                     Member* const (&ends)[tree_width]) {
    Waiting* const base = top_;
    for (std::uint32_t children = node.occupied; children != 0;) {
      const auto child = static_cast<std::uint32_t>(std::bit_width(children) - 1);
      children ^= 1u << child;
      const std::uint32_t begin = at.end + child * room,
                          size = static_cast<std::uint32_t>(ends[child] - members_) - begin;
      if (size == 0) continue;
      Waiting* place = top_++;
      if constexpr (!only_decides)
        for (; place != base && members_[place[-1].begin] < members_[begin]; --place) *place = place[-1];
      *place = {node.child[child], begin, size, at.end + tree_width * room};
      raylanes::prefetch<Test>(tree_, node.child[child]);
    }
    return top_ != base;
  }

  [[gnu::noinline, gnu::flatten]] void visit_leaf(const Waiting& at) {
    const LeafBlock<Test::floats>& block = leaf_block<Test>(tree_, at.reference);
    const int triangles = leaf_size(at.reference);
    const Member* const list = whole_registers(at);
    counters().leaf();
    for (std::uint32_t i = 0; i < at.size; i += stream_lanes)
      test_triangles(block, triangles, at.reference, list + i, at.size - i);
  }

  // A register of rays, or the first `size`, against all triangles of a leaf.
  void test_triangles(const LeafBlock<Test::floats>& block, int triangles, TreeReference leaf,
                      const Member* list, std::uint32_t size) {
    const float* rows[stream_lanes];
    for (int lane = 0; lane < stream_lanes; ++lane) rows[lane] = rays_.packed[index_of(list[lane])].number;
    StreamFloats packed[row_floats];
    load_rows(rows, packed);
    auto prepared = unpack_rays<Test>(packed, StreamFloats(farthest_));
    LaneSegments left{.before = packed[row_floats - 1]};
    std::uint32_t active = first_lanes<stream_lanes>(size);
    for (int triangle = 0; triangle < triangles && active != 0; ++triangle) {
      const auto load = [&](int k) { return StreamFloats(block.number[k][triangle]); };
      counters().triangles(active);
      if constexpr (decides_apart<Test>) {
        auto settled =
            Test::template settle<true>(prepared, load, active, [&] { return segment(left, list); });
        if ((settled.sure | settled.open) == 0) continue;
        counters().hits(settled.sure), counters().open(settled.open);
        take_settled(settled, list, slot_of(leaf, triangle), active, left);
      } else {
        auto range = segment(left, list);
        auto h = test_triangle<Test>(prepared, load, LeafSegment<StreamFloats>{{range.tmin, range.tmax}});
        const std::uint32_t hit = bits(h.hit) & active;
        counters().hits(hit);
        if (hit != 0) take_hits(h, hit, list, block.primitive[triangle], active, left);
      }
    }
  }

  // What is left of the segments of a register of rays; gathered when a triangle asks first. In registers: a load of
  // what was just stored lane by lane waits for all stores before it.
  struct LaneSegments {
    bool known = false;
    StreamFloats tmin{0.0f}, tmax{0.0f}, before;  // before: of tests that decide apart

    void end_at(std::uint32_t lanes, StreamFloats new_before, StreamFloats behind) {
      const auto ended = FloatMask<stream_lanes>::from_bits(lanes);
      before = select(ended, new_before, before), tmax = select(ended, behind, tmax);
    }
  };
  auto segment(LaneSegments& left, const Member* list) const {
    if (!left.known) {
      left.known = true;
      const float* ends[stream_lanes];
      for (int lane = 0; lane < stream_lanes; ++lane)
        ends[lane] = rays_.rows[index_of(list[lane])].minus_scaled_origin + 1;
      StreamFloats columns[4];
      load_rows(ends, columns);
      left.tmin = columns[2], left.tmax = columns[3];
    }
    Segment<StreamFloats, only_decides> range{left.tmin, left.tmax};
    if constexpr (only_decides || !decides_apart<Test>)
      return range;
    else
      return SegmentToHit<StreamFloats>{{range.tmin, range.tmax}, left.before};
  }

  template <class Settled>
  void take_settled(const Settled& settled, const Member* list, std::uint32_t slot, std::uint32_t& active,
                    LaneSegments& left) {
    float before[stream_lanes], behind[stream_lanes];
    settled.before.store(before), settled.behind.store(behind);
    for (std::uint32_t lanes = settled.sure; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      if constexpr (only_decides)
        end_ray(index_of(list[lane]), lane, active);
      else
        keep(index_of(list[lane]), before[lane], behind[lane], slot);
    }
    if constexpr (!only_decides) left.end_at(settled.sure, settled.before, settled.behind);
    if (settled.open != 0) [[unlikely]]
      take_open(settled.open, list, slot, active, left);
  }
  [[gnu::noinline]] void take_open(std::uint32_t open, const Member* list, std::uint32_t slot,
                                   std::uint32_t& active, LaneSegments& left) {
    for (; open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      const std::uint32_t i = index_of(list[lane]);
      const Ray& ray = batch_.rays[rays_.number[i]];
      if constexpr (only_decides) {
        if (hit_apart(TreeTriangles(tree_), ray, slot)) end_ray(i, lane, active);
      } else {
        BestSlot best = best_of(i);
        compare_apart(TreeTriangles(tree_), ray, slot, best);
        keep(i, best.before, best.tmax, best.slot);
        left.end_at(1u << lane, StreamFloats(best.before), StreamFloats(best.tmax));
      }
    }
  }
  template <class TestHit>
  void take_hits(const TestHit& h, std::uint32_t hit, const Member* list, std::uint32_t primitive,
                 std::uint32_t& active, LaneSegments& left) {
    float t[stream_lanes], u[stream_lanes], v[stream_lanes];
    StreamFloats new_t = h.t();
    if constexpr (!only_decides) new_t.store(t), h.u().store(u), h.v().store(v);
    // At the end of the segment, which may be the best hit so far.
    const std::uint32_t at_end = only_decides ? 0 : bits(new_t == left.tmax);
    for (std::uint32_t lanes = hit; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const std::uint32_t i = index_of(list[lane]);
      if constexpr (only_decides) {
        end_ray(i, lane, active);
      } else {
        Hit& best = rays_.hits[i];
        if ((at_end >> lane & 1u) != 0 && !is_better(t[lane], primitive, best)) continue;
        best = {t[lane], u[lane], v[lane], primitive};
        rays_.rows[i].tmax = t[lane];
      }
    }
    if constexpr (!only_decides) left.end_at(hit, new_t, new_t);
  }

  void keep(std::uint32_t i, float before, float behind, std::uint32_t slot) {
    rays_.rows[i].tmax = behind, rays_.before(i) = before, rays_.slot[i] = slot;
  }
  BestSlot best_of(std::uint32_t i) const { return {rays_.before(i), rays_.rows[i].tmax, rays_.slot[i]}; }
  // Nothing enters a box before −infinity.
  void end_ray(std::uint32_t i) {
    rays_.rows[i].tmax = -std::numeric_limits<float>::infinity();
    batch_.occluded[rays_.number[i]] = 1;
  }
  void end_ray(std::uint32_t i, int lane, std::uint32_t& active) {
    end_ray(i);
    active &= ~(1u << lane);
  }

  [[gnu::noinline, gnu::flatten]] void trace_alone(const Waiting& at) {
    TreeView below = tree_;
    below.root = at.reference;
    Counters counters(batch_);
    for (std::uint32_t k = 0; k < at.size; ++k) {
      const std::uint32_t i = index_of(members_[at.begin + k]);
      const Ray& ray = batch_.rays[rays_.number[i]];
      LoneRay<Test> prepared(rays_.rows[i],
                             broadcast_packed<Test>(rays_.packed[i].number, Floats<node_lanes>(farthest_)),
                             octant_, padding_);
      if constexpr (only_decides) {
        AnyHit query(rays_.rows[i].tmax);
        raylanes::trace<Test>(below, ray, prepared, query, counters);
        if (query.found) end_ray(i);
      } else if constexpr (decides_apart<Test>) {
        ClosestSlot query(best_of(i));
        raylanes::trace<Test>(below, ray, prepared, query, counters);
        keep(i, query.before, query.tmax, query.slot);
      } else {
        Hit& best = rays_.hits[i];
        Closest query(rays_.rows[i].tmax, best);
        raylanes::trace<Test>(below, ray, prepared, query, counters);
        best = query.best, rays_.rows[i].tmax = query.tmax;
      }
    }
  }

  const TreeView& tree_;
  const TraceBatch& batch_;
  OctantRays& rays_;
  Member* members_;
  std::size_t most_members_;
  int octant_;
  float farthest_, padding_;
  Waiting stack_[max_stack], *top_ = stack_;
};

}  // namespace
}  // namespace raylanes
