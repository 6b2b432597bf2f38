// The test that a packet's walk and its leaves share: which of its groups of rays may meet some boxes or triangles.
#pragma once

#include "culls.hpp"
#include "prepared.hpp"

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

template <class Batch_, class Rays_, SharedApex apex, class Counters>
class PacketGroups {
 public:
  using Batch = Batch_;
  using Rays = Rays_;

  PacketGroups(const TreeView& tree, const Batch& batch, const PacketFrame& frame, Rays& rays)
      : tree_(tree), batch_(batch), frame_(frame), rays_(rays), all_(rays.frustum()) {}

 protected:
  Counters counters() const { return Counters(batch_); }

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
        counters().triangles(rays_.going[g]);
        hit |= std::uint32_t{test(triangle, g)} << g;
      }
    }
    return hit;
  }
  // After hits of the rays of groups.
  void refresh(std::uint32_t groups) {
    if (groups == 0) return;
    for (; groups != 0; groups &= groups - 1) rays_.refresh(std::countr_zero(groups));
    all_.far = rays_.farthest();
  }
  int group_registers() const { return (rays_.groups + group_lanes - 1) / group_lanes; }

  const Ray& ray_of(int g, int lane) const { return batch_.rays[rays_.number(g, lane)]; }

  const TreeView& tree_;
  const Batch& batch_;
  const PacketFrame& frame_;
  Rays& rays_;
  Around<apex, float> all_;
};

}  // namespace
}  // namespace raylanes
