// The rays of a stream against the leaves of the tree: a register of rays and one triangle at a time, and what they
// have hit so far.
#pragma once

#include "../exact/leaf_screen.hpp"
#include "../ray/ranges.hpp"
#include "single.hpp"
#include "stream_hits.hpp"

namespace raylanes {
namespace {

// Vectors of rays against the triangles of a leaf by a screen. Self keeps rays by their index in the octant:
//   keep(i, t_lo, t_hi, leaf_triangle)   has a new best hit
//   end_ray(i)                           is hit, if that is all that is asked
//   compared(i, leaf_triangle)           the best hit, if this triangle is compared with it exactly: it is kept
//   is_hit(i, leaf_triangle)             whether the triangle is hit, exactly
//   admitted(lanes, list, leaf_triangle)   the lanes for whose rays the triangle is admitted; if sides() chooses
template <class Self, class V, bool only_decides>
class ScreenedRays {
 protected:
  // In registers while triangles are tested: a load of what was just stored lane by lane waits for all stores before
  // it.
  using State = RayState<V, only_decides>;

  // Without a branch on what is hit: one in three of these registers has a ray that is, and nothing foretells which.
  template <class Screen>
  void classify_triangles(const RayLanes<V>& rays, V length, const Screen& screen, int triangles,
                          std::uint32_t first, const ListEntry* list, std::uint32_t active, State& left) {
    auto going = MaskOf<V>::from_bits(active), found = going & ~going;
    for (int triangle = 0; triangle < triangles; ++triangle) {
      const std::uint32_t leaf_triangle = first + static_cast<std::uint32_t>(triangle);
      self().counters().triangles(bits(going));
      const auto verdict = screen.classify(rays, length, triangle, left, self().sides());
      auto certain = verdict.certain & going, undecided = verdict.undecided & going;
      if constexpr (decltype(self().sides())::chooses) {
        const auto admitted_by_rule =
            MaskOf<V>::from_bits(self().admitted(bits(certain | undecided), list, leaf_triangle));
        certain = certain & admitted_by_rule, undecided = undecided & admitted_by_rule;
      }
      self().counters().hits(bits(certain)), self().counters().undecided(bits(undecided));
      found = found | certain;
      if constexpr (only_decides) {
        going = going & ~certain;
      } else {
        left.keep(certain, verdict.t_lo, verdict.t_hi, as_bits(leaf_triangle));
      }
      if (any(undecided)) [[unlikely]] {
        store_certain(bits(found), left, list);
        found = found & ~found;
        going = going & ~MaskOf<V>::from_bits(take_undecided(bits(undecided), list, leaf_triangle, left));
      }
      if (only_decides && !any(going)) break;
    }
    store_certain(bits(found), left, list);
  }

 private:
  using T = typename NumberOf<V>::type;
  using Word = typename BitsOf<T>::type;
  static constexpr int N = lanes_of<V>;

  Self& self() { return static_cast<Self&>(*this); }
  static V as_bits(std::uint32_t word) { return as<T>(Lanes<Word, N>(Word{word})); }

  void store_certain(std::uint32_t found, const State& left, const ListEntry* list) {
    if (found == 0) return;
    T t_lo[N], t_hi[N];
    Word leaf_triangle[N];
    if constexpr (!only_decides)
      left.t_lo.store(t_lo), left.tmax.store(t_hi), as<Word>(left.leaf_triangle).store(leaf_triangle);
    for (; found != 0; found &= found - 1) {
      const int lane = std::countr_zero(found);
      if constexpr (only_decides)
        self().end_ray(index_of(list[lane]));
      else
        self().keep(index_of(list[lane]), t_lo[lane], t_hi[lane],
                    static_cast<std::uint32_t>(leaf_triangle[lane]));
    }
  }
  // Returns the rays that end.
  [[gnu::noinline]] std::uint32_t take_undecided(std::uint32_t undecided, const ListEntry* list,
                                                 std::uint32_t leaf_triangle, State& left) {
    std::uint32_t ended = 0;
    for (; undecided != 0; undecided &= undecided - 1) {
      const int lane = std::countr_zero(undecided);
      const std::uint32_t i = index_of(list[lane]);
      if constexpr (only_decides) {
        if (!self().is_hit(i, leaf_triangle)) continue;
        self().end_ray(i);
        ended |= 1u << lane;
      } else {
        const auto best = self().compared(i, leaf_triangle);
        const auto changed = MaskOf<V>::from_bits(1u << lane);
        left.keep(changed, V(best.t_lo), V(best.tmax), as_bits(best.leaf_triangle));
      }
    }
    return ended;
  }
};

template <class Test, bool only_decides, class Counters, class Sides = NoRule>
class StreamLeaves
    : public StreamOctant<Counters>,
      ScreenedRays<StreamLeaves<Test, only_decides, Counters, Sides>, StreamFloats, only_decides> {
  using Base = StreamOctant<Counters>;
  using Screened = ScreenedRays<StreamLeaves, StreamFloats, only_decides>;
  friend Screened;
  using Base::farthest_, Base::needs_, Base::rays_, Base::tree_;

 public:
  using Base::counters;

  StreamLeaves(const TreeView& tree, const TraceBatch& batch)
      : Base(Base::template calls_of<StreamLeaves>,
             {.only_decides = only_decides,
              .packs_rays = true,
              .packs_lengths = screens<Test>,
              .rounding = screens<Test> ? 0.0f : slab_pad,
              .scale = screen_scale<Test>(tree.bounds)},
             tree, batch),
        batch_(batch) {}

  void begin() {
    for (std::uint32_t i = 0; i < rays_.size && !only_decides; ++i)
      if constexpr (screens<Test>)
        rays_.t_lo(i) = rays_.rows[i].tmax, rays_.leaf_triangle[i] = no_leaf_triangle;
      else
        rays_.hits[i] = Hit();
  }
  void store_results() {
    if constexpr (screens<Test> && !only_decides)
      StreamHits(tree_, batch_, rays_, needs_.scale).store();
    else if constexpr (!only_decides)
      for (std::uint32_t i = 0; i < rays_.size; ++i) batch_.hits[rays_.number[i]] = rays_.hits[i];
  }
  void trace_single(std::size_t number) {
    trace_singles<Test, only_decides, Counters, Sides>(tree_, part_of(batch_, number, 1));
  }

  [[gnu::noinline, gnu::flatten]] void visit_leaf(TreeReference leaf, const ListEntry* list,
                                                  std::uint32_t size) {
    const LeafBlock<Test::floats>& block = leaf_block<Test>(tree_, leaf);
    const int triangles = leaf_size(leaf);
    counters().leaf();
    at_ = leaf;
    const auto screen = screen_of(block, triangles);
    for (std::uint32_t i = 0; i < size; i += stream_lanes)
      test_triangles(block, screen, triangles, leaf, list + i, size - i);
  }

  [[gnu::noinline, gnu::flatten]] void trace_singly(TreeReference from, const ListEntry* list,
                                                    std::uint32_t size) {
    at_ = from;
    this->each_single(
        from, list, size,
        [this](const TreeView& below, const SingleBoxes& boxes, std::uint32_t i, Counters& cost) {
          trace_single_below(below, this->template unpacked<Test>(i, boxes), i, cost);
        });
  }

 private:
  using State = typename Screened::State;

  Sides sides() const { return Sides(batch_); }
  Sides sides(std::uint32_t i) const { return Sides(batch_, rays_.number[i]); }

  // A ray that goes on alone below a node.
  template <class Prepared>
  void trace_single_below(const TreeView& below, const Prepared& prepared, std::uint32_t i, Counters& cost) {
    const Ray& ray = batch_.rays[rays_.number[i]];
    if constexpr (only_decides) {
      auto query = any_within(rays_.rows[i].tmax, sides(i));
      trace<Test>(below, ray, prepared, query, cost);
      if (query.found) end_ray(i);
    } else if constexpr (screens<Test>) {
      auto query = nearest_of(candidate_of(i), sides(i));
      trace<Test>(below, ray, prepared, query, cost);
      keep(i, query.t_lo, query.tmax, query.leaf_triangle);
    } else {
      Hit& best = rays_.hits[i];
      Closest query(rays_.rows[i].tmax, best);
      trace<Test>(below, ray, prepared, query, cost);
      best = query.best, rays_.rows[i].tmax = query.tmax;
    }
  }

  void keep(std::uint32_t i, float t_lo, float t_hi, std::uint32_t leaf_triangle) {
    rays_.rows[i].tmax = t_hi, rays_.t_lo(i) = t_lo, rays_.leaf_triangle[i] = leaf_triangle;
  }
  Candidate candidate_of(std::uint32_t i) const {
    return {rays_.t_lo(i), rays_.rows[i].tmax, rays_.leaf_triangle[i]};
  }
  // Nothing enters a box before −infinity.
  static constexpr float ended = -std::numeric_limits<float>::infinity();
  void end_ray(std::uint32_t i) {
    rays_.rows[i].tmax = ended;
    batch_.occluded[rays_.number[i]] = 1;
    if (batch_.found_at != nullptr) [[unlikely]]
      batch_.found_at[rays_.number[i]] = at_;
  }

  Candidate compared(std::uint32_t i, std::uint32_t leaf_triangle) {
    const Ray& ray = batch_.rays[rays_.number[i]];
    Candidate best = candidate_of(i);
    compare_exactly(TreeTriangles(tree_), ray, leaf_triangle, best, sides());
    if (best.beside > 0) [[unlikely]] {
      auto query = nearest_of(best, sides(i));
      finish_beside(ray, query);
      best = query, best.tmax = ended;
    }
    keep(i, best.t_lo, best.tmax, best.leaf_triangle);
    return best;
  }
  bool is_hit(std::uint32_t i, std::uint32_t leaf_triangle) {
    const Ray& ray = batch_.rays[rays_.number[i]];
    if (rays_.rows[i].tmax == ended) return false;
    int beside = 0;
    if (any_exact_hit(TreeTriangles(tree_), ray, 1u, leaf_triangle, sides().facing, &beside)) return true;
    if (beside == 0) return false;
    auto query = any_within(rays_.rows[i].tmax, sides(i));
    finish_beside(ray, query);
    rays_.rows[i].tmax = ended;
    return query.found;
  }
  // A ray that came to a triangle beside it goes on alone.
  template <class Query>
  void finish_beside(const Ray& ray, Query& query) {
    Counters cost = counters();
    walk_beside<Test>(tree_, ray, query, cost);
  }
  std::uint32_t admitted(std::uint32_t lanes, const ListEntry* list, std::uint32_t leaf_triangle) const {
    if (batch_.skip == nullptr && tree_.masks.see_all()) return lanes;
    const std::uint32_t primitive = TreeTriangles(tree_).primitive(leaf_triangle);
    if (!tree_.masks.see(primitive)) return 0;
    if (batch_.skip == nullptr) return lanes;
    for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      if (batch_.skip[rays_.number[index_of(list[lane])]] == primitive) lanes &= ~(1u << lane);
    }
    return lanes;
  }

  // The numbers of a leaf that all rays of a list share, for a test that has a screen.
  auto screen_of([[maybe_unused]] const LeafBlock<Test::floats>& block,
                 [[maybe_unused]] int triangles) const {
    if constexpr (screens<Test>)
      return LeafScreen(block, triangles, farthest_, needs_.scale);
    else
      return 0;
  }

  // A register of rays, or the first `size`, against all triangles of a leaf.
  template <class Screen>
  void test_triangles(const LeafBlock<Test::floats>& block, const Screen& screen, int triangles,
                      TreeReference leaf, const ListEntry* list, std::uint32_t size) {
    const void *rows[stream_lanes], *ends[stream_lanes];
    for (int lane = 0; lane < stream_lanes; ++lane) {
      const std::uint32_t i = index_of(list[lane]);
      rows[lane] = rays_.packed + i, ends[lane] = rays_.rows[i].half();
    }
    StreamFloats packed[row_floats], columns[4];
    load_rows(rows, packed), load_rows(ends, columns);
    State left{};
    left.tmin = columns[2], left.tmax = columns[3];
    if constexpr (!only_decides) left.t_lo = packed[row_floats - 1];
    std::uint32_t active = first_lanes<stream_lanes>(size);
    if constexpr (screens<Test>) {
      const RayLanes<StreamFloats> rays{vec3(packed), vec3(packed + 3)};
      this->classify_triangles(rays, packed[6], screen, triangles, leaf_triangle_of(leaf, 0), list, active,
                               left);
    } else if constexpr (only_decides) {
      find_any(unpack_rays<Test>(packed), block, triangles, list, active, left);
    } else {
      find_nearest(unpack_rays<Test>(packed), block, triangles, list, active, left);
    }
  }
  template <class Rays>
  auto test_lanes(const Rays& rays, const LeafBlock<Test::floats>& block, int triangle,
                  const State& left) const {
    const auto load = [&](int k) { return StreamFloats(block.number[k][triangle]); };
    return test_triangle<Test>(rays, load, Segment<StreamFloats>{left.tmin, left.tmax});
  }
  template <class Rays>
  void find_any(const Rays& rays, const LeafBlock<Test::floats>& block, int triangles, const ListEntry* list,
                std::uint32_t active, const State& left) {
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
  void find_nearest(const Rays& rays, const LeafBlock<Test::floats>& block, int triangles,
                    const ListEntry* list, std::uint32_t active, State& left) {
    const auto taking_part = FloatMask<stream_lanes>::from_bits(active);
    decltype(test_lanes(rays, block, 0, left)) best{};
    best.hit = FloatMask<stream_lanes>::first(0);  // which {} leaves open on NEON
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
  // Among lanes that hit at the end of their segment, which may be the best hit so far: the lanes where that stays.
  [[gnu::noinline]] FloatMask<stream_lanes> not_better(FloatMask<stream_lanes> lanes, StreamFloats t,
                                                       std::uint32_t primitive, const ListEntry* list,
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
  void store_hits(const TestHit& best, StreamFloats new_t, StreamFloats new_primitive,
                  const ListEntry* list) {
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

  const TraceBatch& batch_;
  TreeReference at_ = empty_reference;  // the node or leaf whose rays are tested
};

}  // namespace
}  // namespace raylanes
