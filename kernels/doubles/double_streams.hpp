// Batches of rays of doubles as streams: nodes by floats in the frame of the tree, leaves by the screen on doubles.
#pragma once

#include "../exact/leaf_screen.hpp"
#include "../traverse/streams.hpp"
#include "doubles_one_by_one.hpp"
#include "doubles_together.hpp"

namespace raylanes {
namespace {

// A usual ray times powers of two, exactly: the origin by that of the frame, the direction to a largest component of 1
// to 2, and t by both.
struct ScaledRay {
  double origin[3], tmin, direction[3], tmax;
};
// The lower bound of the best hit's t, which is scaled, and by what.
struct ScaledEnd {
  double t_lo, scale;

  float end_of(double t) const { return rounded_up(t * scale); }
};

struct DoubleStreamBatch : DoublesTogether {
  ScaledRay* scaled;  // of the rays of the octant that is traced
  ScaledEnd* ends;

  // A ray as streams take it; of one that goes alone no number.
  void move(std::size_t number, Ray& ray) const {
    const RayD& world = doubles[number];
    const FrameRay frame(*tree, world, world.tmin);
    ray = frame.ray;
    if (!frame.may_hit || !frame.is_usual())
      ray.direction = Float3{}, ray.tmin = std::numeric_limits<float>::quiet_NaN();
  }
};

// As StreamLeaves.
template <bool only_decides>
class DoubleStreamLeaves
    : public StreamOctant<NoCounters>,
      ScreenedRays<DoubleStreamLeaves<only_decides>, Doubles<double_lanes>, only_decides> {
  static constexpr int N = double_lanes;
  using V = Doubles<N>;
  using Screened = ScreenedRays<DoubleStreamLeaves, V, only_decides>;
  friend Screened;

 public:
  DoubleStreamLeaves(const TreeView& tree, const DoubleStreamBatch& batch)
      : StreamOctant(calls_of<DoubleStreamLeaves>, {.only_decides = only_decides}, tree, batch),
        batch_(batch),
        triangles_(*batch.tree),
        power_(batch.tree->frame.power) {}

  void begin() {
    for (std::uint32_t i = 0; i < rays_.size; ++i) take(i);
  }
  void trace_single(std::size_t number) { batch_.trace_single(number); }
  void move(std::size_t number, Ray& to) const { batch_.move(number, to); }
  void prefetch_leaf(TreeReference leaf) const { triangles_.prefetch_leaf(leaf_of(leaf)); }
  // The numbers of the best hits.
  [[gnu::noinline, gnu::flatten]] void store_results() {
    for (std::uint32_t i = 0; i < rays_.size && !only_decides; i += N) {
      const RayD* rays[N];
      HitD spare, *hits[N];
      std::uint32_t winners[N];
      prefetch_results(i + N);
      for (std::uint32_t lane = 0; lane < N; ++lane) {
        const bool is_ray = i + lane < rays_.size;
        const std::uint32_t number = rays_.number[is_ray ? i + lane : i];
        rays[lane] = batch_.doubles + number, hits[lane] = is_ray ? batch_.hits + number : &spare;
        winners[lane] = is_ray ? rays_.leaf_triangle[i + lane] : no_leaf_triangle;
      }
      known_hits(triangles_, rays, winners, hits);
    }
  }

  [[gnu::noinline, gnu::flatten]] void visit_leaf(TreeReference leaf, const ListEntry* list,
                                                  std::uint32_t size) {
    const LeafReference of = leaf_of(leaf);
    const std::uint32_t first = DoubleTriangles::first_of(of), lanes = DoubleTriangles::lanes(first);
    const double* const numbers = triangles_.numbers(first);
    const auto row = [&](int k) { return numbers + static_cast<std::uint32_t>(k) * lanes; };
    const std::uint32_t triangles =
        lanes_but(no_primitive, first_lanes<tree_width>(of.size), triangles_, first);
    if (triangles == 0) return;
    const LeafScreenOf<double> screen(row, static_cast<int>(of.size), static_cast<double>(farthest_),
                                      power_of_two(power_));
    for (std::uint32_t i = 0; i < size; i += N) test_triangles(screen, triangles, first, list + i, size - i);
  }

  [[gnu::noinline, gnu::flatten]] void trace_singly(TreeReference from, const ListEntry* list,
                                                    std::uint32_t size) {
    each_single(from, list, size,
                [this](const TreeView& below, const SingleBoxes& boxes, std::uint32_t i, NoCounters& cost) {
                  trace_single_below(below, boxes, i, cost);
                });
  }

 private:
  using State = typename Screened::State;

  HitRule sides() const { return HitRule(batch_); }
  MaskOf<V> not_skipped(std::uint32_t leaf_triangle, V skipped) const {
    return ~(skipped == V(static_cast<double>(triangles_.primitive(leaf_triangle))));
  }

  // A ray that goes on alone below a node.
  void trace_single_below(const TreeView& below, const SingleBoxes& boxes, std::uint32_t i,
                          NoCounters& cost) {
    const RayD& ray = world(i);
    const DoubleLeaves leaves(*batch_.tree, ray, finite_tmin(ray.tmin));
    const auto search_below = [&](auto& query) {
      walk_nodes(below, boxes, query, cost, [&](TreeReference leaf) { return leaves.visit(leaf, query); });
    };
    if constexpr (only_decides) {
      AnyDouble query(ray, rays_.rows[i].tmax,
                      DoubleHitRule(batch_.facing, skipped_by(batch_, rays_.number[i])));
      search_below(query);
      if (query.found) end_ray(i);
    } else {
      const HitsAfter<HitD> rule{before_all_doubles, batch_.facing, skipped_by(batch_, rays_.number[i])};
      NearestDouble<HitsAfter<HitD>, ScaledEnd> query(candidate_of(i), batch_.ends[i], rule,
                                                      rays_.rows[i].tmax);
      search_below(query);
      keep_unscaled(i, query);
    }
  }

  // Asks for what the winners from there on will need.
  void prefetch_results(std::uint32_t first) const {
    for (std::uint32_t i = first; i < first + N && i < rays_.size; ++i) {
      __builtin_prefetch(&world(i));
      if (rays_.leaf_triangle[i] != no_leaf_triangle) triangles_.prefetch(rays_.leaf_triangle[i]);
    }
  }
  const RayD& world(std::uint32_t i) const { return batch_.doubles[rays_.number[i]]; }

  void take(std::uint32_t i) {
    const RayD& ray = world(i);
    const int exponent = exponent_of_largest(ray.direction);
    const double of_origin = power_of_two(power_), of_direction = power_of_two(-exponent),
                 of_t = power_of_two(power_ + exponent);
    ScaledRay& scaled = batch_.scaled[i];
    for (std::size_t k = 0; k < 3; ++k)
      scaled.origin[k] = ray.origin[k] * of_origin, scaled.direction[k] = ray.direction[k] * of_direction;
    // No hit is farther than 2^100 in the frame.
    const double end = finite_tmax(ray.tmax) * of_t;
    scaled.tmin = ray.tmin * of_t, scaled.tmax = end < 0x1p100 ? end : 0x1p100;
    batch_.ends[i] = {scaled.tmax, of_t}, rays_.leaf_triangle[i] = no_leaf_triangle;
  }

  // A register of rays, or the first `size`, against all triangles of a leaf.
  void test_triangles(const LeafScreenOf<double>& screen, std::uint32_t triangles, std::uint32_t first,
                      const ListEntry* list, std::uint32_t size) {
    const void* rows[N];
    double t_lo[N], skipped[N];
    for (int lane = 0; lane < N; ++lane) {
      const std::uint32_t i = index_of(list[lane]);
      rows[lane] = batch_.scaled + i, t_lo[lane] = batch_.ends[i].t_lo;
      if (batch_.skip != nullptr) skipped[lane] = batch_.skip[rays_.number[i]];
    }
    V row[row_floats];
    load_rows(rows, row);
    State left{};
    left.tmin = row[3], left.tmax = row[7];
    if constexpr (!only_decides) left.t_lo = V::load(t_lo);
    const RayLanes<V> rays{vec3(row), vec3(row + 4)};
    V length =
        multiply_add<Grade::fast>((abs(row[4]) + abs(row[5])) + abs(row[6]), V(1.0 + 0x1p-20), V(0x1p-45));
    V skipped_by_rays(0.0);
    if (batch_.skip != nullptr) skipped_by_rays = V::load(skipped);
    const std::uint32_t found =
        this->classify_triangles(rays, length, screen, triangles, first, list, first_lanes<N>(size), left,
                                 batch_.skip != nullptr ? &skipped_by_rays : nullptr);
    this->store_certain(found, left, list);
  }

  void keep(std::uint32_t i, double t_lo, double t_hi, std::uint32_t leaf_triangle) {
    rays_.rows[i].tmax = rounded_up(t_hi);
    batch_.ends[i].t_lo = t_lo, batch_.scaled[i].tmax = t_hi, rays_.leaf_triangle[i] = leaf_triangle;
  }
  // Not scaled; and back, with room for what is flushed.
  DoubleCandidate candidate_of(std::uint32_t i) const {
    DoubleCandidate best(world(i));
    if (rays_.leaf_triangle[i] != no_leaf_triangle)
      best.keep(batch_.ends[i].t_lo / batch_.ends[i].scale, batch_.scaled[i].tmax / batch_.ends[i].scale,
                rays_.leaf_triangle[i]);
    return best;
  }
  void keep_unscaled(std::uint32_t i, const DoubleCandidate& best) {
    if (best.leaf_triangle == no_leaf_triangle) return;
    const double scale = batch_.ends[i].scale;
    keep(i, best.t_lo * scale - 0x1p-500, best.tmax * scale + 0x1p-500, best.leaf_triangle);
  }
  DoubleCandidate compared(std::uint32_t i, std::uint32_t leaf_triangle) {
    DoubleCandidate best = candidate_of(i);
    compare_exactly(triangles_, world(i), leaf_triangle, best, sides());
    keep_unscaled(i, best);
    best.keep(batch_.ends[i].t_lo, batch_.scaled[i].tmax, rays_.leaf_triangle[i]);
    return best;
  }
  bool is_hit(std::uint32_t i, std::uint32_t leaf_triangle) const {
    return any_exact_hit(triangles_, world(i), 1u, leaf_triangle, batch_.facing);
  }
  // Nothing enters a box before −infinity.
  void end_ray(std::uint32_t i) {
    rays_.rows[i].tmax = -std::numeric_limits<float>::infinity();
    batch_.occluded[rays_.number[i]] = 1;
  }

  const DoubleStreamBatch& batch_;
  DoubleTriangles triangles_;
  int power_;
};

constexpr std::size_t scaled_rays_of(std::size_t rays) {
  return OctantScratch::full_at(rays) + 2 * stream_lanes;
}
constexpr std::size_t bytes_of_octants(std::size_t rays) {
  return (OctantScratch::bytes(rays) + 63) / 64 * 64;
}
constexpr std::size_t double_stream_bytes(std::size_t rays) {
  return bytes_of_octants(rays) + scaled_rays_of(rays) * (sizeof(ScaledRay) + sizeof(ScaledEnd));
}

template <bool only_decides>
void stream_doubles(const DoubleTreeView& tree, const DoubleBatch& batch) {
  // An origin is rounded once to the frame's floats, a component of the direction, too.
  TreeView nodes = tree.tree;
  nodes.origin_share = 2.02f * 0x1p-24f;
  DoubleStreamBatch rays{{tree, batch}, nullptr, nullptr};
  rays.scaled =
      reinterpret_cast<ScaledRay*>(static_cast<std::byte*>(batch.scratch) + bytes_of_octants(batch.size));
  rays.ends = reinterpret_cast<ScaledEnd*>(rays.scaled + scaled_rays_of(batch.size));
  if constexpr (only_decides) __builtin_memset(batch.occluded, 0, batch.size);
  DoubleStreamLeaves<only_decides> leaves(nodes, rays);
  Streams(leaves, batch.scratch).trace();
}
// Hits after others are found by single rays.
[[maybe_unused]] void closest_double_stream(const DoubleTreeView& tree, const DoubleBatch& batch) {
  batch.after == nullptr&& tree.tree.root != empty_reference ? stream_doubles<false>(tree, batch)
                                                             : closest_doubles(tree, batch);
}
[[maybe_unused]] void any_double_stream(const DoubleTreeView& tree, const DoubleBatch& batch) {
  tree.tree.root != empty_reference ? stream_doubles<true>(tree, batch) : any_double(tree, batch);
}

}  // namespace
}  // namespace raylanes
