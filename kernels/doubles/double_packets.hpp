// Rays of doubles that share an origin, as packets: nodes and frusta by floats in the frame of the tree, triangles by
// planes in doubles, and by the ray itself where planes do not decide.
#pragma once

#include "../traverse/packet/edge_planes.hpp"
#include "../traverse/packet/packets.hpp"
#include "packet_moves.hpp"

namespace raylanes {
namespace {

// By group, a lane a ray.
struct alignas(64) DoublePacketRays : RaysInGroups {
  static constexpr int N = group_lanes == 1 ? 1 : group_lanes / 2;
  using V = Doubles<N>;
  using Words = Lanes<std::uint64_t, N>;
  struct Doubled {
    double slope_x[group_lanes], slope_y[group_lanes], size_z[group_lanes];  // as in RaysInGroups
    double begin[group_lanes], t_lo[group_lanes], end[group_lanes];          // t of the user's ray
    double scale[group_lanes];                                               // of t, in the frame
    std::uint64_t leaf_triangle[group_lanes];
  };
  Doubled doubled[max_groups];

  void begin(const DoublePacketBatch& batch, int g, const PacketFrame& frame) {
    constexpr std::uint64_t exponent_bits = 0x7ff0000000000000ull;
    Doubled& to = doubled[g];
    for (int first = 0; first < group_lanes; first += N) {
      const void* rows[N];
      for (int lane = 0; lane < N; ++lane) rows[lane] = batch.doubles + number(g, first + lane);
      V row[row_floats];
      load_rows(rows, row);
      const V* const d = row + 4;
      V z = d[frame.axes.order[2]] * V(static_cast<double>(frame.sign));
      V largest = max(max(abs(d[0]), abs(d[1])), abs(d[2]));
      (d[frame.axes.order[0]] / z).store(to.slope_x + first);
      (d[frame.axes.order[1]] / z).store(to.slope_y + first);
      (z * V(batch.scale)).store(to.size_z + first);
      (as<double>(as<std::uint64_t>(largest) & Words(exponent_bits)) * V(batch.scale))
          .store(to.scale + first);
      V end = min(row[7], V(largest_double));
      row[3].store(to.begin + first), end.store(to.t_lo + first), end.store(to.end + first);
      Words(no_leaf_triangle).store(to.leaf_triangle + first);
    }
  }
  RayState<V, false> state(int g, int first) const {
    const Doubled& of = doubled[g];
    return {{{V::load(of.begin + first), V::load(of.end + first)}, V::load(of.t_lo + first)},
            as<double>(Words::load(of.leaf_triangle + first))};
  }
  void keep(int g, int first, std::uint32_t lanes, const FilterResult<V, MaskOf<V>>& decided,
            std::uint32_t leaf_triangle) {
    Doubled& of = doubled[g];
    auto kept = state(g, first);
    kept.keep(MaskOf<V>::from_bits(lanes), decided.t_lo, decided.t_hi,
              as<double>(Words(std::uint64_t{leaf_triangle})));
    kept.t_lo.store(of.t_lo + first), kept.tmax.store(of.end + first);
    as<std::uint64_t>(kept.leaf_triangle).store(of.leaf_triangle + first);
  }
  // The ends in the frame, rounded up, after that.
  void shorten(int g) {
    const Doubled& of = doubled[g];
    const auto end = [&](int first) {
      return rounded_up_in_frame(V::load(of.end + first), V::load(of.scale + first));
    };
    floats_of<group_lanes>(end, N).store(tmax[g]);
  }
  DoubleCandidate candidate(int g, int lane, const RayD& ray) const {
    DoubleCandidate best(ray);
    best.keep(doubled[g].t_lo[lane], doubled[g].end[lane], winner(g, lane));
    return best;
  }
  void keep(int g, int lane, const DoubleCandidate& best) {
    Doubled& of = doubled[g];
    of.t_lo[lane] = best.t_lo, of.end[lane] = best.tmax, of.leaf_triangle[lane] = best.leaf_triangle;
    shorten(g);
  }
  std::uint32_t winner(int g, int lane) const {
    return static_cast<std::uint32_t>(doubled[g].leaf_triangle[lane]);
  }
};

// As PacketLeaves, whatever is asked: one code serves both.
class DoublePacketLeaves : public PacketGroups<SharedApex::origin, NoCounters> {
  static constexpr int N = DoublePacketRays::N;
  using V = DoublePacketRays::V;

 public:
  DoublePacketLeaves(const TreeView& tree, const DoublePacketBatch& batch, DoublePacketRays& rays)
      : PacketGroups(calls_of<DoublePacketLeaves>, tree, batch, rays, nullptr, 0.0f),
        batch_(batch),
        rays_(rays),
        triangles_(*batch.tree) {}

  void begin() {
    for (std::size_t k = 0; k < 3; ++k)
      apex_[k] = batch_.origin[static_cast<std::size_t>(frame_.axes.order[k])] * batch_.scale;
    for (int g = 0; g < rays_.groups; ++g) rays_.begin(batch_, g, frame_);
  }
  void trace_single(std::size_t number) { batch_.trace_alone(number); }

  [[gnu::noinline, gnu::flatten]] void visit_leaf(const WaitingGroups& at) {
    const LeafReference leaf = leaf_of(at.reference);
    const std::uint32_t first = DoubleTriangles::first_of(leaf), lanes = DoubleTriangles::lanes(first);
    const double* const numbers = triangles_.numbers(first);
    const auto size = static_cast<int>(leaf.size);
    const Planes planes(frame_, apex_, size, [&](int k, int i) {
      using Row = Doubles<leaf_lanes<double>>;
      return Row::load(numbers + static_cast<std::uint32_t>(k) * lanes + i) * Row(batch_.scale);
    });
    std::uint32_t alone[max_groups], with_alone = 0;
    std::uint32_t hit = each_met(planes, size, at.groups, [&](int triangle, int g) {
      const std::uint32_t undecided =
          test_group(planes, triangle, g, first + static_cast<std::uint32_t>(triangle));
      if (undecided != 0)
        alone[g] = undecided | (with_alone >> g & 1u ? alone[g] : 0u), with_alone |= 1u << g;
      return changed_;
    });
    for (std::uint32_t groups = with_alone; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      for (std::uint32_t rays = alone[g] & rays_.going[g]; rays != 0; rays &= rays - 1)
        visit_alone(at.reference, g, std::countr_zero(rays));
    }
    refresh(hit | with_alone);
  }
  void prefetch_leaf(TreeReference leaf) const { triangles_.prefetch_leaf(leaf_of(leaf)); }

  [[gnu::noinline, gnu::flatten]] void trace_alone(const WaitingGroups& at) {
    each_lone(at, [this](const TreeView& below, int g, int lane) { trace_lone(below, g, lane); });
  }
  void trace_lone(const TreeView& below, int g, int lane) {
    DoubleTreeView from_there = *batch_.tree;
    from_there.tree = below;
    search_alone(from_there, g, lane);
  }
  void store_results() {
    for (int g = 0; g < rays_.groups; ++g)
      if (batch_.only_decides())
        store_decisions(batch_.occluded, rays_, g);
      else
        store_hits(g);
  }

 private:
  using Planes = EdgePlanes<Exact<Grade::fast>, double>;

  // Returns the rays that the planes do not decide.
  std::uint32_t test_group(const Planes& planes, int triangle, int g, std::uint32_t leaf_triangle) {
    std::uint32_t undecided = 0, certain = 0;
    const bool is_plain = (planes.plain >> triangle & 1u) != 0;
    for (int first = 0; first < group_lanes; first += N) {
      const auto& of = rays_.doubled[g];
      V x = V::load(of.slope_x + first), y = V::load(of.slope_y + first);
      V side = planes.side(triangle, x, y);
      const std::uint32_t rays = bits(side >= V(planes.bound(triangle))) & rays_.going[g] >> first;
      if (!is_plain) {
        undecided |= rays << first;
        continue;
      }
      const auto range = rays_.state(g, first);
      const auto decided = planes.decide(triangle, side, x, y, V::load(of.size_z + first), range, range);
      const std::uint32_t hit = bits(decided.certain) & rays;
      rays_.keep(g, first, hit, decided, leaf_triangle);
      undecided |= (bits(decided.undecided) & rays) << first, certain |= hit << first;
    }
    changed_ = certain != 0;
    if (changed_) rays_.shorten(g);
    if (batch_.only_decides()) rays_.going[g] &= ~certain;
    return undecided;
  }
  // A leaf, or what is below a node, by the ray itself.
  [[gnu::noinline]] void visit_alone(TreeReference leaf, int g, int lane) {
    DoubleTreeView from_there = *batch_.tree;
    from_there.tree.root = leaf;
    search_alone(from_there, g, lane);
  }
  void search_alone(const DoubleTreeView& below, int g, int lane) {
    const RayD& ray = batch_.doubles[rays_.number(g, lane)];
    if (batch_.only_decides()) {
      if (hits_any(below, ray)) rays_.going[g] &= ~(1u << lane);
      return;
    }
    DoubleCandidate best = rays_.candidate(g, lane, ray);
    RayD rest = ray;
    rest.tmax = number_above(best.tmax);  // what rounds to one t is compared by its number
    const std::uint32_t nearest = nearest_triangle_of_ray(below, rest);
    if (nearest == no_leaf_triangle) return;
    compare_exactly(triangles_, ray, nearest, best);
    rays_.keep(g, lane, best);
  }
  [[gnu::noinline, gnu::flatten]] void store_hits(int g) {
    for (int first = 0; first < group_lanes; first += N) {
      const RayD* rays[N];
      HitD spare, *hits[N];
      std::uint32_t winners[N];
      for (int i = 0; i < N; ++i) {
        const int lane = first + i;
        const std::size_t number = rays_.number(g, lane);
        const bool is_ray = (rays_.taken[g] >> lane & 1u) != 0;
        rays[i] = batch_.doubles + number, hits[i] = is_ray ? batch_.hits + number : &spare;
        winners[i] = is_ray ? rays_.winner(g, lane) : no_leaf_triangle;
      }
      known_hits(triangles_, rays, winners, hits);
    }
  }

  const DoublePacketBatch& batch_;
  DoublePacketRays& rays_;
  DoubleTriangles triangles_;
  std::array<double, 3> apex_;
  bool changed_ = false;  // by the group that was tested last
};

constexpr std::size_t moved_rays_at = (sizeof(PacketScratch<DoublePacketRays>) + 63) / 64 * 64;
constexpr std::size_t double_packet_bytes(std::size_t rays) {
  return moved_rays_at + ((rays < max_sorted_rays ? rays : max_sorted_rays) + group_lanes) * sizeof(Ray);
}

// Rays that share the first one's origin; others go alone.
[[maybe_unused]] void packet_doubles(const DoubleTreeView& tree, const DoubleBatch& batch) {
  const Double3& origin = batch.rays[0].origin;
  const FrameRay probe(tree, {origin, 0.0, {1.0, 0.0, 0.0}, 1.0}, 0.0);
  const bool is_shared = probe.may_hit && probe.is_usual();
  DoublePacketBatch rays{{tree, batch}, origin, is_shared ? power_of_two(tree.frame.power) : 0.0};
  TreeView nodes = tree.tree;
  nodes.padding = probe.more;
  auto& scratch = *static_cast<PacketScratch<DoublePacketRays>*>(batch.scratch);
  auto* const moved = reinterpret_cast<Ray*>(static_cast<std::byte*>(batch.scratch) + moved_rays_at);
  rays.rays = moved;
  for (std::size_t left = batch.size; left != 0; left -= rays.size) {
    rays.size = left < max_sorted_rays ? left : max_sorted_rays;
    if (is_shared) {
      for (std::size_t i = 0; i < rays.size; i += group_lanes)
        move_rays(rays, probe.ray.origin, i, rays.size, moved);
      DoublePacketLeaves leaves(nodes, rays, scratch.rays);
      Packets(leaves, scratch.order, rays.size, {probe.ray.origin, reach(probe.ray, nodes.bounds)}).trace();
    } else {
      for (std::size_t i = 0; i < rays.size; ++i) rays.trace_alone(i);
    }
    rays.doubles += rays.size;
    if (rays.only_decides())
      rays.occluded += rays.size;
    else
      rays.hits += rays.size;
  }
}

}  // namespace
}  // namespace raylanes
