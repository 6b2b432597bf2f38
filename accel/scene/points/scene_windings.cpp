// The winding numbers of scenes: sums over all instances.

#include "../../../dispatch/checked.hpp"
#include "../../batch/batch.hpp"
#include "../../batch/checked_call.hpp"
#include "../../queries/locations.hpp"
#include "part_places.hpp"
#include "scene_search.hpp"

namespace raylanes {
namespace {

// Points that instances are asked about together: neighbours share rays, and results must not depend on threads.
constexpr std::size_t block_size = 4096;

class SumsOfBlocks {
 public:
  SumsOfBlocks(const SceneParts& scene, std::span<const std::uint32_t> instances,
               const WindingOptions& of_one)
      : scene_(scene), instances_(instances), of_one_(of_one) {}

  // The points from `begin` to `end`.
  void find(const VertexView& points, LaneBits active, std::size_t begin, std::size_t end,
            std::span<float> numbers) {
    active_.clear();
    for (std::size_t i = begin; i < end; ++i)
      if (takes_part(active, i)) active_.push_back(i);
    sums_.assign(active_.size(), 0.0), of_instance_.resize(active_.size());
    for (const std::uint32_t number : instances_) {
      const Instance& instance = scene_.instances[number];
      mapped_.clear();
      for (const std::size_t i : active_) mapped_.push_back(in_part(instance, points[i]));
      scene_.geometries[instance.geometry]->triangles()->winding_numbers(mapped_, of_instance_, of_one_);
      for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k] += double{of_instance_[k]};
    }
    for (std::size_t k = 0; k < sums_.size(); ++k) numbers[active_[k]] = winding_of<float>(sums_[k]);
  }

 private:
  const SceneParts& scene_;
  std::span<const std::uint32_t> instances_;
  const WindingOptions& of_one_;
  std::vector<std::size_t> active_;
  std::vector<Float3> mapped_;
  std::vector<float> of_instance_;
  std::vector<double> sums_;
};

std::vector<std::uint32_t> seen_in_order(const SceneParts& scene, std::uint32_t mask) {
  std::vector<std::uint32_t> seen;
  each_seen(scene, mask, [&](std::uint32_t instance) { seen.push_back(instance); });
  std::ranges::sort(seen);
  return seen;
}

}  // namespace

void sum_winding_numbers(const SceneParts& scene, const VertexView& points, std::span<float> numbers,
                         const WindingOptions& options) {
  const CheckedPoints<float> call("winding_numbers", points, "numbers", numbers, options.active);
  require_accuracy(options.accuracy);
  require_threads("winding_numbers", options.threads);
  const KernelTable& kernels = kernels_of(checked_path(options.path));
  if (options.counters != nullptr) require_counters("winding_numbers", kernels.has_counters());
  require_triangles_seen("winding_numbers", scene, options.mask);
  const std::vector<std::uint32_t> seen = seen_in_order(scene, options.mask);
  for (const std::uint32_t i : seen) scene.geometries[scene.instances[i].geometry]->built(options.threads);
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(seen.size(), 1));
  BatchPlan plan{options.threads, options.counters};
  plan.min_part = 1, plan.progress = options.progress;
  over_parts(plan, (points.count + block_size - 1) / block_size,
             [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
               WindingOptions of_one{.accuracy = options.accuracy * share, .path = options.path};
               of_one.counters = counters;
               SumsOfBlocks sums(scene, seen, of_one);
               for (; begin < end; ++begin)
                 sums.find(points, call.active, begin * block_size,
                           std::min((begin + 1) * block_size, points.count), numbers);
             });
}

}  // namespace raylanes
