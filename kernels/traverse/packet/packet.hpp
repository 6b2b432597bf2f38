// A packet through a tree: each node, leaf and triangle is asked first for the frustum around all rays, then for
// those of the groups, a register of groups at a time, and only what is left for rays. Where triangles are smaller
// than the distance of rays, frusta keep little out: then boxes are asked for rays, and the last few go on alone.
#pragma once

#include "../../exact/leaf_filter.hpp"
#include "culls.hpp"
#include "prepared.hpp"

namespace raylanes {
namespace {

// Packets that come to more leaves than this ask each box for their rays, too: one packet in a hundred, which would
// take half the time.
inline constexpr int leaves_of_frusta = 10;
// So many rays or fewer go on alone.
inline constexpr int most_lone_rays = 4;

// What waits: for some groups, or for a few rays that a box is left with.
struct WaitingGroups {
  TreeReference reference;
  float near;  // where the box begins
  std::uint32_t groups;
  int lone_rays;
  std::uint16_t ray[most_lone_rays];  // group · lanes + lane
};

template <class Test, SharedApex apex, bool only_decides, class Counters>
class Packet {
  using Rays = PacketRays<Test, apex>;
  static constexpr bool filters_undecided = is_filtered<Test> && only_decides && apex == SharedApex::end;
  // What leaves are asked by: cones need a point.
  using Triangles = std::conditional_t<apex == SharedApex::none, FrameBoxes, EdgePlanes<Test>>;

 public:
  Packet(const TreeView& tree, const TraceBatch& batch, const PacketFrame& frame, float reach, Rays& rays)
      : tree_(tree), batch_(batch), frame_(frame), reach_(reach), rays_(rays), all_(rays.frustum()) {}

  void trace() {
    top_ = stack_;
    *top_++ = {tree_.root, 0.0f, groups_going(~0u, 0.0f), 0, {}};
    while (top_ != stack_) {
      WaitingGroups at = *--top_;
      if (at.near > all_.far) continue;
      if (at.lone_rays != 0) {
        trace_alone(at);
        continue;
      }
      at.groups = groups_going(at.groups, at.near);
      if (at.groups == 0) continue;
      if (is_leaf(at.reference))
        visit_leaf(at);
      else
        visit_node(at);
    }
  }

 private:
  Counters counters() const { return Counters(batch_); }

  // Of some groups those that still go as far as that.
  std::uint32_t groups_going(std::uint32_t groups, float near) const {
    std::uint32_t going = 0;
    for (int g = 0; g < rays_.groups; g += group_lanes)
      going |= bits(GroupFloats::load(rays_.far + g) >= GroupFloats(near)) << g;
    return groups & going;
  }

  // The boxes or triangles that some of the groups may meet: of one group alone by its own frustum, and then that is
  // all to ask.
  static bool is_one(std::uint32_t groups) {
    return apex != SharedApex::none && (groups & (groups - 1)) == 0;
  }
  template <class Shapes>
  std::uint32_t met_by_any(const Shapes& shapes, std::uint32_t groups) const {
    if constexpr (apex != SharedApex::none)
      return shapes.met_by(is_one(groups) ? rays_.frustum(std::countr_zero(groups)) : all_);
    else
      return shapes.met_by(all_);
  }
  template <class Shapes>
  std::uint32_t groups_met(const Shapes& shapes, int i, std::uint32_t groups) const {
    if (is_one(groups)) return groups;
    counters().frusta(groups, group_registers());
    return groups & shapes.groups_met(i, rays_);
  }
  int group_registers() const { return (rays_.groups + group_lanes - 1) / group_lanes; }
  [[gnu::noinline, gnu::flatten]] void visit_node(const WaitingGroups& at) {
    const WideNode& node = tree_.nodes[at.reference];
    const FrameBoxes boxes(node, frame_);
    counters().node(), counters().frusta(node.occupied, tree_width / node_lanes);
    WaitingGroups* const base = top_;
    for (std::uint32_t children = met_by_any(boxes, at.groups) & node.occupied; children != 0;
         children &= children - 1) {
      const int child = std::countr_zero(children);
      WaitingGroups entering{
          node.child[child], boxes.near[child], groups_met(boxes, child, at.groups), 0, {}};
      if (entering.groups != 0 && leaves_ > leaves_of_frusta) ask_rays(boxes.box(child), entering);
      if (entering.groups == 0) continue;
      WaitingGroups* place = top_++;
      for (; place != base && place[-1].near < entering.near; --place) *place = place[-1];
      *place = entering;
      raylanes::prefetch<Test>(tree_, node.child[child]);
    }
  }
  // Drops groups without a ray in the box.
  [[gnu::noinline, gnu::flatten]] void ask_rays(const FrameBox<GroupFloats>& box,
                                                WaitingGroups& entering) const {
    int count = 0;
    for (std::uint32_t groups = entering.groups; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      counters().boxes(rays_.going[g]);
      std::uint32_t rays = bits(may_meet(box, rays_.lines(g))) & rays_.going[g];
      if (rays == 0) entering.groups &= ~(1u << g);
      for (; rays != 0 && count <= most_lone_rays; rays &= rays - 1, ++count)
        if (count < most_lone_rays)
          entering.ray[count] = static_cast<std::uint16_t>(g * group_lanes + std::countr_zero(rays));
    }
    entering.lone_rays = count <= most_lone_rays ? count : 0;
  }
  [[gnu::noinline, gnu::flatten]] void visit_leaf(const WaitingGroups& at) {
    ++leaves_;
    const LeafBlock<Test::floats>& block = leaf_block<Test>(tree_, at.reference);
    const Triangles triangles_of_leaf(block, frame_);
    counters().leaf();
    counters().frusta(first_lanes<tree_width>(leaf_size(at.reference)), tree_width / node_lanes);
    std::uint32_t hit = 0;
    for (std::uint32_t triangles =
             met_by_any(triangles_of_leaf, at.groups) & first_lanes<tree_width>(leaf_size(at.reference));
         triangles != 0; triangles &= triangles - 1) {
      const int triangle = std::countr_zero(triangles);
      for (std::uint32_t met = groups_met(triangles_of_leaf, triangle, at.groups); met != 0; met &= met - 1) {
        const int g = std::countr_zero(met);
        counters().triangles(rays_.going[g]);
        hit |= std::uint32_t{test_group(triangles_of_leaf, block, at.reference, triangle, g)} << g;
      }
    }
    if constexpr (filters_undecided)
      if (with_undecided_ != 0) hit |= filter_undecided(block, at.reference);
    if (hit == 0) return;
    for (; hit != 0; hit &= hit - 1) rays_.refresh(std::countr_zero(hit));
    all_.far = rays_.farthest();
  }

  // A group and one triangle; whether segments have changed. Where the planes of a triangle and its t leave nothing
  // undecided no test is needed; only the test itself gives the numbers of a hit.
  bool test_group(const Triangles& triangles, const LeafBlock<Test::floats>& block, TreeReference leaf,
                  int triangle, int g) {
    constexpr bool is_closest_hit = !only_decides && !is_filtered<Test>;
    if constexpr (apex != SharedApex::none && may_take_planes<Test>)
      return test_planes(triangles, block, leaf, triangle, g);
    else if constexpr (apex == SharedApex::none || is_closest_hit)
      return test_triangle(block, leaf, triangle, g, rays_.going[g]);
    else
      return test_edge_planes(triangles, block, leaf, triangle, g);
  }
  bool test_planes(const EdgePlanes<Test>& planes, const LeafBlock<Test::floats>& block, TreeReference leaf,
                   int triangle, int g) {
    using V = GroupFloats;
    std::uint32_t rays = rays_.going[g];
    if ((planes.plain >> triangle & 1u) == 0) [[unlikely]]
      return test_out_of_line(block, leaf, triangle, g, rays);
    auto range = segment(g);
    if constexpr (apex == SharedApex::end) {
      V slack = V::load(rays_.slack[g]);
      range.tmin = range.tmin + slack, range.tmax = range.tmax - slack;
    }
    const auto h = planes.hit(triangle, V::load(rays_.slope_x[g]), V::load(rays_.slope_y[g]),
                              V::load(rays_.size_z[g]), range);
    rays &= bits(h.hit);
    counters().hits(rays);
    // Without a branch on whether there are any: that would be foretold wrongly half the time.
    if constexpr (only_decides)
      rays_.going[g] &= ~rays;
    else
      rays_.keep_nearer(g, h, rays, block.primitive[triangle]);
    return rays != 0;
  }
  bool test_edge_planes(const EdgePlanes<Test>& planes, const LeafBlock<Test::floats>& block,
                        TreeReference leaf, int triangle, int g) {
    using V = GroupFloats;
    V x = V::load(rays_.slope_x[g]), y = V::load(rays_.slope_y[g]);
    V side = planes.side(triangle, x, y), bound(planes.minus_bound[triangle]);
    std::uint32_t rays = bits(side >= bound) & rays_.going[g];
    if ((planes.plain >> triangle & 1u) == 0) [[unlikely]]
      return rays != 0 && leave_undecided(block, leaf, triangle, g, rays);
    V scale = planes.scale(triangle, x, y, V::load(rays_.size_z[g]));
    V least(planes.least_volume[triangle]), largest(planes.largest_volume[triangle]);
    const auto range = segment(g);
    auto inside = side > -bound;
    MaskOf<V> beside, certain;
    FilterResult<V> filtered{0, 0, least, largest};
    if constexpr (only_decides) {
      // Of ends times the scale: without a division.
      V near = range.tmin, far = range.tmax;
      beside = (least > far * scale) | (largest < near * scale);
      if constexpr (apex == SharedApex::end) {
        V slack = V::load(rays_.slack[g]);
        near = near + (slack + slack), far = far - (slack + slack);
      }
      certain = (least > near * scale) & (largest < far * scale);
    } else {
      V inverse = planes.fast_reciprocal(scale);
      filtered.t_lo = least * inverse, filtered.t_hi = largest * inverse;
      beside = (filtered.t_lo > range.tmax) | (filtered.t_hi < range.tmin);
      certain = (filtered.t_lo > range.tmin) & (filtered.t_hi < range.accept_below());
    }
    filtered.certain = bits(inside & certain) & rays;
    counters().hits(filtered.certain);
    take_certain(filtered, g, leaf_triangle_of(leaf, triangle));
    rays &= ~bits(inside & (certain | beside));
    const bool changed = filtered.certain != 0;
    return rays != 0 ? changed | leave_undecided(block, leaf, triangle, g, rays) : changed;
  }
  // What the planes do not tell; whether segments have changed.
  bool leave_undecided(const LeafBlock<Test::floats>& block, TreeReference leaf, int triangle, int g,
                       std::uint32_t rays) {
    if constexpr (!filters_undecided) return test_out_of_line(block, leaf, triangle, g, rays);
    keep_undecided(g, triangle);
    return false;
  }
  void keep_undecided(int g, int triangle) {
    undecided_[g] =
        static_cast<std::uint8_t>((with_undecided_ >> g & 1u ? undecided_[g] : 0u) | 1u << triangle);
    with_undecided_ |= 1u << g;
  }
  // What planes leave undecided is mostly the triangle where a ray begins: tested by the filter of leaves from the
  // rays' own origins. Returns the groups with hits.
  [[gnu::noinline, gnu::flatten]] std::uint32_t filter_undecided(const LeafBlock<Test::floats>& block,
                                                                 TreeReference leaf) {
    constexpr float farthest = 0x1p60f;
    const bool is_unusual = filter_scale<Test>(tree_.bounds) != 1.0f;
    const LeafFilter filter(block, leaf_size(leaf), farthest, 1.0f);
    std::uint32_t hit = 0;
    for (; with_undecided_ != 0; with_undecided_ &= with_undecided_ - 1) {
      const int g = std::countr_zero(with_undecided_);
      const RayColumns rays = rays_.units.columns(batch_.rays, rays_.unit[g]);
      const std::uint32_t far = is_unusual ? ~0u : ~bits(rays.reach(tree_.bounds) <= GroupFloats(farthest));
      const RayLanes<GroupFloats> lanes{vec3(rays.origin), vec3(rays.direction)};
      const GroupFloats length = length_above(lanes.direction);
      const Segment<GroupFloats, true> range{rays.tmin, finite_tmax(rays.tmax)};
      for (std::uint32_t triangles = undecided_[g]; triangles != 0; triangles &= triangles - 1) {
        const int triangle = std::countr_zero(triangles);
        const auto filtered = filter.classify(lanes, length, triangle, range);
        const std::uint32_t going = rays_.going[g], certain = bits(filtered.certain) & going & ~far;
        counters().hits(certain);
        rays_.going[g] &= ~certain;
        const std::uint32_t undecided = (bits(filtered.undecided) | far) & rays_.going[g];
        if (undecided != 0) [[unlikely]]
          test_out_of_line(block, leaf, triangle, g, undecided);
        if (rays_.going[g] != going) hit |= 1u << g;
      }
    }
    return hit;
  }
  [[gnu::noinline]] bool test_out_of_line(const LeafBlock<Test::floats>& block, TreeReference leaf,
                                          int triangle, int g, std::uint32_t rays) {
    return test_triangle(block, leaf, triangle, g, rays);
  }
  // Some rays of a group and one triangle, by the test itself.
  bool test_triangle(const LeafBlock<Test::floats>& block, TreeReference leaf, int triangle, int g,
                     std::uint32_t rays) {
    if constexpr (apex == SharedApex::end) {
      const RayColumns original = rays_.units.columns(batch_.rays, rays_.unit[g]);
      return test_rays(original_rays<Test>(original, frame_, tree_.bounds),
                       segment(original.tmin, finite_tmax(original.tmax)), block, leaf, triangle, g, rays);
    } else {
      return test_rays(rebuilt_rays<Test>(rays_, g, frame_, reach_), segment(g), block, leaf, triangle, g,
                       rays);
    }
  }
  template <class Range>
  bool test_rays(const PreparedRays<Test, GroupFloats>& prepared, const Range& range,
                 const LeafBlock<Test::floats>& block, TreeReference leaf, int triangle, int g,
                 std::uint32_t rays) {
    const auto load = [&](int k) { return GroupFloats(block.number[prepared.axes.index(k)][triangle]); };
    if constexpr (is_filtered<Test>) {
      auto filtered = Test::template classify<true>(prepared.triangles, load, rays, [&] { return range; });
      if ((filtered.certain | filtered.undecided) == 0) return false;
      counters().hits(filtered.certain), counters().undecided(filtered.undecided);
      take_certain(filtered, g, leaf_triangle_of(leaf, triangle));
      if (filtered.undecided != 0) [[unlikely]] {
        if constexpr (apex == SharedApex::end)
          rays_.going[g] &= ~bits(Test::decide(prepared.triangles, load, range, filtered.undecided).hit);
        else
          take_undecided(filtered.undecided, g, leaf_triangle_of(leaf, triangle));
      }
    } else {
      auto h = raylanes::test_triangle<Test>(prepared.triangles, load, range);
      rays &= bits(h.hit);
      counters().hits(rays);
      if (rays == 0) return false;
      if constexpr (only_decides)
        rays_.going[g] &= ~rays;
      else
        rays_.keep_nearer(g, h, rays, block.primitive[triangle]);
    }
    return true;
  }
  auto segment(int g) const {
    using V = GroupFloats;
    if constexpr (is_filtered<Test> && !only_decides)
      return rays_.state(g);
    else
      return segment(V::load(rays_.tmin[g]), V::load(rays_.tmax[g]));
  }
  static auto segment(GroupFloats tmin, GroupFloats tmax) {
    if constexpr (is_filtered<Test>)
      return Segment<GroupFloats, true>{tmin, tmax};
    else
      return LeafSegment<GroupFloats>{{tmin, tmax}};
  }
  void take_certain(const FilterResult<GroupFloats>& filtered, int g, std::uint32_t leaf_triangle) {
    if constexpr (only_decides)
      rays_.going[g] &= ~filtered.certain;
    else
      rays_.keep_certain(g, filtered, leaf_triangle);
  }
  [[gnu::noinline]] void take_undecided(std::uint32_t undecided, int g, std::uint32_t leaf_triangle) {
    for (; undecided != 0; undecided &= undecided - 1) {
      const int lane = std::countr_zero(undecided);
      if constexpr (only_decides) {
        if (exact_hit(TreeTriangles(tree_), ray_of(g, lane), leaf_triangle)) rays_.going[g] &= ~(1u << lane);
      } else {
        Candidate best = rays_.query(g, lane);
        compare_exactly(TreeTriangles(tree_), ray_of(g, lane), leaf_triangle, best);
        rays_.keep(g, lane, best);
      }
    }
  }

  [[gnu::noinline, gnu::flatten]] void trace_alone(const WaitingGroups& at) {
    TreeView below = tree_;
    below.root = at.reference;
    Counters counters(batch_);
    for (int i = 0; i < at.lone_rays; ++i) {
      const int g = at.ray[i] / group_lanes, lane = at.ray[i] % group_lanes;
      if ((rays_.going[g] >> lane & 1u) == 0) continue;
      const Ray& ray = ray_of(g, lane);
      const auto prepared = prepare_for_nodes<Test>(ray, tree_.bounds);
      if constexpr (only_decides) {
        AnyHit query(ray);
        raylanes::trace<Test>(below, ray, prepared, query, counters);
        if (query.found) rays_.going[g] &= ~(1u << lane);
      } else {
        auto query = rays_.query(g, lane);
        raylanes::trace<Test>(below, ray, prepared, query, counters);
        rays_.keep(g, lane, query);
      }
      rays_.refresh(g);
    }
    all_.far = rays_.farthest();
  }

  const Ray& ray_of(int g, int lane) const { return batch_.rays[rays_.number(g, lane)]; }

  const TreeView& tree_;
  const TraceBatch& batch_;
  const PacketFrame& frame_;
  float reach_;
  Rays& rays_;
  Around<apex, float> all_;
  int leaves_ = 0;
  std::uint32_t with_undecided_ = 0;     // groups for whose rays planes left triangles of a leaf undecided:
  std::uint8_t undecided_[most_groups];  // these
  WaitingGroups stack_[max_stack], *top_ = stack_;
};

}  // namespace
}  // namespace raylanes
