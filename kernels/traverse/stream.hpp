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

  // What is left of the segments of a register of rays. In registers: a load of what was just stored lane by lane
  // waits for all stores before it.
  struct LaneSegments {
    StreamFloats tmin, tmax, before;  // before: of tests that decide apart

    void end_at(std::uint32_t lanes, StreamFloats new_before, StreamFloats behind) {
      const auto ended = FloatMask<stream_lanes>::from_bits(lanes);
      before = select(ended, new_before, before), tmax = select(ended, behind, tmax);
    }
    auto segment() const {
      if constexpr (only_decides)
        return Segment<StreamFloats, true>{tmin, tmax};
      else
        return SegmentToHit<StreamFloats>{{tmin, tmax}, before};
    }
  };

  // A register of rays, or the first `size`, against all triangles of a leaf.
  void test_triangles(const LeafBlock<Test::floats>& block, int triangles, TreeReference leaf,
                      const Member* list, std::uint32_t size) {
    const float *rows[stream_lanes], *ends[stream_lanes];
    for (int lane = 0; lane < stream_lanes; ++lane) {
      const std::uint32_t i = index_of(list[lane]);
      rows[lane] = rays_.packed[i].number, ends[lane] = rays_.rows[i].minus_scaled_origin + 1;
    }
    StreamFloats packed[row_floats], columns[4];
    load_rows(rows, packed), load_rows(ends, columns);
    const auto prepared = unpack_rays<Test>(packed, StreamFloats(farthest_));
    LaneSegments left{columns[2], columns[3], packed[row_floats - 1]};
    std::uint32_t active = first_lanes<stream_lanes>(size);
    if constexpr (decides_apart<Test>)
      settle_triangles(prepared, block, triangles, leaf, list, active, left);
    else if constexpr (only_decides)
      find_any(prepared, block, triangles, list, active, left);
    else
      find_nearest(prepared, block, triangles, list, active, left);
  }
  // Without a branch on what is hit: one in three of these registers has a ray that is, and nothing foretells which.
  template <class Rays>
  void settle_triangles(const Rays& rays, const LeafBlock<Test::floats>& block, int triangles,
                        TreeReference leaf, const Member* list, std::uint32_t active, LaneSegments& left) {
    auto going = FloatMask<stream_lanes>::from_bits(active), found = going & ~going;
    StreamFloats slots(0.0f);
    for (int triangle = 0; triangle < triangles; ++triangle) {
      const auto load = [&](int k) { return StreamFloats(block.number[k][triangle]); };
      counters().triangles(bits(going));
      const auto settled = Test::settle_straight(rays, load, left.segment());
      const auto sure = settled.sure & going, open = settled.open & going;
      counters().hits(bits(sure)), counters().open(bits(open));
      found = found | sure;
      if constexpr (only_decides) {
        going = going & ~sure;
      } else {
        left.before = select(sure, settled.before, left.before);
        left.tmax = select(sure, settled.behind, left.tmax);
        slots = select(sure, as<float>(FloatBits<stream_lanes>(slot_of(leaf, triangle))), slots);
      }
      if (any(open)) [[unlikely]] {
        store_settled(bits(found), left, slots, list);
        found = found & ~found;
        going = going & ~FloatMask<stream_lanes>::from_bits(
                            take_open(bits(open), list, slot_of(leaf, triangle), left));
      }
      if (only_decides && !any(going)) break;
    }
    store_settled(bits(found), left, slots, list);
  }
  void store_settled(std::uint32_t found, const LaneSegments& left, StreamFloats slots, const Member* list) {
    if (found == 0) return;
    float before[stream_lanes], behind[stream_lanes];
    std::uint32_t slot[stream_lanes];
    if constexpr (!only_decides)
      left.before.store(before), left.tmax.store(behind), as<std::uint32_t>(slots).store(slot);
    for (; found != 0; found &= found - 1) {
      const int lane = std::countr_zero(found);
      if constexpr (only_decides)
        end_ray(index_of(list[lane]));
      else
        keep(index_of(list[lane]), before[lane], behind[lane], slot[lane]);
    }
  }
  // Returns the rays that end.
  [[gnu::noinline]] std::uint32_t take_open(std::uint32_t open, const Member* list, std::uint32_t slot,
                                            LaneSegments& left) {
    std::uint32_t ended = 0;
    for (; open != 0; open &= open - 1) {
      const int lane = std::countr_zero(open);
      const std::uint32_t i = index_of(list[lane]);
      const Ray& ray = batch_.rays[rays_.number[i]];
      if constexpr (only_decides) {
        if (!hit_apart(TreeTriangles(tree_), ray, slot)) continue;
        end_ray(i);
        ended |= 1u << lane;
      } else {
        BestSlot best = best_of(i);
        compare_apart(TreeTriangles(tree_), ray, slot, best);
        keep(i, best.before, best.tmax, best.slot);
        left.end_at(1u << lane, StreamFloats(best.before), StreamFloats(best.tmax));
      }
    }
    return ended;
  }
  template <class Rays>
  auto test_lanes(const Rays& rays, const LeafBlock<Test::floats>& block, int triangle,
                  const LaneSegments& left) const {
    const auto load = [&](int k) { return StreamFloats(block.number[k][triangle]); };
    return test_triangle<Test>(rays, load, Segment<StreamFloats>{left.tmin, left.tmax});
  }
  template <class Rays>
  void find_any(const Rays& rays, const LeafBlock<Test::floats>& block, int triangles, const Member* list,
                std::uint32_t active, const LaneSegments& left) {
    std::uint32_t hit = 0;
    for (int triangle = 0; triangle < triangles && (active & ~hit) != 0; ++triangle) {
      counters().triangles(active & ~hit);
      const std::uint32_t more = bits(test_lanes(rays, block, triangle, left).hit) & active & ~hit;
      counters().hits(more);
      hit |= more;
    }
    for (; hit != 0; hit &= hit - 1) end_ray(index_of(list[std::countr_zero(hit)]));
  }
  // Without a branch on what is hit: one in three of these registers has a ray that is, and nothing foretells which.
  template <class Rays>
  void find_nearest(const Rays& rays, const LeafBlock<Test::floats>& block, int triangles, const Member* list,
                    std::uint32_t active, LaneSegments& left) {
    const auto taking_part = FloatMask<stream_lanes>::from_bits(active);
    decltype(test_lanes(rays, block, 0, left)) best{};
    StreamFloats primitive(0.0f);
    for (int triangle = 0; triangle < triangles; ++triangle) {
      counters().triangles(active);
      const auto h = test_lanes(rays, block, triangle, left);
      const StreamFloats t = h.t();
      auto nearer = h.hit & taking_part;
      const auto at_end = nearer & (t == left.tmax);
      if (any(at_end)) [[unlikely]]
        nearer = nearer & ~not_better(at_end, t, block.primitive[triangle], list, best.hit, primitive);
      counters().hits(bits(nearer));
      best.take(nearer, h);
      left.tmax = select(nearer, t, left.tmax);
      primitive = select(nearer, as<float>(FloatBits<stream_lanes>(block.primitive[triangle])), primitive);
    }
    if (any(best.hit)) store_hits(best, left.tmax, primitive, list);
  }
  // Of lanes that hit at the end of their segment, which may be the best hit so far, those where that stays.
  [[gnu::noinline]] FloatMask<stream_lanes> not_better(FloatMask<stream_lanes> lanes, StreamFloats t,
                                                       std::uint32_t primitive, const Member* list,
                                                       FloatMask<stream_lanes> found,
                                                       StreamFloats best_primitive) const {
    float ts[stream_lanes];
    std::uint32_t primitives[stream_lanes], stays = 0;
    t.store(ts), as<std::uint32_t>(best_primitive).store(primitives);
    for (std::uint32_t left = bits(lanes); left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      Hit best = rays_.hits[index_of(list[lane])];
      if ((bits(found) >> lane & 1u) != 0) best.t = ts[lane], best.primitive = primitives[lane];
      if (!is_better(ts[lane], primitive, best)) stays |= 1u << lane;
    }
    return FloatMask<stream_lanes>::from_bits(stays);
  }
  template <class TestHit>
  void store_hits(const TestHit& best, StreamFloats new_t, StreamFloats new_primitive, const Member* list) {
    float t[stream_lanes], u[stream_lanes], v[stream_lanes];
    std::uint32_t primitive[stream_lanes];
    new_t.store(t), best.u().store(u), best.v().store(v), as<std::uint32_t>(new_primitive).store(primitive);
    for (std::uint32_t lanes = bits(best.hit); lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const std::uint32_t i = index_of(list[lane]);
      rays_.hits[i] = {t[lane], u[lane], v[lane], primitive[lane]};
      rays_.rows[i].tmax = t[lane];
    }
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
