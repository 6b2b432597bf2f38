
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/spheres.hpp"
#include "../queries/answers/ray_answers.hpp"
#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {

// Spheres in the order of a tree's leaves.
struct SphereTreeArrays {
  BoundedTreeArrays boxes;
  std::vector<float> numbers;  // as SphereLeaves has them
  std::vector<float> radius;   // as given, for files

  SphereLeaves leaves() const { return {numbers.data(), boxes.order.data()}; }
  std::size_t bytes() const { return boxes.bytes() + (numbers.size() + radius.size()) * sizeof(float); }
};

namespace {

// The rows of a leaf's numbers.
template <class Number>
std::array<Number*, 4> rows_of(Number* numbers, std::size_t first, std::size_t size) {
  Number* const row = numbers + 4 * first;
  return {row, row + size, row + 2 * size, row + 3 * size};
}
// visit(first, size) for each leaf.
template <class Visit>
void each_leaf(const BoundedTreeArrays& tree, const Visit& visit) {
  const auto look_at = [&](TreeReference reference) {
    if (reference != empty_reference && refers_to_leaf(reference))
      visit(leaf_of(reference).block, leaf_of(reference).size);
  };
  look_at(tree.root);
  for (const WideNode& node : tree.nodes)
    for (std::size_t slot = 0; slot < tree_width; ++slot)
      if ((node.occupied >> slot & 1u) != 0) look_at(node.child[slot]);
}

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
  const auto& order = leaves.boxes.order;
  leaves.numbers.resize(4 * order.size() + sphere_room);
  for (const std::uint32_t i : order) leaves.radius.push_back(spheres[i].radius);
  each_leaf(leaves.boxes, [&](std::size_t first, std::size_t size) {
    const auto row = rows_of(leaves.numbers.data(), first, size);
    for (std::size_t k = 0; k < size; ++k) {
      const Sphere& sphere = spheres[order[first + k]];
      for (std::size_t axis = 0; axis < 3; ++axis) row[axis][k] = sphere.centre[axis];
      row[3][k] = signed_square(sphere.radius);
    }
  });
  return leaves;
}

const SphereTreeArrays no_spheres;

// Each ray by itself.
void trace_singly(const SphereTreeArrays& spheres, const KernelTable& kernels, const GeometryBatch& batch) {
  const QueryKernels& row = batch.counters != nullptr ? kernels.queries.counted : kernels.queries.plain;
  const TreeView tree = spheres.boxes.view();
  const SphereLeaves leaves = spheres.leaves();
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Ray& ray = batch.rays[i];
    const SphereQuery asked{batch.tmax != nullptr ? batch.tmax[i] : ray.tmax,
                            batch.hits == nullptr,
                            batch.skip != nullptr ? batch.skip[i] : no_primitive,
                            batch.after != nullptr ? batch.after + i : nullptr,
                            batch.asked != nullptr ? batch.asked->rejects : nullptr,
                            batch.asked != nullptr ? batch.asked->function : nullptr,
                            batch.counters};
    const Hit hit = row.closest_sphere(tree, leaves, ray, asked);
    if (batch.hits != nullptr)
      batch.hits[i] = hit;
    else
      batch.occluded[i] = hit ? 1 : 0;
  }
}

// Rays that go together to the leaves of a tree of spheres, if they share an origin or look for any hit.
struct RaysToSpheres {
  const SphereTreeArrays& spheres;
  const KernelTable& kernels;
  const SphereLeaves leaves = spheres.leaves();

  static void visit(void* self, const LeafVisit& leaf) {
    const auto& of = *static_cast<const RaysToSpheres*>(self);
    of.kernels.queries.plain.visit_spheres(
        of.leaves,
        {static_cast<std::uint32_t>(leaf.first), static_cast<std::uint32_t>(leaf.primitives.size()),
         leaf.rays.data(), leaf.rays.size(), leaf.ray, leaf.hit, leaf.occluded, leaf.skip});
  }
  static void alone(void* self, const GeometryBatch& batch) {
    const auto& of = *static_cast<const RaysToSpheres*>(self);
    trace_singly(of.spheres, of.kernels, batch);
  }
};
void trace_spheres(const SphereTreeArrays& spheres, const KernelTable& kernels, const GeometryBatch& batch) {
  constexpr std::size_t min_together = 64;  // fewer rays gain nothing from each other: measured
  if (spheres.boxes.root == empty_reference) return clear_answers(batch);
  if (batch.size < min_together || batch.counters != nullptr || batch.after != nullptr ||
      batch.asked != nullptr)
    return trace_singly(spheres, kernels, batch);
  RaysToSpheres rays{spheres, kernels};
  trace_boxes(spheres.boxes, kernels, {RaysToSpheres::visit, &rays, RaysToSpheres::alone}, batch);
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
    const SphereTreeArrays& tree = leaves();
    const std::size_t begin = to.size();
    to.resize(begin + tree.boxes.size, Sphere{{0, 0, 0}, -1});
    each_leaf(tree.boxes, [&](std::size_t first, std::size_t size) {
      const auto row = rows_of(tree.numbers.data(), first, size);
      for (std::size_t k = 0; k < size; ++k)
        to[begin + tree.boxes.order[first + k]] = {{row[0][k], row[1][k], row[2][k]}, tree.radius[first + k]};
    });
    return {sphere_geometry, static_cast<std::uint32_t>(tree.boxes.size)};
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

namespace {

// The kernels of calls with one ray, by options.
class KernelsOfSpheres {
 public:
  // `spheres`: null if there are none to be used.
  KernelsOfSpheres(const SphereTreeArrays* spheres, const VisitOptions& options)
      : spheres_(spheres), options_(options) {
    if (spheres != nullptr) row_ = &kernels_of(checked_path(options.path)).queries.plain;
  }
  explicit operator bool() const { return spheres_ != nullptr; }
  std::size_t batch_size() const { return min_batch; }
  template <class Answer>
  bool takes(const FewRays<Ray, Answer>&, bool) const {
    return true;
  }
  Hit closest(const Ray& ray, std::size_t i) const { return first(ray, i, false); }
  bool any(const Ray& ray, std::size_t i) const { return static_cast<bool>(first(ray, i, true)); }

 private:
  Hit first(const Ray& ray, std::size_t i, bool any) const {
    return row_->closest_sphere(spheres_->boxes.view(), spheres_->leaves(), ray,
                                {ray.tmax, any, skipped_of(options_, i)});
  }

  const SphereTreeArrays* spheres_;
  const VisitOptions& options_;
  const QueryKernels* row_ = nullptr;
};

}  // namespace

template <>
class RayDoor<SphereTree> {
 public:
  static constexpr const char* name = "sphere tree";

  explicit RayDoor(const SphereTree& tree)
      : spheres_(TreeAccess::arrays(tree) != nullptr ? *TreeAccess::arrays(tree) : no_spheres) {}

  Hit closest(const Ray& ray) const {
    return is_quick() ? kernels({}, 0, true).closest(ray, 0) : closest_by(ray, {});
  }
  bool any(const Ray& ray) const { return is_quick() ? kernels({}, 0, true).any(ray, 0) : any_by(ray, {}); }
  KernelsOfSpheres kernels(const VisitOptions& options, std::size_t rays, bool are_default = false) const {
    const bool are_usual =
        is_quick() && (are_default || (options.threads >= 0 && options.counters == nullptr &&
                                       options.skip.count == (options.skip.first != nullptr ? rays : 0) &&
                                       options.after.first == nullptr && options.after.count == 0));
    return {are_usual ? &spheres_ : nullptr, options};
  }
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
    Hit hit;
    ask(ray, rejection, options, &hit, nullptr);
    return hit;
  }
  bool any_kept(const Ray& ray, const detail::Rejection<Hit>& rejection, const VisitOptions& options) const {
    std::uint8_t is_occluded = 0;
    ask(ray, rejection, options, nullptr, &is_occluded);
    return is_occluded != 0;
  }

 private:
  // Whether a call with one ray may go straight to the kernel: there are spheres, and nothing traps.
  bool is_quick() const { return spheres_.boxes.root != empty_reference && !QuietFloats::are_wanted(); }

  void ask(const Ray& ray, const detail::Rejection<Hit>& rejection, const VisitOptions& options, Hit* hit,
           std::uint8_t* occluded) const {
    const std::uint32_t skipped = skip_of_one(name, options);
    require_after(name, options.after, 1), require_threads(name, options.threads);
    const KernelTable& kernels = kernels_of(checked_path(options.path));
    if (options.counters != nullptr) require_counters(name, kernels.has_counters());
    const Hit after = options.after.first != nullptr ? options.after[0] : Hit();
    const AskedOf<float> asked{rejection.rejects, rejection.function};
    const QuietFloats quiet;
    GeometryBatch batch{&ray, 1, hit, occluded, nullptr, options.counters};
    batch.skip = &skipped, batch.asked = &asked;
    if (options.after.first != nullptr) batch.after = &after;
    trace_spheres(spheres_, kernels, batch);
  }

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
