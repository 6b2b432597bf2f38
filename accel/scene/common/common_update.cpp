// Which instances have trees in common, one for each mask in use, up to max_groups. A tree is built again only if a
// quarter of its triangles has changed: a part that moves, or one that is added, does not cost a build of all others.
#include <map>
#include <numeric>

#include "../../layout/bvh_arrays.hpp"
#include "../../queries/traced_tree.hpp"
#include "../scene_parts.hpp"
#include "common_tree.hpp"

namespace raylanes {
namespace {

// Each ray goes through all trees that its mask sees, from their roots.
constexpr std::size_t max_groups = 4;

// Builds as the largest of the meshes is built.
Bvh united(const SceneParts& scene, std::span<const Member> members, int threads) {
  const auto geometry_of = [&](const Member& member) -> const Geometry& {
    return *scene.geometries[member.geometry];
  };
  BuildOptions options =
      geometry_of(*std::ranges::max_element(members, {}, &Member::triangles)).build_options();
  options.threads = threads;
  const std::uint32_t count = (members.end() - 1)->first;
  std::vector<float> corners(9 * std::size_t{count});  // unused numbers are points, which trees leave out
  for (const Member& member : members.first(members.size() - 1))
    geometry_of(member).put_corners(corners.data() + 9 * std::size_t{member.first});
  std::vector<std::uint32_t> indices(3 * std::size_t{count});
  std::iota(indices.begin(), indices.end(), 0u);
  return Bvh(corners, indices, options);
}

}  // namespace

CommonUpdate::CommonUpdate(const SceneParts& scene, std::span<const InstanceBounds> bounds, int threads)
    : scene_(scene), bounds_(bounds), standing_(bounds.size()), is_member_(bounds.size()) {
  look_at_instances();
  if (!has_only_instance()) add_groups_of_trees(), add_groups_of_waiting();
  for (CommonGroup& group : groups_) {
    group.keeps_tree() ? keep_tree(group) : set_tree(group, chosen_members(group.mask), threads);
    if (group.tree != nullptr) placed_ += group.tree->triangles, trees_.push_back(group.tree);
  }
  // Most hits first: they end rays to the others.
  std::ranges::stable_sort(trees_, std::greater<>(), [](const auto& tree) { return tree->triangles; });
}

std::size_t CommonUpdate::triangles_of(std::size_t instance) const {
  return scene_.geometries[scene_.instances[instance].geometry]->mesh_triangles();
}
bool CommonUpdate::may_be_member(std::size_t i) const {
  const Instance& instance = scene_.instances[i];
  return instance.is_identity && instance.mask != 0 && is_visited(bounds_[i].box) &&
         scene_.words_of(instance.geometry) == nullptr &&
         scene_.geometries[instance.geometry]->mesh_triangles() > 0;
}

void CommonUpdate::look_at_instances() {
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    const Instance& instance = scene_.instances[i];
    Standing& standing = standing_[i] = instance.standing;
    if (scene_.is_changed[instance.geometry]) standing = left(standing);
    if (standing == Standing::added || standing == Standing::waiting)
      standing = may_be_member(i) ? Standing::waiting : Standing::apart;
    if (is_visited(bounds_[i].box)) extend(box_, bounds_[i].box);
  }
}

// An instance that is alone in the scene may be traced by its tree as it is, whatever becomes of it.
bool CommonUpdate::has_only_instance() {
  std::size_t only = 0, visited = 0;
  for (std::size_t i = 0; i < bounds_.size() && visited < 2; ++i)
    if (is_visited(bounds_[i].box)) only = i, ++visited;
  if (visited != 1 || !may_be_member(only)) return false;
  CommonGroup group{scene_.instances[only].mask};
  set_tree(group, {static_cast<std::uint32_t>(only)}, 1);
  trees_.push_back(group.tree);
  if (standing_[only] == Standing::waiting) standing_[only] = Standing::common;
  return true;
}

void CommonUpdate::add_groups_of_trees() {
  for (const std::shared_ptr<CommonTree>& tree : scene_.commons) {
    CommonGroup group{tree->mask, tree};
    for (const Member& member : tree->members) {
      if (member.instance == no_part || member.is_struck) continue;
      (standing_[member.instance] == Standing::common ? group.staying : group.leaving) += member.triangles;
    }
    if (group.staying > 0) groups_.push_back(std::move(group));
  }
}

// New groups have the most triangles. One instance makes a group if most rays meet it anyway.
void CommonUpdate::add_groups_of_waiting() {
  std::map<std::uint32_t, CommonGroup> waiting;
  std::map<std::uint32_t, std::size_t> worth;
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    if (standing_[i] != Standing::waiting) continue;
    const std::uint32_t mask = scene_.instances[i].mask;
    worth[mask] += waiting.contains(mask) || fills_scene(i) ? 1 : 0;
    CommonGroup& group = waiting[mask];
    group.mask = mask, group.waiting += triangles_of(i);
  }
  for (CommonGroup& group : groups_)
    if (const auto found = waiting.extract(group.mask)) group.waiting = found.mapped().waiting;
  std::vector<CommonGroup> others;
  for (const auto& [mask, group] : waiting)
    if (worth[mask] > 0) others.push_back(group);
  std::ranges::stable_sort(others, std::greater<>(), &CommonGroup::waiting);
  others.resize(std::min(others.size(), max_groups - groups_.size()));
  groups_.insert(groups_.end(), others.begin(), others.end());
}

void CommonUpdate::keep_tree(CommonGroup& group) {
  for (const Member& member : group.tree->members)
    if (member.instance != no_part && !member.is_struck)
      is_member_[member.instance] = standing_[member.instance] == Standing::common;
  if (group.leaving > 0 && group.tree->is_shared) group.tree = std::make_shared<CommonTree>(*group.tree);
}

// The members of a new tree, which is at most twice as large as the geometries: few are placed twice.
std::vector<std::uint32_t> CommonUpdate::chosen_members(std::uint32_t mask) {
  std::vector<std::uint32_t> chosen;
  std::size_t triangles = 0, most = 0;
  for (const auto& geometry : scene_.geometries) most += 2 * geometry->mesh_triangles();
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    if (standing_[i] != Standing::common && standing_[i] != Standing::waiting) continue;
    if (scene_.instances[i].mask != mask) continue;
    const std::size_t with_it = triangles + triangles_of(i);
    const bool fits = placed_ + with_it <= most && with_it + with_it / 8 <= max_mesh_triangles;
    standing_[i] = fits ? Standing::common : Standing::apart;
    if (fits) triangles = with_it, chosen.push_back(static_cast<std::uint32_t>(i));
  }
  if (chosen.size() != 1 || fills_scene(chosen[0])) return chosen;
  standing_[chosen[0]] = Standing::waiting;
  return {};
}
// Whether most rays meet it.
bool CommonUpdate::fills_scene(std::size_t instance) const {
  return 4.0 * half_area_of(bounds_[instance].box) >= half_area_of(box_);
}

void CommonUpdate::set_tree(CommonGroup& group, const std::vector<std::uint32_t>& chosen, int threads) {
  group.tree = nullptr;
  if (chosen.empty()) return;
  auto tree = std::make_shared<CommonTree>();
  std::vector<Member> members;
  std::vector<Box> boxes;
  for (const std::uint32_t i : chosen) {
    is_member_[i] = 1, boxes.push_back(bounds_[i].box);
    members.push_back(
        {{0, scene_.instances[i].geometry, i}, bounds_[i].box, static_cast<std::uint32_t>(triangles_of(i))});
  }
  static_cast<MemberTable&>(*tree) = MemberTable(std::move(members));
  tree->boxes = build_box_tree("scene", boxes, {});
  tree->mask = group.mask;
  const std::shared_ptr<Geometry>& alone = scene_.geometries[tree->members[0].geometry];
  if (chosen.size() > 1) tree->own = std::make_shared<Bvh>(united(scene_, tree->members, threads));
  tree->geometry = tree->own != nullptr ? geometry_of_triangles(tree->own) : alone;
  tree->view = TreeAccess::ready(*tree->geometry->triangles());
  group.tree = std::move(tree);
}

void CommonUpdate::commit(SceneParts& scene) noexcept {
  for (const std::shared_ptr<CommonTree>& tree : trees_)
    for (Member& member : std::span(tree->members).first(tree->members.size() - 1))
      if (!member.is_struck && !has(member.instance)) tree->strike(member);
  for (std::size_t i = 0; i < standing_.size(); ++i) scene.instances[i].standing = standing_[i];
  std::fill(scene.is_changed.begin(), scene.is_changed.end(), false);
  scene.commons = std::move(trees_);
}

}  // namespace raylanes
