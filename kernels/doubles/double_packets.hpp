// Rays of doubles that share an origin, or end at a point, as packets: nodes and frusta by floats in the frame of the
// tree, triangles by planes in doubles, and by the ray itself where planes do not decide.
#pragma once

#include "../traverse/packet/apex_triangles.hpp"
#include "../traverse/packet/packet_walk.hpp"
#include "packet_moves.hpp"

namespace raylanes {
namespace {

// A row for each vector of rays, a lane a ray.
struct alignas(64) DoublePacketRays : PacketRays {
  static constexpr int N = W == 1 ? 1 : W / 2;
  using V = Doubles<N>;
  using Words = Lanes<std::uint64_t, N>;
  struct Doubled {
    double slope_x[W], slope_y[W], size_z[W];  // as in PacketRays
    double begin[W], t_lo[W], end[W];          // t of the user's ray
    double scale[W];                           // of t, in the frame
    std::uint64_t leaf_triangle[W];
  };
  Doubled doubled[max_vectors];

  void begin(const DoublePacketBatch& batch, int row, const PacketFrame& frame) {
    constexpr std::uint64_t exponent_bits = 0x7ff0000000000000ull;
    Doubled& to = doubled[row];
    for (int first = 0; first < W; first += N) {
      const void* rows[N];
      for (int lane = 0; lane < N; ++lane) rows[lane] = batch.doubles + index(row, first + lane);
      V numbers[row_floats];
      load_rows(rows, numbers);
      batch.look_from_apex(numbers);
      const V* const d = numbers + 4;
      V z = d[frame.axes.order[2]] * V(static_cast<double>(frame.sign));
      V largest = max(max(abs(d[0]), abs(d[1])), abs(d[2]));
      (d[frame.axes.order[0]] / z).store(to.slope_x + first);
      (d[frame.axes.order[1]] / z).store(to.slope_y + first);
      (z * V(batch.scale)).store(to.size_z + first);
      (as<double>(as<std::uint64_t>(largest) & Words(exponent_bits)) * V(batch.scale))
          .store(to.scale + first);
      V end = min(numbers[7], V(largest_double)), error(batch.t_error());
      (numbers[3] - error).store(to.begin + first);
      (end - error).store(to.t_lo + first), (end + error).store(to.end + first);
      Words(no_leaf_triangle).store(to.leaf_triangle + first);
    }
  }
  RayState<V, false> state(int row, int first) const {
    const Doubled& of = doubled[row];
    return {{{V::load(of.begin + first), V::load(of.end + first)}, V::load(of.t_lo + first)},
            as<double>(Words::load(of.leaf_triangle + first))};
  }
  void keep(int row, int first, std::uint32_t lanes, const Verdict<V, MaskOf<V>>& decided,
            std::uint32_t leaf_triangle) {
    Doubled& of = doubled[row];
    auto kept = state(row, first);
    kept.keep(MaskOf<V>::from_bits(lanes), decided.t_lo, decided.t_hi,
              as<double>(Words(std::uint64_t{leaf_triangle})));
    kept.t_lo.store(of.t_lo + first), kept.tmax.store(of.end + first);
    as<std::uint64_t>(kept.leaf_triangle).store(of.leaf_triangle + first);
  }
  // The ends in the frame, rounded up, after that.
  void shorten(int row) {
    const Doubled& of = doubled[row];
    const auto end = [&](int first) {
      return rounded_up_in_frame(V::load(of.end + first), V::load(of.scale + first));
    };
    floats_of<W>(end, N).store(tmax[row]);
  }
  DoubleCandidate candidate(int row, int lane, const RayD& ray) const {
    DoubleCandidate best(ray);
    best.keep(doubled[row].t_lo[lane], doubled[row].end[lane], winner(row, lane));
    return best;
  }
  void keep(int row, int lane, const DoubleCandidate& best) {
    Doubled& of = doubled[row];
    of.t_lo[lane] = best.t_lo, of.end[lane] = best.tmax, of.leaf_triangle[lane] = best.leaf_triangle;
    shorten(row);
  }
  std::uint32_t winner(int row, int lane) const {
    return static_cast<std::uint32_t>(doubled[row].leaf_triangle[lane]);
  }
};

struct DoubleEntry : StackEntry {
  static constexpr bool leaves_have_corners = false;
};

// Closest and any: one code serves both.
class DoublePacketLeaves : public PacketWalk<SharedApex::origin, NoCounters, DoubleEntry> {
  static constexpr int N = DoublePacketRays::N;
  using V = DoublePacketRays::V;
  using Planes = EdgePlanes<Exact<Grade::fast>, double>;

 public:
  DoublePacketLeaves(const TreeView& tree, const DoublePacketBatch& batch, DoublePacketRays& rays,
                     const ApexOfRays<SharedApex::origin>& of)
      : PacketWalk(calls_of<DoublePacketLeaves>, tree, batch, rays, of, batch.size, nullptr, 0.0f),
        batch_(batch),
        rays_(rays),
        triangles_(*batch.tree) {}

  void begin() {
    for (std::size_t k = 0; k < 3; ++k)
      apex_[k] = batch_.apex[static_cast<std::size_t>(frame_.axes.order[k])] * batch_.scale;
    frame_.apex_offset = frame_.past = batch_.apex_offset();
    for (int row = 0; row < rays_.vectors; ++row) {
      rays_.begin(batch_, row, frame_);
      if (batch_.skip != nullptr) rays_.set_skipped(row, batch_.skip);
    }
  }
  void trace_single(std::size_t index) { batch_.trace_single(index); }
  void prefetch_leaf(TreeReference leaf) { triangles_.prefetch_leaf(leaf_of(leaf)); }

  [[gnu::noinline, gnu::flatten]] void visit_leaf(const DoubleEntry& at) {
    const LeafReference leaf = leaf_of(at.reference);
    const std::uint32_t first = DoubleTriangles::first_of(leaf), lanes = DoubleTriangles::lanes(first);
    const double* const numbers = triangles_.numbers(first);
    const auto size = static_cast<int>(leaf.size);
    std::uint32_t some = lanes_but(no_primitive, first_lanes<tree_width>(leaf.size), triangles_, first);
    const Planes planes(frame_, apex_, size, [&](int k, int i) {
      using Row = Doubles<leaf_lanes<double>>;
      return Row::load(numbers + static_cast<std::uint32_t>(k) * lanes + i) * Row(batch_.scale);
    });
    std::uint32_t single[max_vectors], with_single = 0;
    some &=
        ~planes.plain | admitted_lanes(batch_.facing, ~0u, batch_.ends_there ? planes.away : ~planes.away);
    std::uint32_t hit = each_met(planes, some, at.vectors, [&](int triangle, int row) {
      const std::uint32_t undecided =
          test_vector(planes, triangle, row, first + static_cast<std::uint32_t>(triangle));
      if (undecided != 0)
        single[row] = undecided | (with_single >> row & 1u ? single[row] : 0u), with_single |= 1u << row;
      return changed_;
    });
    for (std::uint32_t vectors = with_single; vectors != 0; vectors &= vectors - 1) {
      const int row = std::countr_zero(vectors);
      for (std::uint32_t rays = single[row] & rays_.active[row]; rays != 0; rays &= rays - 1)
        visit_single(at.reference, row, std::countr_zero(rays));
    }
    refresh(hit | with_single);
  }
  [[gnu::noinline, gnu::flatten]] void trace_rays(const DoubleEntry& at) {
    each_single(at, [this](const TreeView& below, int row, int lane) {
      DoubleTreeView from_there = *batch_.tree;
      from_there.tree = below;
      search_single(from_there, row, lane);
    });
  }
  void store_results() {
    for (int row = 0; row < rays_.vectors; ++row)
      if (batch_.only_decides())
        store_decisions(batch_.occluded, rays_, row);
      else
        store_hits(row);
  }

 private:
  // Returns the rays that the planes do not decide.
  std::uint32_t test_vector(const Planes& planes, int triangle, int row, std::uint32_t leaf_triangle) {
    std::uint32_t undecided = 0, certain = 0;
    const bool is_plain = (planes.plain >> triangle & 1u) != 0;
    const std::uint32_t active = rays_for(leaf_triangle, row);
    for (int first = 0; first < W; first += N) {
      const auto& of = rays_.doubled[row];
      V x = V::load(of.slope_x + first), y = V::load(of.slope_y + first);
      V side = planes.side(triangle, x, y);
      const std::uint32_t rays = bits(side >= V(planes.bound(triangle))) & active >> first;
      if (!is_plain) {
        undecided |= rays << first;
        continue;
      }
      const auto range = rays_.state(row, first);
      auto surely = range;
      surely.tmin = range.tmin + V(2 * batch_.t_error());
      const auto decided = planes.decide(triangle, side, x, y, V::load(of.size_z + first), range, surely);
      const std::uint32_t hit = bits(decided.certain) & rays;
      rays_.keep(row, first, hit, decided, leaf_triangle);
      undecided |= (bits(decided.undecided) & rays) << first, certain |= hit << first;
    }
    changed_ = certain != 0;
    if (changed_) rays_.shorten(row);
    if (batch_.only_decides()) rays_.active[row] &= ~certain;
    return undecided;
  }
  // The active rays that do not skip a triangle.
  std::uint32_t rays_for(std::uint32_t leaf_triangle, int row) const {
    if (batch_.skip == nullptr) return rays_.active[row];
    return rays_.active[row] & ~rays_.rays_that_skip(row, triangles_.primitive(leaf_triangle));
  }
  // A leaf, by the ray itself.
  [[gnu::noinline]] void visit_single(TreeReference leaf, int row, int lane) {
    DoubleTreeView from_there = *batch_.tree;
    from_there.tree.root = leaf;
    search_single(from_there, row, lane);
  }
  void search_single(const DoubleTreeView& below, int row, int lane) {
    const RayD& ray = batch_.doubles[rays_.index(row, lane)];
    const std::uint32_t skipped = batch_.skip != nullptr ? rays_.skipped[row][lane] : no_primitive;
    if (batch_.only_decides()) {
      if (hits_any(below, ray, DoubleHitRule(batch_.facing, skipped))) rays_.active[row] &= ~(1u << lane);
      return;
    }
    DoubleCandidate best = rays_.candidate(row, lane, ray);
    RayD rest = ray;
    rest.tmax = number_above(best.tmax);  // what rounds to one t is compared by its number
    const std::uint32_t nearest = nearest_triangle_by(below, rest, batch_.facing, skipped);
    if (nearest == no_leaf_triangle) return;
    compare_exactly(triangles_, ray, nearest, best);
    rays_.keep(row, lane, best);
  }
  [[gnu::noinline, gnu::flatten]] void store_hits(int row) {
    for (int first = 0; first < W; first += N) {
      const RayD* rays[N];
      HitD spare, *hits[N];
      std::uint32_t winners[N];
      for (int i = 0; i < N; ++i) {
        const int lane = first + i;
        const std::size_t index = rays_.index(row, lane);
        const bool is_ray = (rays_.occupied[row] >> lane & 1u) != 0;
        rays[i] = batch_.doubles + index, hits[i] = is_ray ? batch_.hits + index : &spare;
        winners[i] = is_ray ? rays_.winner(row, lane) : no_leaf_triangle;
      }
      known_hits(triangles_, rays, winners, hits);
    }
  }

  const DoublePacketBatch& batch_;
  DoublePacketRays& rays_;
  DoubleTriangles triangles_;
  std::array<double, 3> apex_;
  bool changed_ = false;  // by the vector that was tested last
};

constexpr std::size_t moved_rays_at = (sizeof(PacketScratch<DoublePacketRays>) + 63) / 64 * 64;
constexpr std::size_t double_packet_bytes(std::size_t rays) {
  return moved_rays_at + ((rays < max_sorted_rays ? rays : max_sorted_rays) + W) * sizeof(Ray);
}

// Rays that share the first one's origin, or end at a point; others are traced singly.
[[maybe_unused]] void packet_doubles(const DoubleTreeView& tree, const DoubleBatch& batch) {
  const bool ends_there = batch.shared_point == SharedApex::end;
  const Double3 apex = ends_there ? batch.shared_end : batch.rays[0].origin;
  const FrameRay probe(tree, {apex, 0.0, {1.0, 0.0, 0.0}, 1.0}, 0.0);
  const bool is_shared = probe.may_hit && probe.is_usual();
  DoublePacketBatch rays{{tree, batch}, apex, is_shared ? power_of_two(tree.frame.power) : 0.0, ends_there};
  TreeView nodes = tree.tree;
  nodes.padding = probe.more;
  auto& scratch = *static_cast<PacketScratch<DoublePacketRays>*>(batch.scratch);
  auto* const moved = reinterpret_cast<Ray*>(static_cast<std::byte*>(batch.scratch) + moved_rays_at);
  rays.rays = moved;
  for (std::size_t left = batch.size; left != 0; left -= rays.size) {
    rays.size = left < max_sorted_rays ? left : max_sorted_rays;
    if (is_shared) {
      for (std::size_t i = 0; i < rays.size; i += W) move_rays(rays, probe.ray.origin, i, rays.size, moved);
      DoublePacketLeaves(nodes, rays, scratch.rays, {probe.ray.origin, reach(probe.ray, nodes.bounds)})
          .trace(scratch.order);
    } else {
      for (std::size_t i = 0; i < rays.size; ++i) rays.trace_single(i);
    }
    rays.doubles += rays.size;
    if (rays.skip != nullptr) rays.skip += rays.size;
    if (rays.only_decides())
      rays.occluded += rays.size;
    else
      rays.hits += rays.size;
  }
}

}  // namespace
}  // namespace raylanes
