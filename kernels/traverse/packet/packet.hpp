// A packet through a tree: each node is tested with the frustum around all rays, then with the frusta of the groups, a
// vector of groups at a time. If triangles are smaller than the distance of rays, frusta keep little out: then boxes
// are tested with rays, and the last few go on alone.
#pragma once

#include "../one_by_one.hpp"
#include "packet_groups.hpp"

namespace raylanes {
namespace {

// Packets that come to more leaves than this ask each box for their rays, too: one packet in a hundred, which would
// take half the time.
inline constexpr int leaves_of_frusta = 10;

template <SharedApex apex, class Counters, class Waiting>
class Packet {
 public:
  explicit Packet(PacketGroups<apex, Counters, Waiting>& of) : of_(of), tree_(of.tree_), rays_(of.groups_) {}

  void trace() {
    top_ = stack_;
    set(*top_++, {tree_.root, 0.0f, groups_going(~0u, 0.0f), 0, {}});
    while (top_ != stack_) {
      Waiting at = *--top_;
      if (at.near > of_.all_.far) continue;
      if (at.lone_rays != 0) {
        of_.calls_.trace_alone(of_, at);
        continue;
      }
      at.groups = groups_going(at.groups, at.near);
      if (at.groups == 0) continue;
      if (refers_to_leaf(at.reference))
        ++leaves_, of_.calls_.visit_leaf(of_, at);
      else
        visit_node(at);
    }
  }

 private:
  static void set(WaitingGroups& waiting, const WaitingGroups& groups) { waiting = groups; }

  // The groups among them that still go as far as that.
  std::uint32_t groups_going(std::uint32_t groups, float near) const {
    std::uint32_t going = 0;
    for (int g = 0; g < rays_.groups; g += group_lanes)
      going |= bits(GroupFloats::load(rays_.far + g) >= GroupFloats(near)) << g;
    return groups & going;
  }

  [[gnu::noinline, gnu::flatten]] void visit_node(const Waiting& at) {
    const WideNode& node = tree_.nodes[at.reference];
    const FrameBoxes boxes(node, of_.frame_);
    of_.counters().node(), of_.counters().frusta(node.occupied, tree_width / node_lanes);
    Waiting* const base = top_;
    for (std::uint32_t children = of_.met_by_any(boxes, at.groups) & node.occupied; children != 0;
         children &= children - 1) {
      const int child = std::countr_zero(children);
      Waiting entering;
      set(entering, {node.child[child], boxes.near[child], of_.groups_met(boxes, child, at.groups), 0, {}});
      if (entering.groups != 0 && leaves_ > leaves_of_frusta) ask_rays(boxes.box(child), entering);
      if (entering.groups == 0) continue;
      if constexpr (requires { entering.box; }) entering.box = boxes.in_one_lane(child);
      Waiting* place = top_++;
      for (; place != base && place[-1].near < entering.near; --place) *place = place[-1];
      *place = entering;
      if (refers_to_leaf(node.child[child]) && of_.calls_.prefetch_leaf != nullptr)
        of_.calls_.prefetch_leaf(of_, node.child[child]);
      else
        raylanes::prefetch<OfCorners>(tree_, node.child[child]);
    }
  }

  // Drops groups without a ray in the box.
  [[gnu::noinline, gnu::flatten]] void ask_rays(const FrameBox<GroupFloats>& box, Waiting& entering) const {
    int count = 0;
    for (std::uint32_t groups = entering.groups; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      of_.counters().boxes(rays_.going[g]);
      std::uint32_t rays = bits(may_meet(box, rays_.lines(g))) & rays_.going[g];
      if (rays == 0) entering.groups &= ~(1u << g);
      for (; rays != 0 && count <= max_lone_rays; rays &= rays - 1, ++count)
        if (count < max_lone_rays)
          entering.ray[count] = static_cast<std::uint16_t>(g * group_lanes + std::countr_zero(rays));
    }
    entering.lone_rays = count <= max_lone_rays ? count : 0;
  }

  PacketGroups<apex, Counters, Waiting>& of_;
  const TreeView& tree_;
  Groups<apex>& rays_;
  int leaves_ = 0;
  Waiting stack_[max_stack], *top_ = stack_;
};

}  // namespace
}  // namespace raylanes
