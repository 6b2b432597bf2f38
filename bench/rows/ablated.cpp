#include "ablated.hpp"

#include "../../dispatch/table/traversal.hpp"
#include "../support/rulers/kernel_view.hpp"
#include "../support/rulers/of_path.hpp"

namespace raylanes {
namespace detail {

#define RAYLANES_DECLARE(path) extern const bench::AblatedSearches path##_ablated;
RAYLANES_EACH_PATH(RAYLANES_DECLARE)

}  // namespace detail

namespace bench {
namespace {

#define RAYLANES_ABLATED(path) &detail::path##_ablated,
const AblatedSearches* const searches[] = {RAYLANES_EACH_PATH(RAYLANES_ABLATED)};

}  // namespace

void trace_ablated(const Bvh& bvh, std::span<const Ray> rays, bool front_to_back, bool culls,
                   const Path* path, std::span<Hit> hits, TraceCounters& counters) {
  TraceBatch batch;
  batch.rays = rays.data(), batch.size = rays.size(), batch.hits = hits.data(), batch.counters = &counters;
  of_path(path != nullptr ? *path : active_path(), searches)
      .closest[front_to_back][culls](kernel_view(bvh), batch);
}

}  // namespace bench
}  // namespace raylanes
