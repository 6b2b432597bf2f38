#include "common_tree.hpp"

#include "../../queries/traced_tree.hpp"

namespace raylanes {
namespace {

// The number before t among the values that t may have: with subnormals flushed none lies between −2^-126 and 0.
float before(float t) {
  using Limits = std::numeric_limits<float>;
  const volatile float subnormal = Limits::denorm_min();
  return t == 0.0f && subnormal == 0.0f ? -Limits::min() : float_below(std::max(t, Limits::lowest()));
}

}  // namespace

std::uint32_t MemberNumbers::of(std::uint32_t instance, std::uint32_t primitive) const {
  const Member* const member = &from(instance);
  const bool has_it =
      instance != no_part && member->instance == instance && primitive < member[1].first - member->first;
  return has_it ? member->first + primitive : no_primitive;
}

Hit MemberNumbers::after(const SceneHit& hit) const {
  constexpr std::uint32_t behind_all = no_primitive - 1;
  if (!(hit.t < std::numeric_limits<float>::infinity())) return {};
  if (!hit) return {hit.t, 0, 0, behind_all};
  const Member* const member = &from(hit.instance);
  std::uint32_t behind = member->first;
  if (member->instance == hit.instance && hit.instance != no_part)
    behind += std::min(hit.primitive, member[1].first - member->first - 1) + 1;
  return behind == 0 ? Hit{before(hit.t), 0, 0, behind_all} : Hit{hit.t, 0, 0, behind - 1};
}

CommonTree::CommonTree(const CommonTree& other)
    : geometry(other.geometry),
      own(other.own != nullptr ? std::make_shared<Bvh>(TreeAccess::copy(*other.own)) : nullptr),
      view(other.view),
      members(other.members),
      slots(other.slots),
      boxes(other.boxes),
      shift(other.shift),
      mask(other.mask),
      triangles(other.triangles),
      struck(other.struck) {
  if (own != nullptr) geometry = geometry_of_triangles(own), view = TreeAccess::ready(*own);
}

std::size_t CommonTree::members_left() const {
  return static_cast<std::size_t>(std::ranges::count(members, false, &Member::is_struck)) - 1;
}

void CommonTree::strike(Member& member) noexcept {
  TreeAccess::strike(*own, member.box, member.first, (&member)[1].first);
  member.is_struck = true, struck += member.triangles;
}

std::size_t CommonTree::bytes() const {
  return members.size() * sizeof(Member) + slots.size() * sizeof(TriangleOwner) + boxes.bytes() +
         (own != nullptr ? own->bytes() : 0);
}

}  // namespace raylanes
