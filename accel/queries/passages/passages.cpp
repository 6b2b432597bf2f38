#include "passages.hpp"

#include "../checked_traversal.hpp"

namespace raylanes {

Hit TriangleTree::closest_crossing(const Ray& ray, const TraceOptions& options) const {
  require_exact(options);
  return closest_passage<float>(*this, ray, options);
}
void TriangleTree::closest_crossing(RayView rays, HitView hits, const TraceOptions& options) const {
  require_exact(options);
  closest_passages<float>(*this, traced(), {.records = rays, .active = options.active, .skip = options.skip},
                          hits, options);
}
void TriangleTree::closest_crossing(const RayArrays& rays, HitView hits, const TraceOptions& options) const {
  require_exact(options);
  closest_passages<float>(*this, traced(), {.arrays = &rays, .active = options.active, .skip = options.skip},
                          hits, options);
}

}  // namespace raylanes
