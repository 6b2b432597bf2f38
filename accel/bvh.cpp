#include <stdexcept>
#include <string>

#include <raylanes/bvh.hpp>

#include "../dispatch/checked.hpp"
#include "../dispatch/table.hpp"
#include "in_parallel.hpp"
#include "layout/wide_tree.hpp"

namespace raylanes {
namespace {

constexpr std::size_t max_triangles = std::size_t{1} << 28;
constexpr std::size_t rays_per_task = 4096;

void check_batch(std::size_t rays, std::size_t results, const TraceOptions& options) {
  if (rays != results)
    throw std::invalid_argument("trace: " + std::to_string(rays) + " rays but room for " +
                                std::to_string(results) + " results, they must be as many");
  if (options.threads < 0)
    throw std::invalid_argument("trace: " + std::to_string(options.threads) +
                                " threads, allowed are 0 (one per core), 1, 2, …");
}

const TraversalRow& kernels_for(const TraceOptions& options) {
  const std::size_t test = checked_index("trace", "test", options.test, triangle_test_names.size());
  const std::size_t grade = checked_index("trace", "grade", options.grade, grade_names.size());
  checked_index("trace", "mode", options.mode, traversal_mode_names.size());
  return checked_path(options.path).kernels.traversal.triangle[test][grade];
}

// Moved from, a tree is the empty one.
TreeView view_of(const std::unique_ptr<WideTree>& tree) {
  return tree ? tree->view() : WideTree{}.view();
}

}  // namespace

Bvh::Bvh(std::span<const Float3> vertices, std::span<const Index3> triangles, const Progress& progress) {
  if (triangles.size() > max_triangles)
    throw std::invalid_argument("bvh: " + std::to_string(triangles.size()) +
                                " triangles, at most 2^28 are allowed");
  validate_mesh(vertices, triangles);
  std::vector<Bounds> boxes;
  boxes.reserve(triangles.size());
  for (const Index3& triangle : triangles) boxes.push_back(triangle_bounds(vertices, triangle));
  tree_ =
      std::make_unique<WideTree>(collapse_to_wide(build_binned_sah(boxes, progress), vertices, triangles));
}

Bvh::~Bvh() = default;
Bvh::Bvh(Bvh&&) noexcept = default;
Bvh& Bvh::operator=(Bvh&&) noexcept = default;

void Bvh::closest(std::span<const Ray> rays, std::span<Hit> hits, const TraceOptions& options) const {
  check_batch(rays.size(), hits.size(), options);
  const TraversalRow& kernels = kernels_for(options);
  const ClosestHitFunction trace =
      options.mode == TraversalMode::packet ? kernels.closest_packet : kernels.closest_single;
  const TreeView tree = view_of(tree_);
  in_parallel(rays.size(), rays_per_task, options.threads, [&](std::size_t begin, std::size_t end) {
    trace(tree, rays.data() + begin, hits.data() + begin, end - begin);
  });
}

void Bvh::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded,
                   const TraceOptions& options) const {
  check_batch(rays.size(), occluded.size(), options);
  const TraversalRow& kernels = kernels_for(options);
  const AnyHitFunction trace =
      options.mode == TraversalMode::packet ? kernels.any_packet : kernels.any_single;
  const TreeView tree = view_of(tree_);
  in_parallel(rays.size(), rays_per_task, options.threads, [&](std::size_t begin, std::size_t end) {
    trace(tree, rays.data() + begin, occluded.data() + begin, end - begin);
  });
}

std::size_t Bvh::bytes() const noexcept {
  return tree_ ? tree_->bytes() : 0;
}
std::size_t Bvh::node_count() const noexcept {
  return tree_ ? tree_->nodes.size() : 0;
}
std::size_t Bvh::leaf_count() const noexcept {
  return tree_ ? tree_->blocks.size() : 0;
}

}  // namespace raylanes
