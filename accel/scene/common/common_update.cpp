// Which instances have a tree in common. It is built again only if a quarter of its triangles has changed: a part that
// moves, or one that is added, does not cost a build of all others.
#include <bit>
#include <map>
#include <numeric>

#include "../../layout/bvh_arrays.hpp"
#include "../../queries/traced_tree.hpp"
#include "../scene_parts.hpp"
#include "common_tree.hpp"

namespace raylanes {
namespace {

// The numbers of a slot, as a power of two: members begin at multiples of it. Unused numbers are a sixteenth of all on
// average, an eighth at most.
unsigned shift_of_slots(std::size_t triangles, std::size_t members) {
  const std::size_t most = triangles / (8 * members);
  return most < 2 ? 0 : std::min(16u, static_cast<unsigned>(std::bit_width(most)) - 1);
}

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
  choose_mask();
  keeps_tree() ? keep_tree() : set_tree(chosen_members(), threads);
}

std::size_t CommonUpdate::triangles_of(std::size_t instance) const {
  return scene_.geometries[scene_.instances[instance].geometry]->mesh_triangles();
}
bool CommonUpdate::may_be_member(std::size_t i) const {
  const Instance& instance = scene_.instances[i];
  return instance.is_identity && instance.mask != 0 && is_visited(bounds_[i].box) &&
         scene_.geometries[instance.geometry]->mesh_triangles() > 0;
}

void CommonUpdate::look_at_instances() {
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    const Instance& instance = scene_.instances[i];
    Standing& standing = standing_[i] = instance.standing;
    if (scene_.is_changed[instance.geometry]) standing = left(standing);
    if (standing == Standing::added || standing == Standing::waiting)
      standing = may_be_member(i) ? Standing::waiting : Standing::apart;
    if (standing == Standing::common) staying_ += triangles_of(i);
  }
  if (scene_.common == nullptr) return;
  for (const Member& member : scene_.common->members)
    if (member.instance != no_part && !member.is_struck && standing_[member.instance] != Standing::common)
      leaving_ += member.triangles;
}

// One tree has one mask: that of the most triangles.
void CommonUpdate::choose_mask() {
  std::map<std::uint32_t, std::size_t> triangles;
  for (std::size_t i = 0; i < standing_.size(); ++i)
    if (standing_[i] == Standing::waiting) triangles[scene_.instances[i].mask] += triangles_of(i);
  if (staying_ > 0)
    mask_ = scene_.common->mask;
  else if (!triangles.empty())
    mask_ =
        std::ranges::max_element(triangles, {}, [](const auto& of_mask) { return of_mask.second; })->first;
  for (std::size_t i = 0; i < standing_.size(); ++i)
    if (standing_[i] == Standing::waiting && scene_.instances[i].mask != mask_)
      standing_[i] = Standing::apart;
  waiting_ = triangles[mask_];
}

bool CommonUpdate::keeps_tree() const {
  return staying_ > 0 && 4 * (scene_.common->struck + leaving_ + waiting_) <= scene_.common->triangles;
}

void CommonUpdate::keep_tree() {
  for (std::size_t i = 0; i < standing_.size(); ++i) is_member_[i] = standing_[i] == Standing::common;
  tree_ = scene_.common;
  if (leaving_ > 0 && tree_->is_shared) tree_ = std::make_shared<CommonTree>(*tree_);
}

// The members of a new tree, which is at most twice as large as the geometries: few are placed twice.
std::vector<std::uint32_t> CommonUpdate::chosen_members() {
  std::vector<std::uint32_t> chosen;
  std::size_t triangles = 0, most = 0;
  for (const auto& geometry : scene_.geometries) most += 2 * geometry->mesh_triangles();
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    if (standing_[i] != Standing::common && standing_[i] != Standing::waiting) continue;
    const std::size_t with_it = triangles + triangles_of(i);
    const bool fits = with_it <= most && with_it + with_it / 8 <= max_mesh_triangles;
    standing_[i] = fits ? Standing::common : Standing::apart;
    if (fits) triangles = with_it, chosen.push_back(static_cast<std::uint32_t>(i));
  }
  if (chosen.empty()) return only_instance();
  if (chosen.size() == 1 && !fills_scene(chosen[0])) {
    standing_[chosen[0]] = Standing::waiting;
    return {};
  }
  return chosen;
}
// The instance that is alone in the scene, if its tree may serve as it is, whatever becomes of it.
std::vector<std::uint32_t> CommonUpdate::only_instance() const {
  std::vector<std::uint32_t> visited;
  for (std::size_t i = 0; i < bounds_.size() && visited.size() < 2; ++i)
    if (is_visited(bounds_[i].box)) visited.push_back(static_cast<std::uint32_t>(i));
  return visited.size() == 1 && may_be_member(visited[0]) ? visited : std::vector<std::uint32_t>();
}
// Whether most rays meet it: all are traced through the common tree first.
bool CommonUpdate::fills_scene(std::size_t instance) const {
  Box all = empty_box;
  for (const InstanceBounds& bounds : bounds_)
    if (is_visited(bounds.box)) extend(all, bounds.box);
  return 4.0 * half_area_of(bounds_[instance].box) >= half_area_of(all);
}

void CommonUpdate::set_tree(const std::vector<std::uint32_t>& chosen, int threads) {
  if (chosen.empty()) return;
  auto tree = std::make_shared<CommonTree>();
  for (const std::uint32_t i : chosen) tree->triangles += triangles_of(i);
  if (chosen.size() > 1) tree->shift = shift_of_slots(tree->triangles, chosen.size());
  std::uint32_t first = 0;
  for (const std::uint32_t i : chosen) {
    is_member_[i] = 1;
    const TriangleOwner owner{first, scene_.instances[i].geometry, i};
    const auto triangles = static_cast<std::uint32_t>(triangles_of(i));
    tree->members.push_back({owner, bounds_[i].box, triangles});
    const std::uint32_t slots = ((triangles - 1) >> tree->shift) + 1;
    tree->slots.insert(tree->slots.end(), slots, owner);
    first += slots << tree->shift;
  }
  tree->members.push_back({{first, no_part, no_part}});
  tree->mask = scene_.instances[chosen[0]].mask;
  const std::shared_ptr<Geometry>& alone = scene_.geometries[tree->members[0].geometry];
  if (chosen.size() > 1) tree->own = std::make_shared<Bvh>(united(scene_, tree->members, threads));
  tree->geometry = tree->own != nullptr ? geometry_of_triangles(tree->own) : alone;
  tree->view = TreeOf::ready(*tree->geometry->triangles());
  tree_ = std::move(tree);
}

void CommonUpdate::commit(SceneParts& scene) noexcept {
  if (tree_ != nullptr)
    for (Member& member : std::span(tree_->members).first(tree_->members.size() - 1)) {
      if (member.is_struck || has(member.instance)) continue;
      TreeOf::strike(*tree_->own, member.box, member.first, (&member)[1].first);
      member.is_struck = true, tree_->struck += member.triangles;
    }
  for (std::size_t i = 0; i < standing_.size(); ++i) scene.instances[i].standing = standing_[i];
  std::fill(scene.is_changed.begin(), scene.is_changed.end(), false);
  scene.common = std::move(tree_);
}

}  // namespace raylanes
