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

template <class Parts>
class SumsOfBlocks {
  using T = typename Parts::Number;

 public:
  SumsOfBlocks(const Parts& scene, std::span<const std::uint32_t> instances, const WindingOptions& of_one)
      : scene_(scene), instances_(instances), of_one_(of_one) {}

  // The points from `begin` to `end`.
  void find(const VertexRecords<T>& points, LaneBits active, std::size_t begin, std::size_t end,
            std::span<T> numbers) {
    active_.clear();
    for (std::size_t i = begin; i < end; ++i)
      if (takes_part(active, i)) active_.push_back(i);
    sums_.assign(active_.size(), 0.0), of_instance_.resize(active_.size());
    for (const std::uint32_t number : instances_) {
      const auto& instance = scene_.instances[number];
      mapped_.clear();
      for (const std::size_t i : active_) mapped_.push_back(in_part(instance, points[i]));
      tree_of_part(scene_, number, 1).winding_numbers(mapped_, of_instance_, of_one_);
      for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k] += double{of_instance_[k]};
    }
    for (std::size_t k = 0; k < sums_.size(); ++k) numbers[active_[k]] = winding_of<T>(sums_[k]);
  }

 private:
  const Parts& scene_;
  std::span<const std::uint32_t> instances_;
  const WindingOptions& of_one_;
  std::vector<std::size_t> active_;
  std::vector<PointOf<T>> mapped_;
  std::vector<T> of_instance_;
  std::vector<double> sums_;
};

template <class Parts>
std::vector<std::uint32_t> seen_in_order(const Parts& scene, std::uint32_t mask) {
  std::vector<std::uint32_t> seen;
  each_seen(scene, mask, [&](std::uint32_t instance) { seen.push_back(instance); });
  std::ranges::sort(seen);
  return seen;
}

}  // namespace

template <class Parts, class T>
void sum_winding_numbers(const Parts& scene, const VertexRecords<T>& points, std::span<T> numbers,
                         const WindingOptions& options) {
  const CheckedPoints<T> call("winding_numbers", points, "numbers", numbers, options.active);
  require_accuracy(options.accuracy);
  checked_queries<T>("winding_numbers", options);
  require_triangles_seen("winding_numbers", scene, options.mask);
  const std::vector<std::uint32_t> seen = seen_in_order(scene, options.mask);
  for (const std::uint32_t i : seen) tree_of_part(scene, i, options.threads);
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(seen.size(), 1));
  BatchPlan plan{options.threads, options.counters};
  plan.min_part = 1, plan.progress = options.progress;
  over_parts(plan, (points.count + block_size - 1) / block_size,
             [&](std::size_t begin, std::size_t end, TraceCounters* counters) {
               WindingOptions of_one{.accuracy = options.accuracy * share, .path = options.path};
               of_one.counters = counters;
               SumsOfBlocks<Parts> sums(scene, seen, of_one);
               for (; begin < end; ++begin)
                 sums.find(points, call.active, begin * block_size,
                           std::min((begin + 1) * block_size, points.count), numbers);
             });
}

template void sum_winding_numbers(const SceneParts&, const VertexView&, std::span<float>,
                                  const WindingOptions&);
template void sum_winding_numbers(const SceneDParts&, const VertexViewD&, std::span<double>,
                                  const WindingOptions&);

}  // namespace raylanes
