#include <raylanes/bounded_tree.hpp>

#include "ray_parts.hpp"
#include "visits.hpp"

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

const BoxTree no_boxes;

}  // namespace

BoundedTree::BoundedTree() noexcept = default;
BoundedTree::~BoundedTree() = default;
BoundedTree::BoundedTree(BoundedTree&&) noexcept = default;
BoundedTree& BoundedTree::operator=(BoundedTree&&) noexcept = default;

BoundedTree::BoundedTree(std::span<const Box> boxes, const BoundedBuildOptions& options)
    : tree_(std::make_unique<BoxTree>(build_box_tree(
          "bounded tree",
          options.slack > 0.0f ? widened(boxes, options.slack) : std::vector<Box>(boxes.begin(), boxes.end()),
          options))) {
  tree_->slack = options.slack;
}

void BoundedTree::closest(RayView rays, std::span<Hit> hits, LeafFunction visit, void* context,
                          const VisitOptions& options) const {
  const BoxTree& tree = tree_ ? *tree_ : no_boxes;
  const LeafCallback test{visit, context};
  visit_parts("bounded tree", rays, hits, options,
              [&](const KernelTable& kernels, BoxedBatch batch, Hit* to) {
                batch.hits = to;
                trace_boxes(tree, kernels, test, batch);
              });
}

void BoundedTree::occluded(RayView rays, std::span<std::uint8_t> answers, LeafFunction visit, void* context,
                           const VisitOptions& options) const {
  const BoxTree& tree = tree_ ? *tree_ : no_boxes;
  const LeafCallback test{visit, context};
  visit_parts("bounded tree", rays, answers, options,
              [&](const KernelTable& kernels, BoxedBatch batch, std::uint8_t* to) {
                batch.occluded = to;
                trace_boxes(tree, kernels, test, batch);
              });
}

std::span<const std::uint32_t> BoundedTree::order() const noexcept {
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
