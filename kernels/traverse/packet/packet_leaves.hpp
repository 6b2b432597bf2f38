// The rays of a packet against the leaves of the tree: triangles are tested with the frusta around all rays and around
// vectors of rays, and the rest with rays.
#pragma once

#include "../stream_rays.hpp"
#include "apex_triangles.hpp"
#include "packet_walk.hpp"

namespace raylanes {
namespace {

// Whether packets look at facing and skip.
template <class Test, class Counters>
inline constexpr bool packets_choose = screens<Test>&& std::is_same_v<Counters, NoCounters>;

// Rays that are no packet.
template <class Test, bool only_decides, class Counters>
[[gnu::noinline]] void trace_others(const TreeView& tree, const TraceBatch& batch) {
  if constexpr (packets_choose<Test, Counters>)
    if (batch.by_rule != nullptr) {
      for (std::size_t i = 0; i < batch.size; ++i) {
        const std::uint32_t skipped = skipped_by(batch, i);
        if constexpr (only_decides)
          batch.occluded[i] = batch.by_rule->any(tree, batch.rays[i], batch.facing, skipped) ? 1 : 0;
        else
          batch.hits[i] = batch.by_rule->closest(tree, batch.rays[i], batch.facing, skipped);
      }
      return;
    }
  trace_singles<Test, only_decides, Counters>(tree, batch);
}

template <class Test, SharedApex apex, bool only_decides, class Counters>
class PacketLeaves : public PacketWalk<apex, Counters> {
  using V = Floats<W>;
  using Walk = PacketWalk<apex, Counters>;
  using Walk::counters, Walk::frame_, Walk::ray_of, Walk::reach_, Walk::tree_;
  // Triangles as frusta test them: planes need an apex.
  using Triangles = std::conditional_t<apex == SharedApex::none, FrameBoxes, EdgePlanes<Test>>;

 public:
  using Rays = RaysAndHits<Test, apex>;

  PacketLeaves(const TreeView& tree, const TraceBatch& batch, Rays& rays, const ApexOfRays<apex>& of,
               std::size_t rays_left)
      : Walk(Walk::template calls_of<PacketLeaves>, tree, batch, rays, of, rays_left, batch.hits,
             screens<Test> ? 0.0f : slab_pad),
        batch_(batch),
        rays_(rays),
        from_origin_(tree, of.at) {}

  void begin() {
    if constexpr (!only_decides)
      for (int row = 0; row < rays_.vectors; ++row) rays_.clear_hits(row);
    if constexpr (chooses)
      for (int row = 0; batch_.skip != nullptr && row < rays_.vectors; ++row)
        rays_.set_skipped(row, batch_.skip);
  }
  void trace_single(std::size_t index) {
    trace_others<Test, only_decides, Counters>(tree_, part_of(batch_, index, 1));
  }
  void store_results() {
    for (int row = 0; row < rays_.vectors; ++row) store_results(row);
  }
  [[gnu::noinline, gnu::flatten]] void visit_leaf(const StackEntry& at) {
    const Leaf leaf{leaf_block<Test>(tree_, at.reference), at.reference};
    const Triangles triangles(leaf.block, frame_);
    const int size = leaf_size(at.reference);
    counters().leaf(), counters().frusta(first_lanes<tree_width>(size), tree_width / node_lanes);
    std::uint32_t some = first_lanes<tree_width>(size);
    if constexpr (chooses && apex != SharedApex::none)
      some &= ~triangles.plain | admitted_lanes(batch_.facing, ~0u, front_of(triangles));
    std::uint32_t hit = this->each_met(triangles, some, at.vectors, [&](int triangle, int row) {
      return test_vector(triangles, leaf, triangle, row);
    });
    if constexpr (settles_undecided)
      if (with_undecided_ != 0) hit |= settle_undecided(leaf);
    if constexpr (only_decides)
      if (batch_.found_at != nullptr) [[unlikely]]
        note(hit, at.reference);
    this->refresh(hit);
  }
  // For any hit few nodes are left: the walk of single rays, out of line, gains nothing there.
  [[gnu::noinline, gnu::flatten]] void trace_rays(const StackEntry& at) {
    this->each_single(at, [this](const TreeView& below, int row, int lane) {
      if constexpr (chooses)
        if (batch_.by_rule != nullptr) return trace_by_rule(below, row, lane);
      Counters cost = counters();
      const Ray& ray = ray_of(row, lane);
      if constexpr (only_decides) {
        AnyHit query(ray);
        raylanes::trace<Test>(below, ray, prepare_for_nodes<Test>(ray, tree_.bounds), query, cost);
        if (query.found) end_ray(row, lane, below.root);
      } else {
        auto query = rays_.query(row, lane);
        WalksNodes::walk<Test>(below, ray, query, cost);
        rays_.keep(row, lane, query);
      }
    });
  }

 private:
  static constexpr bool settles_undecided = screens<Test> && only_decides && apex == SharedApex::end;
  static constexpr bool chooses = packets_choose<Test, Counters>;

  struct Leaf {
    const LeafBlock<Test::floats>& block;
    TreeReference reference;
  };

  void end_ray(int row, int lane, TreeReference at) {
    rays_.active[row] &= ~(1u << lane);
    if (batch_.found_at != nullptr) batch_.found_at[rays_.index(row, lane)] = at;
  }
  // Notes for rays of these vectors that they have ended there.
  [[gnu::noinline]] void note(std::uint32_t vectors, TreeReference at) {
    for (; vectors != 0; vectors &= vectors - 1) {
      const int row = std::countr_zero(vectors);
      for (std::uint32_t left = rays_.occupied[row] & ~rays_.active[row]; left != 0; left &= left - 1) {
        TreeReference& found_at = batch_.found_at[rays_.index(row, std::countr_zero(left))];
        if (found_at == tree_.root) found_at = at;
      }
    }
  }
  // The plain triangles to whose front rays come: those that end at the apex come from the other side.
  static std::uint32_t front_of(const Triangles& triangles) {
    return apex == SharedApex::end ? triangles.away : ~triangles.away;
  }
  // The active rays for which a triangle is there.
  std::uint32_t rays_for(const Leaf& leaf, int triangle, int row) const {
    if constexpr (chooses) {
      if (!tree_.masks.see_all() && !tree_.masks.see(leaf.block.primitive[triangle])) return 0;
      if (batch_.skip != nullptr)
        return rays_.active[row] & ~rays_.rays_that_skip(row, leaf.block.primitive[triangle]);
    }
    return rays_.active[row];
  }
  // Leaves the lanes that are hit on a side that counts, of certain hits.
  std::uint32_t on_sides(std::uint32_t certain, V det) const {
    if constexpr (chooses) return admitted_lanes(batch_.facing, certain, bits(det > V(0.0f)));
    return certain;
  }
  // As trace_rays(), by the batch's row.
  void trace_by_rule(const TreeView& below, int row, int lane) {
    const Ray& ray = ray_of(row, lane);
    const std::uint32_t skipped = batch_.skip != nullptr ? rays_.skipped[row][lane] : no_primitive;
    if constexpr (only_decides) {
      if (batch_.by_rule->any(below, ray, batch_.facing, skipped)) end_ray(row, lane, below.root);
    } else {
      const Candidate so_far = rays_.query(row, lane);
      NearestSoFar best{so_far.t_lo, so_far.tmax, so_far.leaf_triangle};
      batch_.by_rule->nearer(below, ray, best, batch_.facing, skipped);
      rays_.keep(row, lane, Candidate(best.t_lo, best.tmax, best.leaf_triangle));
    }
  }

  // Tests a vector of rays and one triangle; returns whether segments have changed. If the planes of a triangle and its
  // t leave nothing undecided, no test is needed; only the test itself gives the numbers of a hit.
  bool test_vector(const Triangles& triangles, const Leaf& leaf, int triangle, int row) {
    constexpr bool is_closest_hit = !only_decides && !screens<Test>;
    if constexpr (apex != SharedApex::none && may_take_planes<Test>)
      return hit_planes(triangles, leaf, triangle, row);
    else if constexpr (apex == SharedApex::none || is_closest_hit)
      return test_triangle(leaf, triangle, row, rays_for(leaf, triangle, row));
    else
      return decide_by_planes(triangles, leaf, triangle, row);
  }
  bool hit_planes(const Triangles& planes, const Leaf& leaf, int triangle, int row) {
    std::uint32_t rays = rays_.active[row];
    if ((planes.plain >> triangle & 1u) == 0) [[unlikely]]
      return test_out_of_line(leaf, triangle, row, rays);
    auto range = segment(row);
    if constexpr (apex == SharedApex::end) {
      V t_error = V::load(rays_.t_error[row]);
      range.tmin = range.tmin + t_error, range.tmax = range.tmax - t_error;
    }
    const auto h = planes.hit(triangle, V::load(rays_.slope_x[row]), V::load(rays_.slope_y[row]),
                              V::load(rays_.size_z[row]), range);
    rays &= bits(h.hit);
    counters().hits(rays);
    // Without a branch on whether there are any: it would be predicted wrongly half the time.
    keep_hits(h, leaf, triangle, row, rays);
    return rays != 0;
  }
  bool decide_by_planes(const Triangles& planes, const Leaf& leaf, int triangle, int row) {
    V x = V::load(rays_.slope_x[row]), y = V::load(rays_.slope_y[row]);
    V side = planes.side(triangle, x, y);
    std::uint32_t rays = bits(side >= V(planes.bound(triangle))) & rays_for(leaf, triangle, row);
    if ((planes.plain >> triangle & 1u) == 0) [[unlikely]]
      return rays != 0 && defer_undecided(leaf, triangle, row, rays);
    const auto range = segment(row);
    auto surely = range;
    if constexpr (apex == SharedApex::end) {
      V t_error = V::load(rays_.t_error[row]);
      surely.tmin = range.tmin + (t_error + t_error), surely.tmax = range.tmax - (t_error + t_error);
    }
    const auto decided = planes.decide(triangle, side, x, y, V::load(rays_.size_z[row]), range, surely);
    const Verdict<V> verdict{bits(decided.certain) & rays, 0, decided.t_lo, decided.t_hi};
    counters().hits(verdict.certain);
    keep_certain(verdict, leaf, triangle, row);
    rays &= bits(decided.undecided);
    const bool changed = verdict.certain != 0;
    return rays != 0 ? changed | defer_undecided(leaf, triangle, row, rays) : changed;
  }
  // Decides what the planes do not, or leaves it to the screen; returns whether segments have changed.
  bool defer_undecided(const Leaf& leaf, int triangle, int row, std::uint32_t rays) {
    if constexpr (!settles_undecided) return test_out_of_line(leaf, triangle, row, rays);
    const std::uint32_t so_far = with_undecided_ >> row & 1u ? undecided_[row] : 0u;
    undecided_[row] = static_cast<std::uint8_t>(so_far | 1u << triangle);
    with_undecided_ |= 1u << row;
    return false;
  }
  // Planes mostly leave undecided the triangle where a ray begins: the screen of leaves tests it from the rays' own
  // origins. Returns the vectors with hits.
  [[gnu::noinline, gnu::flatten]] std::uint32_t settle_undecided(const Leaf& leaf) {
    constexpr float farthest = 0x1p60f;
    const bool is_unusual = screen_scale<Test>(tree_.bounds) != 1.0f;
    const LeafScreen screen(leaf.block, leaf_size(leaf.reference), farthest, 1.0f);
    std::uint32_t hit = 0;
    for (; with_undecided_ != 0; with_undecided_ &= with_undecided_ - 1) {
      const int row = std::countr_zero(with_undecided_);
      const RayColumns rays = user_rays(row);
      const std::uint32_t far = is_unusual ? ~0u : ~bits(rays.reach(tree_.bounds) <= V(farthest));
      const RayLanes<V> lanes{vec3(rays.origin), vec3(rays.direction)};
      const V length = length_above(lanes.direction);
      const Segment<V, true> range{rays.tmin, finite_tmax(rays.tmax)};
      for (std::uint32_t triangles = undecided_[row]; triangles != 0; triangles &= triangles - 1) {
        const int triangle = std::countr_zero(triangles);
        const auto verdict = screen.classify(lanes, length, triangle, range);
        const std::uint32_t active = rays_.active[row], met = rays_for(leaf, triangle, row);
        const std::uint32_t certain = on_sides(bits(verdict.certain) & met & ~far, verdict.det);
        counters().hits(certain);
        rays_.active[row] &= ~certain;
        const std::uint32_t undecided = (bits(verdict.undecided) | far) & rays_.active[row] & met;
        if (undecided != 0) [[unlikely]]
          test_out_of_line(leaf, triangle, row, undecided);
        if (rays_.active[row] != active) hit |= 1u << row;
      }
    }
    return hit;
  }
  [[gnu::noinline]] bool test_out_of_line(const Leaf& leaf, int triangle, int row, std::uint32_t rays) {
    return test_triangle(leaf, triangle, row, rays);
  }
  // Some rays of a vector and one triangle, by the test itself.
  bool test_triangle(const Leaf& leaf, int triangle, int row, std::uint32_t rays) {
    if constexpr (apex == SharedApex::end) {
      const RayColumns user = user_rays(row);
      return test_rays(prepared_rays<Test>(user, frame_, tree_.bounds),
                       segment(user.tmin, finite_tmax(user.tmax)), leaf, triangle, row, rays);
    } else {
      return test_rays(prepared_rays(rays_, row, frame_, reach_), segment(row), leaf, triangle, row, rays);
    }
  }
  template <class Range>
  bool test_rays(const PreparedRays<Test, V>& prepared, const Range& range, const Leaf& leaf, int triangle,
                 int row, std::uint32_t rays) {
    const auto load = [&](int k) { return V(leaf.block.number[prepared.axes.index(k)][triangle]); };
    if constexpr (screens<Test>) {
      auto verdict = Test::template classify<true>(prepared.triangles, load, rays, [&] { return range; });
      if ((verdict.certain | verdict.undecided) == 0) return false;
      verdict.certain = on_sides(verdict.certain, verdict.det);
      counters().hits(verdict.certain), counters().undecided(verdict.undecided);
      keep_certain(verdict, leaf, triangle, row);
      if (verdict.undecided != 0) [[unlikely]] {
        if (apex == SharedApex::end && batch_.facing == Facing::any)
          rays_.active[row] &= ~bits(Test::decide(prepared.triangles, load, range, verdict.undecided).hit);
        else
          decide_exactly(verdict.undecided, leaf_triangle_of(leaf.reference, triangle), row);
      }
    } else {
      auto h = raylanes::test_triangle<Test>(prepared.triangles, load, range);
      rays &= bits(h.hit);
      counters().hits(rays);
      if (rays == 0) return false;
      keep_hits(h, leaf, triangle, row, rays);
    }
    return true;
  }
  template <class TestHit>
  void keep_hits(const TestHit& h, const Leaf& leaf, int triangle, int row, std::uint32_t rays) {
    if constexpr (only_decides)
      rays_.active[row] &= ~rays;
    else
      rays_.keep_nearer(row, h, rays, leaf.block.primitive[triangle]);
  }
  void keep_certain(const Verdict<V>& verdict, const Leaf& leaf, int triangle, int row) {
    if constexpr (only_decides)
      rays_.active[row] &= ~verdict.certain;
    else
      rays_.keep_certain(row, verdict, leaf_triangle_of(leaf.reference, triangle));
  }
  [[gnu::noinline]] void decide_exactly(std::uint32_t undecided, std::uint32_t leaf_triangle, int row) {
    const TreeTriangles triangles(tree_);
    const std::conditional_t<chooses, HitRule, NoRule> sides(batch_);
    for (; undecided != 0; undecided &= undecided - 1) {
      const int lane = std::countr_zero(undecided);
      const Ray& ray = ray_of(row, lane);
      if constexpr (only_decides) {
        if (sides.admitted_hit(exact_hit(triangles, ray, leaf_triangle), triangles, ray, leaf_triangle))
          rays_.active[row] &= ~(1u << lane);
      } else {
        Candidate best = rays_.query(row, lane);
        compare_exactly(triangles, ray, leaf_triangle, best, sides);
        rays_.keep(row, lane, best);
      }
    }
  }

  RayColumns user_rays(int row) const { return rays_.runs.columns(batch_.rays, rays_.first_run[row]); }
  auto segment(int row) const {
    if constexpr (screens<Test> && !only_decides)
      return rays_.state(row);
    else
      return segment(V::load(rays_.tmin[row]), V::load(rays_.tmax[row]));
  }
  static auto segment(V tmin, V tmax) {
    if constexpr (screens<Test>)
      return Segment<V, true>{tmin, tmax};
    else
      return LeafSegment<V>{{tmin, tmax}};
  }

  [[gnu::noinline, gnu::flatten]] void store_results(int row) {
    if constexpr (only_decides) {
      store_decisions(batch_.occluded, rays_, row);
    } else if constexpr (screens<Test> && apex == SharedApex::none) {
      DeferredHits<W> winners;
      for (int lane = 0; lane < W; ++lane)
        winners.set(lane, TreeTriangles(tree_), ray_of(row, lane), rays_.leaf_triangle[row][lane]);
      Hit hits[W];
      winners.store(hits);
      for (std::uint32_t lanes = rays_.occupied[row]; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        batch_.hits[rays_.index(row, lane)] = hits[lane];
      }
    } else if constexpr (screens<Test>) {
      ColumnsOfHits hits;
      std::uint32_t undecided = round_hits<Test>(rays_, row, from_origin_, hits);
      store_hits(batch_.hits, rays_, row, hits);
      for (; undecided != 0; undecided &= undecided - 1) {
        const int lane = std::countr_zero(undecided);
        batch_.hits[rays_.index(row, lane)] =
            exact_hit(TreeTriangles(tree_), ray_of(row, lane), rays_.leaf_triangle[row][lane]);
      }
    } else {
      ColumnsOfHits hits;
      hits.set(rays_.found[row], V::load(rays_.tmax[row]), V::load(rays_.u[row]), V::load(rays_.v[row]),
               as<float>(FloatBits<W>::load(rays_.primitive[row])));
      store_hits(batch_.hits, rays_, row, hits);
    }
  }

  struct Nothing {
    Nothing(const TreeView&, const Float3&) {}
  };
  static constexpr bool rounds_hits = screens<Test> && apex == SharedApex::origin && !only_decides;

  const TraceBatch& batch_;
  Rays& rays_;
  [[no_unique_address]] std::conditional_t<rounds_hits, TrianglesFromOrigin, Nothing> from_origin_;
  std::uint32_t with_undecided_ = 0;     // vectors for whose rays planes left triangles of a leaf undecided:
  std::uint8_t undecided_[max_vectors];  // these
};

}  // namespace
}  // namespace raylanes
