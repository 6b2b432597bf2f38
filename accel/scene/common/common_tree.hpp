// One tree over the meshes of a scene that stand where they were made.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "../../../dispatch/table/traversal.hpp"
#include "../../layout/reference.hpp"
#include "../geometry.hpp"
#include "../instance.hpp"

namespace raylanes {

// An instance whose triangles are in a tree: from the number `first` to that of the next member.
struct Member : TriangleOwner {
  Box box = empty_box;
  std::uint32_t triangles = 0;
  bool is_struck = false;  // its triangles have left the tree
};

// The numbers of the members' triangles, which rise by instance and primitive.
struct MemberNumbers {
  std::span<const Member> members;  // by instance, and an end, whose instance is no_part
  TriangleOwners owners;

  // The member that is this instance, or the first one behind it.
  const Member& from(std::uint32_t instance) const {
    return *std::lower_bound(members.begin(), members.end() - 1, instance,
                             [](const Member& member, std::uint32_t i) { return member.instance < i; });
  }
  // The number of a primitive; no_primitive if no member has it.
  std::uint32_t of(std::uint32_t instance, std::uint32_t primitive) const;
  // The hit behind which those hits come that are behind `last`, in the order of t, instance, primitive.
  Hit after(const SceneHit& last) const;
};
// The numbers of an instance alone in its tree.
struct OneMember {
  Member members[2];

  OneMember(std::uint32_t instance, std::uint32_t geometry)
      : members{{{0, geometry, instance}}, {{no_primitive, no_part, no_part}}} {}
  MemberNumbers numbers() const { return {members, {members, 32}}; }
};

struct CommonTree {
  std::shared_ptr<const Geometry> geometry;  // has the triangles of all members
  std::shared_ptr<Bvh> own;                  // its tree; null: that of the only member, which serves as it is
  const TreeView* view = nullptr;            // of the tree
  std::vector<Member> members;               // as in MemberNumbers
  std::vector<TriangleOwner> slots;
  unsigned shift = 31;                    // above all numbers of an only member
  std::uint32_t mask = ~0u;               // of each member
  std::size_t triangles = 0, struck = 0;  // of all members; of those that have left
  // Whether a copy of the scene has it, too. Then nothing changes it.
  std::atomic<bool> is_shared{false};

  CommonTree() = default;
  CommonTree(const CommonTree& other);  // with a tree of its own

  MemberNumbers numbers() const { return {members, {slots.data(), shift}}; }
  bool has(std::uint32_t instance) const {
    const Member& member = numbers().from(instance);
    return member.instance == instance && !member.is_struck;
  }
  std::size_t bytes() const;
};

struct SceneParts;

// The part of update() that makes the common tree.
class CommonUpdate {
 public:
  // bounds[i] is where instance i may be hit. Builds or copies a tree where one is needed; the scene stays as it is.
  CommonUpdate(const SceneParts& scene, std::span<const InstanceBounds> bounds, int threads);
  // Whether the instance is a member after the update.
  bool has(std::size_t instance) const { return is_member_[instance] != 0; }
  void commit(SceneParts& scene) noexcept;

 private:
  std::size_t triangles_of(std::size_t instance) const;
  bool may_be_member(std::size_t instance) const;
  void look_at_instances();
  void choose_mask();
  bool keeps_tree() const;
  void keep_tree();
  std::vector<std::uint32_t> chosen_members();
  std::vector<std::uint32_t> only_instance() const;
  bool fills_scene(std::size_t instance) const;
  void set_tree(const std::vector<std::uint32_t>& chosen, int threads);

  const SceneParts& scene_;
  std::span<const InstanceBounds> bounds_;
  std::vector<Standing> standing_;  // of each instance, after the update
  std::vector<char> is_member_;
  std::size_t staying_ = 0, waiting_ = 0, leaving_ = 0;  // triangles
  std::uint32_t mask_ = ~0u;
  std::shared_ptr<CommonTree> tree_;
};

}  // namespace raylanes
