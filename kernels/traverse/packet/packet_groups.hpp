// The state that the walk of a packet and its leaves share: groups of rays, and which of them may meet what.
// The walk is compiled once for all leaves, and calls these by a table.
#pragma once

#include "../node_test.hpp"
#include "chord_rays.hpp"
#include "culls.hpp"

namespace raylanes {
namespace {

// So many rays or fewer go on alone.
inline constexpr int max_lone_rays = 4;

// A waiting reference: for some groups, or for the few rays that a box is left with.
struct WaitingGroups {
  TreeReference reference;
  float near;  // where the box begins
  std::uint32_t groups;
  int lone_rays;
  std::uint16_t ray[max_lone_rays];  // group · lanes + lane
};

// A class of leaves derives from this one and says what becomes of hits. The same object serves one packet after the
// other.
template <SharedApex apex_, class Counters_, class Waiting_ = WaitingGroups>
class PacketGroups {
 public:
  static constexpr SharedApex apex = apex_;
  using Counters = Counters_;
  using Waiting = Waiting_;

  // The functions of the derived class.
  struct Calls {
    void (*begin)(PacketGroups&);  // all groups are there, not yet their ranges
    void (*visit_leaf)(PacketGroups&, const Waiting&);
    void (*trace_alone)(PacketGroups&, const Waiting&);       // the rays that are left go on alone
    void (*store_results)(PacketGroups&);                     // the walk has ended
    void (*trace_single)(PacketGroups&, std::size_t number);  // a ray of the batch that no packet takes
    void (*prefetch_leaf)(PacketGroups&, TreeReference);      // null: blocks of corners
  };
  template <class Leaves>
  static constexpr Calls calls_of = [] {
    Calls calls{};
    calls.begin = [](PacketGroups& of) { static_cast<Leaves&>(of).begin(); };
    calls.visit_leaf = [](PacketGroups& of, const Waiting& at) { static_cast<Leaves&>(of).visit_leaf(at); };
    calls.trace_alone = [](PacketGroups& of, const Waiting& at) { static_cast<Leaves&>(of).trace_alone(at); };
    calls.store_results = [](PacketGroups& of) { static_cast<Leaves&>(of).store_results(); };
    calls.trace_single = [](PacketGroups& of, std::size_t number) {
      static_cast<Leaves&>(of).trace_single(number);
    };
    if constexpr (requires(Leaves & leaves) { leaves.prefetch_leaf(TreeReference{}); })
      calls.prefetch_leaf = [](PacketGroups& of, TreeReference leaf) {
        static_cast<Leaves&>(of).prefetch_leaf(leaf);
      };
    return calls;
  }();

  // rounding: as in PacketFrame. hits: what leaves write to, null if nothing is to be prefetched.
  template <class Batch>
  PacketGroups(const Calls& calls, const TreeView& tree, const Batch& batch, Groups<apex>& groups,
               const Hit* hits, float rounding)
      : calls_(calls),
        tree_(tree),
        batch_rays_(batch.rays),
        batch_size_(batch.size),
        batch_hits_(hits),
        rounding_(rounding),
        counters_(batch),
        groups_(groups) {}

  const Counters& counters() const { return counters_; }

  // The boxes or triangles that some of the groups may meet: of one group alone by its own frustum, and then that is
  // all to ask.
  static bool is_one(std::uint32_t groups) {
    return apex != SharedApex::none && (groups & (groups - 1)) == 0;
  }
  template <class Shapes>
  std::uint32_t met_by_any(const Shapes& shapes, std::uint32_t groups) const {
    if constexpr (apex != SharedApex::none)
      return shapes.met_by(is_one(groups) ? groups_.frustum(std::countr_zero(groups)) : all_);
    else
      return shapes.met_by(all_);
  }
  template <class Shapes>
  std::uint32_t groups_met(const Shapes& shapes, int i, std::uint32_t groups) const {
    if (is_one(groups)) return groups;
    counters().frusta(groups, group_registers());
    return groups & shapes.groups_met(i, groups_);
  }
  // test(triangle, g) for the triangles of a leaf, and the groups that may meet one. Returns the groups for which it is
  // true.
  template <class Shapes, class Tests>
  std::uint32_t each_met(const Shapes& shapes, int size, std::uint32_t groups, Tests test) const {
    std::uint32_t hit = 0;
    for (std::uint32_t triangles = met_by_any(shapes, groups) & first_lanes<tree_width>(size); triangles != 0;
         triangles &= triangles - 1) {
      const int triangle = std::countr_zero(triangles);
      for (std::uint32_t met = groups_met(shapes, triangle, groups); met != 0; met &= met - 1) {
        const int g = std::countr_zero(met);
        counters().triangles(groups_.going[g]);
        hit |= std::uint32_t{test(triangle, g)} << g;
      }
    }
    return hit;
  }
  // trace(below, g, lane) for each ray that goes on alone, if it still goes.
  template <class Trace>
  void each_lone(const Waiting& at, Trace trace) {
    TreeView below = tree_;
    below.root = at.reference;
    for (int i = 0; i < at.lone_rays; ++i) {
      const int g = at.ray[i] / group_lanes, lane = at.ray[i] % group_lanes;
      if ((groups_.going[g] >> lane & 1u) == 0) continue;
      trace(below, g, lane);
      groups_.refresh(g);
    }
    all_.far = groups_.farthest();
  }
  // After hits of the rays of groups.
  void refresh(std::uint32_t groups) {
    if (groups == 0) return;
    for (; groups != 0; groups &= groups - 1) groups_.refresh(std::countr_zero(groups));
    all_.far = groups_.farthest();
  }
  int group_registers() const { return (groups_.groups + group_lanes - 1) / group_lanes; }

  const Ray& ray_of(int g, int lane) const { return batch_rays_[groups_.number(g, lane)]; }

  Calls calls_;
  const TreeView& tree_;
  const Ray* batch_rays_;
  std::size_t batch_size_;
  const Hit* batch_hits_;
  float rounding_;
  [[no_unique_address]] Counters counters_;
  Groups<apex>& groups_;
  // For each packet:
  PacketFrame frame_{Float3{}, CubeFace{}, 0.0f, 0.0f};
  float reach_ = 0.0f;
  Around<apex, float> all_{};
};

}  // namespace
}  // namespace raylanes
