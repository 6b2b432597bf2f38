
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../queries/answers/ray_answers.hpp"
#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {

// Spheres in the order of a tree's leaves.
struct SphereTreeArrays {
  BoundedTreeArrays boxes;
  std::vector<float> row[4];  // centre and signed_square of the radius
  std::vector<float> radius;  // as given, for files

  std::size_t bytes() const { return boxes.bytes() + 5 * row[0].size() * sizeof(float); }
};

namespace {

// A test's decision and its t are wrong by no more than a share of the distance from the origin to the centre and of
// the radius: 32u and 32u, u = 2^-24; sqrt(3) of the largest coordinate. See SphereTest.
constexpr float sphere_slack = 0x1p-17f;

Box box_of(const Sphere& sphere) {
  const float r = sphere.radius;
  if (!(r >= 0.0f && r * r < std::numeric_limits<float>::infinity())) return empty_box;
  float largest = r;
  for (const float c : sphere.centre) largest = std::max(largest, std::abs(c));
  const float reach = r + sphere_slack * largest;
  Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = float_below(sphere.centre[axis] - reach);
    box.hi[axis] = float_above(sphere.centre[axis] + reach);
  }
  return box;
}

SphereTreeArrays leaves_of(std::span<const Sphere> spheres, BoundedBuildOptions options) {
  const QuietFloats quiet;
  std::vector<Box> boxes(spheres.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) boxes[i] = box_of(spheres[i]);
  options.slack = 0.0f, options.max_in_leaf = tree_width;
  SphereTreeArrays leaves{build_box_tree("sphere tree", boxes, options), {}, {}};
  leaves.boxes.slack = sphere_slack;
  for (std::vector<float>& row : leaves.row) row.reserve(leaves.boxes.order.size());
  for (const std::uint32_t i : leaves.boxes.order) {
    for (std::size_t axis = 0; axis < 3; ++axis) leaves.row[axis].push_back(spheres[i].centre[axis]);
    leaves.row[3].push_back(signed_square(spheres[i].radius));
    leaves.radius.push_back(spheres[i].radius);
  }
  return leaves;
}

struct SphereVisit {
  const SphereTreeArrays& spheres;
  const SphereRow& row;

  static void leaf(void* context, const LeafVisit& leaf) {
    static_cast<const SphereVisit*>(context)->at(leaf);
  }

 private:
  void at(const LeafVisit& leaf) const {
    const float* rows[4];
    for (std::size_t k = 0; k < 4; ++k) rows[k] = spheres.row[k].data() + leaf.first;
    const auto all = static_cast<std::uint8_t>((1u << leaf.primitives.size()) - 1);
    for (const std::uint32_t i : leaf.rays) {
      const std::uint8_t skipped = skipped_of(leaf, i);
      if (leaf.after != nullptr) {
        keep_both_sides(leaf, i, rows, all, skipped);
        continue;
      }
      if (skipped != 0) keep_both_sides(leaf, i, rows, skipped, skipped);
      const auto others = static_cast<std::uint8_t>(all & ~skipped);
      Hit hit;
      row.closest_of_spheres(leaf.ray[i], rows, leaf.primitives.size(), skipped == 0 ? nullptr : &others,
                             hit);
      if (!hit) continue;
      hit.primitive = leaf.primitives[hit.primitive];
      leaf.keep(i, hit);
    }
  }
  // The bit of the sphere that the ray skips; 0: none of this leaf.
  static std::uint8_t skipped_of(const LeafVisit& leaf, std::uint32_t i) {
    for (std::size_t k = 0; k < leaf.primitives.size(); ++k)
      if (leaf.skips(i, leaf.primitives[k])) return static_cast<std::uint8_t>(1u << k);
    return 0;
  }
  // Keeps both hits of each of `some` spheres that closest_of_spheres() would find, from the same numbers; of a skipped
  // sphere the one farther from the begin of the segment: a ray that begins on a sphere has the other one there.
  void keep_both_sides(const LeafVisit& leaf, std::uint32_t i, const float* const (&rows)[4],
                       std::uint8_t some, std::uint8_t skipped) const {
    const Ray& ray = leaf.ray[i];
    std::uint8_t is_hit = 0;
    float t[2][tree_width];
    row.distances_of_spheres(ray, rows, leaf.primitives.size(), &some, &is_hit, t[0], t[1]);
    for (std::size_t k = 0; k < leaf.primitives.size(); ++k) {
      if ((is_hit & some & 1u << k) == 0) continue;
      const bool skips_near = std::abs(t[0][k] - ray.tmin) <= std::abs(t[1][k] - ray.tmin);
      for (std::size_t side = 0; side < 2; ++side)
        if (((skipped & 1u << k) == 0 || (side == 0) != skips_near) && t[side][k] >= ray.tmin &&
            t[side][k] <= ray.tmax && std::isfinite(t[side][k]))
          leaf.keep(i, {t[side][k], 0, 0, leaf.primitives[k]});
    }
  }
};

const SphereTreeArrays no_spheres;

void trace_spheres(const SphereTreeArrays& spheres, const KernelTable& kernels, const GeometryBatch& batch) {
  const SphereVisit visit{spheres, kernels.spheres.row[0][0]};
  trace_boxes(spheres.boxes, kernels, {SphereVisit::leaf, const_cast<SphereVisit*>(&visit)}, batch);
}

struct SphereGeometry : Geometry {
  explicit SphereGeometry(std::shared_ptr<const SphereTreeArrays> tree) : kept(std::move(tree)) {}

  const SphereTreeArrays& leaves() const { return kept ? *kept : no_spheres; }
  Box bounds() const override { return leaves().boxes.bounds; }
  float slack() const override { return leaves().boxes.slack; }
  bool keeps_ends() const override { return true; }
  void require(const TraceOptions& options) const override {
    if (options.facing != Facing::any)
      throw std::invalid_argument("scene: facing " +
                                  std::string(facing_names[static_cast<std::size_t>(options.facing)]) +
                                  " is for triangles; with spheres only any is allowed");
  }
  void trace(const GeometryQuery& query, const GeometryBatch& batch) const override {
    trace_spheres(leaves(), query.kernels, batch);
  }
  // Under their numbers; those that nothing hits, and of which the tree has nothing, as empty ones.
  GeometryRecord record(std::size_t, std::vector<Sphere>& to) const override {
    const auto& [boxes, row, radius] = leaves();
    const std::size_t first = to.size();
    to.resize(first + boxes.size, Sphere{{0, 0, 0}, -1});
    for (std::size_t i = 0; i < boxes.order.size(); ++i)
      to[first + boxes.order[i]] = {{row[0][i], row[1][i], row[2][i]}, radius[i]};
    return {sphere_geometry, static_cast<std::uint32_t>(boxes.size)};
  }

  std::shared_ptr<const SphereTreeArrays> kept;  // null: no spheres
};

}  // namespace

std::unique_ptr<Geometry> load_spheres(std::span<const Sphere> spheres, std::istream&) {
  return std::make_unique<SphereGeometry>(std::make_unique<SphereTreeArrays>(leaves_of(spheres, {})));
}
std::uint32_t Scene::add(SphereTree spheres) {
  return changed().add(std::make_unique<SphereGeometry>(std::move(spheres.tree_)));
}
std::uint32_t Scene::add(std::shared_ptr<const SphereTree> spheres) {
  const SphereTreeArrays* const leaves = not_null(spheres)->tree_.get();
  return changed().add(
      std::make_unique<SphereGeometry>(std::shared_ptr<const SphereTreeArrays>(spheres, leaves)));
}
void Scene::replace(std::uint32_t geometry, SphereTree spheres) {
  changed().replace(geometry, std::make_unique<SphereGeometry>(std::move(spheres.tree_)));
}
void Scene::replace(std::uint32_t geometry, std::shared_ptr<const SphereTree> spheres) {
  const SphereTreeArrays* const leaves = not_null(spheres)->tree_.get();
  changed().replace(
      geometry, std::make_unique<SphereGeometry>(std::shared_ptr<const SphereTreeArrays>(spheres, leaves)));
}

SphereTree::SphereTree() noexcept = default;
SphereTree::~SphereTree() = default;
SphereTree::SphereTree(SphereTree&&) noexcept = default;
SphereTree& SphereTree::operator=(SphereTree&&) noexcept = default;

SphereTree::SphereTree(std::span<const Sphere> spheres, const BoundedBuildOptions& options)
    : tree_(std::make_unique<SphereTreeArrays>(leaves_of(spheres, options))) {}

template <>
class RayDoor<SphereTree> {
 public:
  static constexpr const char* name = "sphere tree";

  explicit RayDoor(const SphereTree& tree)
      : tree_(tree), spheres_(TreeAccess::arrays(tree) != nullptr ? *TreeAccess::arrays(tree) : no_spheres) {}

  Hit closest(const Ray& ray) const { return closest_by(ray, {}); }
  bool any(const Ray& ray) const { return any_by(ray, {}); }
  Hit closest_by(const Ray& ray, const VisitOptions& options) const {
    Hit hit;
    const VisitOptions by = for_one_ray(options);
    trace(source_of(RayView(&ray, 1), by), HitView(&hit, 1), by);
    return hit;
  }
  bool any_by(const Ray& ray, const VisitOptions& options) const {
    std::uint8_t is_occluded = 0;
    const VisitOptions by = for_one_ray(options);
    trace(source_of(RayView(&ray, 1), by), std::span(&is_occluded, 1), by);
    return is_occluded != 0;
  }
  void trace(const RaySource& rays, const HitView& hits, const VisitOptions& options) const {
    visit_hits(name, rays, hits, options, [&](const KernelTable& kernels, const GeometryBatch& batch) {
      trace_spheres(spheres_, kernels, batch);
    });
  }
  void trace(const RaySource& rays, std::span<std::uint8_t> occluded, const VisitOptions& options) const {
    visit_occluded(name, rays, occluded, options,
                   [&](const KernelTable& kernels, const GeometryBatch& batch) {
                     trace_spheres(spheres_, kernels, batch);
                   });
  }

  static void require_order(const VisitOptions&) {}
  static NoLists lists(const VisitOptions&) { return {}; }
  Hit closest_kept(const Ray& ray, const detail::Rejection<Hit>& rejection,
                   const VisitOptions& options) const {
    return first_kept(rejection, options, [&](const VisitOptions& next) { return tree_.closest(ray, next); });
  }
  bool any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection, const VisitOptions& options) const {
    return static_cast<bool>(closest_kept(ray, rejection, options));
  }

 private:
  const SphereTree& tree_;
  const SphereTreeArrays& spheres_;
};
template class RayQueries<SphereTree>;

Box SphereTree::bounds() const noexcept {
  return tree_ ? tree_->boxes.bounds : empty_box;
}
std::size_t SphereTree::size() const noexcept {
  return tree_ ? tree_->boxes.size : 0;
}
std::size_t SphereTree::left_out() const noexcept {
  return tree_ ? tree_->boxes.size - tree_->boxes.order.size() : 0;
}
std::size_t SphereTree::bytes() const noexcept {
  return tree_ ? tree_->bytes() : 0;
}

}  // namespace raylanes
