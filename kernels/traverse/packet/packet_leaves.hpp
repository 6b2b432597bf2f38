// The rays of a packet against the leaves of the tree: triangles are asked for the frusta around all rays and around
// groups, and only what is left for rays.
#pragma once

#include "edge_planes.hpp"
#include "packet_groups.hpp"
#include "prepared.hpp"
#include "winners.hpp"

namespace raylanes {
namespace {

template <class Test, SharedApex apex, bool only_decides, class Counters>
class PacketLeaves : public PacketGroups<apex, Counters> {
  using Base = PacketGroups<apex, Counters>;
  using Base::counters, Base::each_met, Base::frame_, Base::ray_of, Base::reach_, Base::refresh, Base::tree_;

 public:
  using Rays = PacketRays<Test, apex>;

  PacketLeaves(const TreeView& tree, const TraceBatch& batch, Rays& rays, const Float3& origin)
      : Base(Base::template calls_of<PacketLeaves>, tree, batch, rays, batch.hits,
             is_filtered<Test> ? 0.0f : slab_pad),
        batch_(batch),
        rays_(rays),
        numbers_(tree, origin) {}

  void begin() {
    if constexpr (!only_decides)
      for (int g = 0; g < rays_.groups; ++g) rays_.no_hit_yet(g);
  }
  void trace_single(std::size_t number) {
    trace_singles<Test, only_decides, Counters>(tree_, part_of(batch_, number, 1));
  }
  void store_results() {
    for (int g = 0; g < rays_.groups; ++g) store_answers(g);
  }
  [[gnu::noinline, gnu::flatten]] void visit_leaf(const WaitingGroups& at) {
    const LeafBlock<Test::floats>& block = leaf_block<Test>(tree_, at.reference);
    const Triangles triangles_of_leaf(block, frame_);
    counters().leaf();
    counters().frusta(first_lanes<tree_width>(leaf_size(at.reference)), tree_width / node_lanes);
    std::uint32_t hit = each_met(
        triangles_of_leaf, leaf_size(at.reference), at.groups,
        [&](int triangle, int g) { return test_group(triangles_of_leaf, block, at.reference, triangle, g); });
    if constexpr (filters_undecided)
      if (with_undecided_ != 0) hit |= filter_undecided(block, at.reference);
    refresh(hit);
  }

  // A ray that goes on alone below a node. For any hit few nodes are left: the walk of single rays, out of line, gains
  // nothing there.
  [[gnu::noinline, gnu::flatten]] void trace_alone(const WaitingGroups& at) {
    this->each_lone(at, [this](const TreeView& below, int g, int lane) { trace_lone(below, g, lane); });
  }
  void trace_lone(const TreeView& below, int g, int lane) {
    Counters cost = counters();
    const Ray& ray = ray_of(g, lane);
    if constexpr (only_decides) {
      AnyHit query(ray);
      raylanes::trace<Test>(below, ray, prepare_for_nodes<Test>(ray, tree_.bounds), query, cost);
      if (query.found) rays_.going[g] &= ~(1u << lane);
    } else {
      auto query = rays_.query(g, lane);
      WalksNodes::walk<Test>(below, ray, query, cost);
      rays_.keep(g, lane, query);
    }
  }

 private:
  static constexpr bool filters_undecided = is_filtered<Test> && only_decides && apex == SharedApex::end;
  // The frusta that test leaves: cones need a point.
  using Triangles = std::conditional_t<apex == SharedApex::none, FrameBoxes, EdgePlanes<Test>>;

  // A group and one triangle; whether segments have changed. If the planes of a triangle and its t leave nothing
  // undecided, no test is needed; only the test itself gives the numbers of a hit.
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
    // Without a branch on whether there are any: it would be predicted wrongly half the time.
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
    V side = planes.side(triangle, x, y);
    std::uint32_t rays = bits(side >= V(planes.bound(triangle))) & rays_.going[g];
    if ((planes.plain >> triangle & 1u) == 0) [[unlikely]]
      return rays != 0 && leave_undecided(block, leaf, triangle, g, rays);
    const auto range = segment(g);
    auto surely = range;
    if constexpr (apex == SharedApex::end) {
      V slack = V::load(rays_.slack[g]);
      surely.tmin = range.tmin + (slack + slack), surely.tmax = range.tmax - (slack + slack);
    }
    const auto decided = planes.decide(triangle, side, x, y, V::load(rays_.size_z[g]), range, surely);
    const FilterResult<V> filtered{bits(decided.certain) & rays, 0, decided.t_lo, decided.t_hi};
    counters().hits(filtered.certain);
    take_certain(filtered, g, leaf_triangle_of(leaf, triangle));
    rays &= bits(decided.undecided);
    const bool changed = filtered.certain != 0;
    return rays != 0 ? changed | leave_undecided(block, leaf, triangle, g, rays) : changed;
  }
  // Decides what the planes do not; returns whether segments have changed.
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
  // Planes mostly leave undecided the triangle where a ray begins: the filter of leaves tests it from the rays' own
  // origins. Returns the groups with hits.
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
  [[gnu::noinline, gnu::flatten]] void store_answers(int g) {
    if constexpr (only_decides) {
      store_decisions(batch_.occluded, rays_, g);
    } else if constexpr (is_filtered<Test> && apex == SharedApex::none) {
      DeferredHits<group_lanes> winners;
      for (int lane = 0; lane < group_lanes; ++lane)
        winners.set(lane, TreeTriangles(tree_), batch_.rays[rays_.number(g, lane)],
                    rays_.leaf_triangle[g][lane]);
      Hit hits[group_lanes];
      winners.store(hits);
      for (std::uint32_t lanes = rays_.taken[g]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        batch_.hits[rays_.number(g, lane)] = hits[lane];
      }
    } else if constexpr (is_filtered<Test>) {
      ColumnsOfHits hits;
      std::uint32_t undecided = round_hits<Test>(rays_, g, numbers_, hits);
      store_hits(batch_.hits, rays_, g, hits);
      for (; undecided != 0; undecided &= undecided - 1) {
        const int lane = std::countr_zero(undecided);
        const std::size_t number = rays_.number(g, lane);
        batch_.hits[number] =
            exact_hit(TreeTriangles(tree_), batch_.rays[number], rays_.leaf_triangle[g][lane]);
      }
    } else {
      store_hits(batch_.hits, rays_, g, rays_.hits(g));
    }
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

  struct NoNumbers {
    NoNumbers(const TreeView&, const Float3&) {}
  };
  static constexpr bool numbers_from_origin =
      is_filtered<Test> && apex == SharedApex::origin && !only_decides;

  const TraceBatch& batch_;
  Rays& rays_;
  [[no_unique_address]] std::conditional_t<numbers_from_origin, TrianglesFromOrigin, NoNumbers> numbers_;
  std::uint32_t with_undecided_ = 0;    // groups for whose rays planes left triangles of a leaf undecided:
  std::uint8_t undecided_[max_groups];  // these
};

}  // namespace
}  // namespace raylanes
