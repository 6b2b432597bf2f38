// Trees over the meshes of a scene that stand where they were made, one for each mask.
#pragma once

#include "../../../dispatch/table/traversal.hpp"
#include "../../layout/reference.hpp"
#include "../bounded_tree_arrays.hpp"
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
  // The numbers of the primitives that rays skip; no_primitive for rays that take no part.
  template <class Source>
  std::vector<std::uint32_t> of_skips(const Source& rays, const PrimitiveView& skip) const {
    std::vector<std::uint32_t> numbers(rays.size(), no_primitive);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (rays.takes_part(i)) numbers[i] = of(skip.instance(i), skip[i]);
    return numbers;
  }
  // The hit after which those hits come that are after `hit`, a SceneHit or SceneHitD, in the order of t, instance,
  // primitive.
  template <class AnyHit>
  HitOf<decltype(AnyHit::t)> after(const AnyHit& hit) const;
};
// The numbers of an instance alone in its tree.
struct OneMember {
  Member members[2];

  OneMember(std::uint32_t instance, std::uint32_t geometry)
      : members{{{0, geometry, instance}}, {{no_primitive, no_part, no_part}}} {}
  MemberNumbers numbers() const { return {members, {members, 32}}; }
};

// Members, and which of them the triangles of a common tree belong to.
struct MemberTable {
  std::vector<Member> members;  // as in MemberNumbers
  std::vector<TriangleOwner> slots;
  unsigned shift = 31;        // above all numbers of an only member
  std::size_t triangles = 0;  // of all members

  MemberTable() = default;
  // Numbers the triangles of members, of which each has some.
  explicit MemberTable(std::vector<Member> unnumbered);
  MemberNumbers numbers() const { return {members, {slots.data(), shift}}; }
};

struct CommonTree : MemberTable {
  std::shared_ptr<const Geometry> geometry;  // has the triangles of all members
  std::shared_ptr<Bvh> own;                  // its tree; null: that of the only member, which serves as it is
  const TreeView* view = nullptr;            // of the tree
  BoundedTreeArrays boxes;                   // over the boxes of members
  std::uint32_t mask = ~0u;                  // of each member that is left
  std::size_t struck = 0;                    // triangles of members that have left
  // Whether a copy of the scene has it, too. Then nothing changes it.
  std::atomic<bool> is_shared{false};

  CommonTree() = default;
  CommonTree(const CommonTree& other);  // with a tree of its own, if the other one has one

  bool has(std::uint32_t instance) const {
    const Member& member = numbers().from(instance);
    return member.instance == instance && !member.is_struck;
  }
  std::size_t members_left() const;
  // Takes the triangles of a member out of the tree.
  void strike(Member& member) noexcept;
  std::size_t bytes() const;
};

// The instances of one mask that have a tree in common, or are to have one: what it was before the update, and then
// what it is after it. Numbers are of triangles.
struct CommonGroup {
  std::uint32_t mask;
  std::shared_ptr<CommonTree> tree = nullptr;
  std::size_t staying = 0, waiting = 0, leaving = 0;

  bool keeps_tree() const { return staying > 0 && 4 * (tree->struck + leaving + waiting) <= tree->triangles; }
};

struct SceneParts;

// The part of update() that makes the common trees.
class CommonUpdate {
 public:
  // bounds[i] is where instance i may be hit. Builds or copies trees where they are needed; the scene stays as it is.
  CommonUpdate(const SceneParts& scene, std::span<const InstanceBounds> bounds, int threads);
  // Whether the instance is a member after the update.
  bool has(std::size_t instance) const { return is_member_[instance] != 0; }
  void commit(SceneParts& scene) noexcept;

 private:
  std::size_t triangles_of(std::size_t instance) const;
  bool may_be_member(std::size_t instance) const;
  void look_at_instances();
  bool has_only_instance();
  void add_groups_of_trees();
  void add_groups_of_waiting();
  void keep_tree(CommonGroup& group);
  std::vector<std::uint32_t> chosen_members(std::uint32_t mask);
  bool fills_scene(std::size_t instance) const;
  void set_tree(CommonGroup& group, const std::vector<std::uint32_t>& chosen, int threads);

  const SceneParts& scene_;
  std::span<const InstanceBounds> bounds_;
  Box box_ = empty_box;             // of all instances
  std::vector<Standing> standing_;  // of each instance, after the update
  std::vector<char> is_member_;
  std::vector<CommonGroup> groups_;
  std::size_t placed_ = 0;  // triangles in the trees so far
  std::vector<std::shared_ptr<CommonTree>> trees_;
};

}  // namespace raylanes
