// The rays of a stream against the leaves of the tree: a register of rays and one triangle at a time, and what they
// have hit so far.
#pragma once

#include "screened_rays.hpp"
#include "single.hpp"
#include "stream_few.hpp"
#include "stream_hits.hpp"

namespace raylanes {
namespace {

template <class Test, bool only_decides, class Counters, class Sides = NoRule>
class StreamLeaves
    : public StreamOctant<Counters>,
      ScreenedRays<StreamLeaves<Test, only_decides, Counters, Sides>, StreamFloats, only_decides> {
  using Base = StreamOctant<Counters>;
  using Screened = ScreenedRays<StreamLeaves, StreamFloats, only_decides>;
  friend Screened;
  // Counted rows go by lists.
  static constexpr bool takes_few = screens<Test> && max_few != 0 && std::is_same_v<Counters, NoCounters>;
  using Base::farthest_, Base::needs_, Base::rays_, Base::tree_;

 public:
  using Base::counters;

  StreamLeaves(const TreeView& tree, const TraceBatch& batch)
      : Base(Base::template calls_of<StreamLeaves>,
             {.only_decides = only_decides,
              .packs_rays = true,
              .packs_lengths = screens<Test>,
              .skip = Sides::chooses ? batch.skip : nullptr,
              .rounding = screens<Test> ? 0.0f : slab_pad,
              .scale = screen_scale<Test>(tree.bounds)},
             tree, batch),
        batch_(batch) {}

  void begin() {
    for (std::uint32_t i = 0; i < rays_.size && !only_decides; ++i)
      if constexpr (screens<Test>)
        rays_.t_lo(i) = rays_.tmax(i), rays_.leaf_triangle[i] = no_leaf_triangle;
      else
        rays_.hits[i] = Hit();
  }
  void store_results() {
    if constexpr (screens<Test> && !only_decides)
      StreamHits(tree_, batch_, rays_, this->columns_, needs_.scale).store();
    else if constexpr (!only_decides)
      for (std::uint32_t i = 0; i < rays_.size; ++i) batch_.hits[rays_.number[i]] = rays_.hits[i];
  }
  void trace_single(std::size_t number) {
    trace_singles<Test, only_decides, Counters, Sides>(tree_, part_of(batch_, number, 1));
  }

  [[gnu::noinline, gnu::flatten]] void visit_leaf(TreeReference leaf, const ListEntry* list,
                                                  std::uint32_t size) {
    const LeafBlock<Test::floats>& block = leaf_block<Test>(tree_, leaf);
    const int size_of_leaf = leaf_size(leaf);
    const std::uint32_t triangles = seen(leaf, first_lanes<tree_width>(unsigned(size_of_leaf)));
    counters().leaf();
    if (triangles == 0) return;
    at_ = leaf;
    const auto screen = screen_of(block, size_of_leaf);
    for (std::uint32_t i = 0; i < size; i += stream_lanes)
      test_triangles(block, screen, triangles, leaf, list + i, size - i);
  }

  bool trace_few(const OctantRays& memory) requires takes_few {
    FewInStream few(*this);
    if (!few.take(memory)) return false;
    few.trace();
    store_results();
    return true;
  }
  [[gnu::noinline, gnu::flatten]] void visit_few(TreeReference leaf, std::uint64_t rays) requires takes_few {
    const LeafBlock<9>& block = leaf_block<Test>(tree_, leaf);
    const int size = leaf_size(leaf);
    float entry[tree_width];
    const OctantNode planes(block, this->octant_, this->padding_);
    const std::uint32_t triangles = seen(
        leaf, this->columns_->frustum.boxes_met(planes, entry) & first_lanes<tree_width>(unsigned(size)));
    if (triangles == 0) return;
    at_ = leaf;
    const LeafScreen screen(block, size, farthest_, needs_.scale);
    for (std::uint32_t first = 0; rays != 0; first += stream_lanes, rays >>= stream_lanes % 64)
      if (const auto lanes = static_cast<std::uint32_t>(rays) & first_lanes<stream_lanes>(stream_lanes);
          lanes != 0)
        test_columns(*this->columns_, first, lanes, screen, triangles, leaf_triangle_of(leaf, 0));
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
      auto query = any_within(rays_.tmax(i), sides(i));
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
    rays_.tmax(i) = t_hi, rays_.t_lo(i) = t_lo, rays_.leaf_triangle[i] = leaf_triangle;
  }
  Candidate candidate_of(std::uint32_t i) const {
    return {rays_.t_lo(i), rays_.tmax(i), rays_.leaf_triangle[i]};
  }
  // Nothing enters a box before −infinity.
  static constexpr float ended = -std::numeric_limits<float>::infinity();
  void end_ray(std::uint32_t i) {
    rays_.tmax(i) = ended;
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
    if (rays_.tmax(i) == ended) return false;
    int beside = 0;
    if (any_exact_hit(TreeTriangles(tree_), ray, 1u, leaf_triangle, sides().facing, &beside)) return true;
    if (beside == 0) return false;
    auto query = any_within(rays_.tmax(i), sides(i));
    finish_beside(ray, query);
    rays_.tmax(i) = ended;
    return query.found;
  }
  // A ray that came to a triangle beside it goes on alone.
  template <class Query>
  void finish_beside(const Ray& ray, Query& query) {
    Counters cost = counters();
    walk_beside<Test>(tree_, ray, query, cost);
  }
  // Leaves the triangles of a leaf that the masks see.
  std::uint32_t seen([[maybe_unused]] TreeReference leaf, std::uint32_t triangles) const {
    if constexpr (Sides::chooses)
      return lanes_but(no_primitive, triangles, TreeTriangles(tree_), leaf_triangle_of(leaf, 0));
    return triangles;
  }
  FloatMask<stream_lanes> not_skipped(std::uint32_t leaf_triangle, StreamFloats skipped) const {
    const StreamBits primitive(TreeTriangles(tree_).primitive(leaf_triangle));
    return ~equal_words(as<std::uint32_t>(skipped), primitive);
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
  void test_triangles(const LeafBlock<Test::floats>& block, const Screen& screen, std::uint32_t triangles,
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
      this->store_certain(
          test_screened(rays, packed[6], screen, triangles, leaf_triangle_of(leaf, 0), list, active, left),
          left, list);
    } else if constexpr (only_decides) {
      find_any(unpack_rays<Test>(packed), block, std::bit_width(triangles), list, active, left);
    } else {
      find_nearest(unpack_rays<Test>(packed), block, std::bit_width(triangles), list, active, left);
    }
  }
  // length_or_skipped: of packed rays.
  std::uint32_t test_screened(const RayLanes<StreamFloats>& rays, StreamFloats length_or_skipped,
                              const LeafScreen& screen, std::uint32_t triangles, std::uint32_t leaf_triangle,
                              const ListEntry* list, std::uint32_t active, State& left) {
    const bool may_skip = Sides::chooses && needs_.skip != nullptr;
    return this->classify_triangles(rays, may_skip ? length_above(rays.direction) : length_or_skipped, screen,
                                    triangles, leaf_triangle, list, active, left,
                                    may_skip ? &length_or_skipped : nullptr);
  }
  void test_columns(const StreamColumns& columns, std::uint32_t first, std::uint32_t lanes,
                    const LeafScreen& screen, std::uint32_t triangles, std::uint32_t leaf_triangle) {
    const auto column = [&](int k) { return StreamFloats::load(columns.packed[k] + first); };
    const RayLanes<StreamFloats> rays{{column(0), column(1), column(2)}, {column(3), column(4), column(5)}};
    State left{};
    left.tmin = StreamFloats::load(columns.row[6] + first);
    left.tmax = StreamFloats::load(rays_.first_tmax + first);
    if constexpr (!only_decides) {
      left.t_lo = StreamFloats::load(rays_.first_t_lo + first);
      left.leaf_triangle = as<float>(StreamBits::load(rays_.leaf_triangle + first));
    }
    const ListEntry* const list = few_indices.of + first;
    const std::uint32_t found =
        test_screened(rays, column(6), screen, triangles, leaf_triangle, list, lanes, left);
    if constexpr (only_decides) {
      this->store_certain(found, left, list);
    } else {
      left.tmax.store(rays_.first_tmax + first), left.t_lo.store(rays_.first_t_lo + first);
      as<std::uint32_t>(left.leaf_triangle).store(rays_.leaf_triangle + first);
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
