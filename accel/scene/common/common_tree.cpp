#include "common_tree.hpp"

#include <raylanes/scene_d.hpp>

#include "../../queries/traced_tree.hpp"

namespace raylanes {
namespace {

// The number before t among the values that t may have: with subnormals flushed none lies between 0 and the normal
// numbers.
template <class T>
T before(T t) {
  using Limits = std::numeric_limits<T>;
  const volatile T subnormal = Limits::denorm_min();
  return t == 0 && subnormal == 0 ? -Limits::min() : number_below(std::max(t, Limits::lowest()));
}

// The numbers of a slot, as a power of two: members begin at multiples of it. Unused numbers are a sixteenth of all on
// average, an eighth at most.
unsigned shift_of_slots(std::size_t triangles, std::size_t members) {
  const std::size_t most = triangles / (8 * members);
  return most < 2 ? 0 : std::min(16u, static_cast<unsigned>(std::bit_width(most)) - 1);
}

}  // namespace

std::uint32_t MemberNumbers::of(std::uint32_t instance, std::uint32_t primitive) const {
  if (instance == no_part) return no_primitive;
  const Member* const member = &from(instance);
  const bool has_it = member->instance == instance && primitive < member[1].first - member->first;
  return has_it ? member->first + primitive : no_primitive;
}

template <class AnyHit>
HitOf<decltype(AnyHit::t)> MemberNumbers::after(const AnyHit& hit) const {
  using TreeHit = HitOf<decltype(AnyHit::t)>;
  constexpr std::uint32_t behind_all = no_primitive - 1;
  if (!(hit.t < std::numeric_limits<decltype(AnyHit::t)>::infinity())) return {};
  if (!hit) return {hit.t, 0, 0, behind_all};
  const Member* const member = &from(hit.instance);
  std::uint32_t behind = member->first;
  if (member->instance == hit.instance && hit.instance != no_part)
    behind += std::min(hit.primitive, member[1].first - member->first - 1) + 1;
  return behind == 0 ? TreeHit{before(hit.t), 0, 0, behind_all} : TreeHit{hit.t, 0, 0, behind - 1};
}
template Hit MemberNumbers::after(const SceneHit&) const;
template HitD MemberNumbers::after(const SceneHitD&) const;

MemberTable::MemberTable(std::vector<Member> unnumbered) : members(std::move(unnumbered)) {
  for (const Member& member : members) triangles += member.triangles;
  if (members.size() > 1) shift = shift_of_slots(triangles, members.size());
  std::uint32_t first = 0;
  for (Member& member : members) {
    member.first = first;
    const std::uint32_t of_member = ((member.triangles - 1) >> shift) + 1;
    slots.insert(slots.end(), of_member, member);
    first += of_member << shift;
  }
  members.push_back({{first, no_part, no_part}});
}

CommonTree::CommonTree(const CommonTree& other)
    : MemberTable(other),
      geometry(other.geometry),
      own(other.own != nullptr ? std::make_shared<Bvh>(TreeAccess::copy(*other.own)) : nullptr),
      view(other.view),
      boxes(other.boxes),
      mask(other.mask),
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
