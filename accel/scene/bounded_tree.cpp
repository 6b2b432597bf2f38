#include <raylanes/bounded_tree.hpp>

#include "scene_parts.hpp"

namespace raylanes {
namespace {

// Around the rounding of tests, as far as it goes with the box itself.
std::vector<Box> widened(std::span<const Box> boxes, float slack) {
  std::vector<Box> wide(boxes.begin(), boxes.end());
  for (Box& box : wide) {
    if (!is_visited(box)) continue;
    float largest = 0.0f;
    for (std::size_t axis = 0; axis < 3; ++axis) largest = std::max({largest, -box.lo[axis], box.hi[axis]});
    constexpr float end = std::numeric_limits<float>::max();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::max(box.lo[axis] - slack * largest, -end);
      box.hi[axis] = std::min(box.hi[axis] + slack * largest, end);
    }
  }
  return wide;
}

BoundedTreeArrays tree_over(std::span<const Box> boxes, const BoundedBuildOptions& options) {
  const QuietFloats quiet;
  BoundedTreeArrays tree = build_box_tree(
      "bounded tree",
      options.slack > 0.0f ? widened(boxes, options.slack) : std::vector<Box>(boxes.begin(), boxes.end()),
      options);
  tree.slack = options.slack;
  return tree;
}

const BoundedTreeArrays no_boxes;

// Traces the rays of a batch on this thread.
auto tracer_of(const BoundedTreeArrays* tree, const LeafCallback& test) {
  return [=](const KernelTable& kernels, const GeometryBatch& batch) {
    trace_boxes(tree != nullptr ? *tree : no_boxes, kernels, test, batch);
  };
}

struct UserGeometry : Geometry {
  UserGeometry(std::unique_ptr<BoundedTreeArrays> tree, const LeafCallback& visit)
      : owned(std::move(tree)), test(visit) {}

  const BoundedTreeArrays& boxes() const { return owned ? *owned : no_boxes; }
  Box bounds() const override { return boxes().bounds; }
  float slack() const override { return boxes().slack; }
  void trace(const GeometryQuery& query, const GeometryBatch& batch) const override {
    if (batch.asked != nullptr) return trace_asked(query, batch);
    trace_boxes(boxes(), query.kernels, test, batch);
  }
  // One ray whose caller rejects hits: those after them are looked for again.
  void trace_asked(const GeometryQuery& query, const GeometryBatch& batch) const {
    Hit hit, last;
    GeometryBatch next = batch;
    next.hits = &hit, next.occluded = nullptr, next.asked = nullptr;
    do {
      if (hit) last = hit, next.after = &last;
      trace_boxes(boxes(), query.kernels, test, next);
    } while (hit && batch.asked->rejects(batch.asked->function, hit));
    if (batch.hits != nullptr)
      *batch.hits = hit;
    else
      *batch.occluded = hit ? 1 : 0;
  }
  GeometryRecord record(std::size_t number, std::vector<Sphere>&) const override {
    throw std::invalid_argument("scene: geometry " + std::to_string(number) +
                                " is of a user's primitives, which no file can hold");
  }

  std::unique_ptr<BoundedTreeArrays> owned;  // null: no boxes
  LeafCallback test;
};

}  // namespace

std::uint32_t Scene::add(BoundedTree tree, LeafFunction visit, void* context) {
  return changed().add(std::make_unique<UserGeometry>(std::move(tree.tree_), LeafCallback{visit, context}));
}

BoundedTree::BoundedTree() noexcept = default;
BoundedTree::~BoundedTree() = default;
BoundedTree::BoundedTree(BoundedTree&&) noexcept = default;
BoundedTree& BoundedTree::operator=(BoundedTree&&) noexcept = default;

BoundedTree::BoundedTree(std::span<const Box> boxes, const BoundedBuildOptions& options)
    : tree_(std::make_unique<BoundedTreeArrays>(tree_over(boxes, options))) {}

void BoundedTree::closest(RayView rays, HitView hits, LeafFunction visit, void* context,
                          const VisitOptions& options) const {
  visit_hits("bounded tree", source_of(rays, options), hits, options,
             tracer_of(tree_.get(), {visit, context}));
}
void BoundedTree::occluded(RayView rays, std::span<std::uint8_t> occluded, LeafFunction visit, void* context,
                           const VisitOptions& options) const {
  visit_occluded("bounded tree", source_of(rays, options), occluded, options,
                 tracer_of(tree_.get(), {visit, context}));
}
Hit BoundedTree::closest(const Ray& ray, LeafFunction visit, void* context,
                         const VisitOptions& options) const {
  return visit_single<Hit>(
      ray, options, tracer_of(tree_.get(), {visit, context}),
      [&](RayView rays, Hit* hit) { closest(rays, HitView(hit, 1), visit, context, for_one_ray(options)); });
}
bool BoundedTree::occluded(const Ray& ray, LeafFunction visit, void* context,
                           const VisitOptions& options) const {
  return visit_single<std::uint8_t>(ray, options, tracer_of(tree_.get(), {visit, context}),
                                    [&](RayView rays, std::uint8_t* is_occluded) {
                                      occluded(rays, std::span(is_occluded, 1), visit, context,
                                               for_one_ray(options));
                                    }) != 0;
}

bool BoundedTree::visit_ray(const Ray& ray, float (*visit)(void*, std::uint32_t, std::uint32_t),
                            detail::SearchInOrder& search, const VisitOptions& options) const {
  const bool is_plain = tree_ != nullptr && tree_->root != empty_reference && options.threads >= 0 &&
                        options.counters == nullptr && options.after.first == nullptr &&
                        options.after.count == 0 && !QuietFloats::are_wanted();
  if (!is_plain) return false;
  search.order = tree_->order.data(), search.skipped = skip_of_one("bounded tree", options);
  const QueryKernels& row = kernels_of(checked_path(options.path)).queries.plain;
  row.visit_ray(tree_->view(), ray, ray.tmax, visit, &search);
  return true;
}

std::span<const std::uint32_t> BoundedTree::order() const& noexcept {
  return tree_ ? std::span<const std::uint32_t>(tree_->order) : std::span<const std::uint32_t>();
}
Box BoundedTree::bounds() const noexcept {
  return tree_ ? tree_->bounds : empty_box;
}
std::size_t BoundedTree::size() const noexcept {
  return tree_ ? tree_->size : 0;
}
std::size_t BoundedTree::bytes() const noexcept {
  return tree_ ? tree_->bytes() : 0;
}

}  // namespace raylanes
