// Questions beyond the nearest hit, of one path: compiled once per path with its flags and back end; the table is the
// only symbol that leaves the object.
#include "../traverse/fused/calls.hpp"
#include "../traverse/transform.hpp"
#include "../triangle/all_tests.hpp"
#include "axis_ray.hpp"
#include "hit_after.hpp"
#include "hit_lists.hpp"
#include "kept_streams.hpp"
#include "list_streams.hpp"
#include "rays_at_spheres.hpp"
#include "visit_packets.hpp"

namespace raylanes {
namespace {

using ExactTest = Exact<Grade::reproducible>;

template <class Counters>
constexpr QueryKernels kernels_with() {
  QueryKernels kernels{};
  kernels.list = list_all<WalksLists, AllHits<HitStore<float>>, Counters>;
  kernels.list_along_axes = list_all<WalksAlongAxes, HitsAsStored, Counters>;
  kernels.closest_after = hits_after<Counters>;
  kernels.visit = visit_boxes<Counters>;
  kernels.closest_sphere = closest_sphere<Counters>;
  return kernels;
}

constexpr AllQueryKernels all_queries() {
  AllQueryKernels kernels{};
  kernels.plain = kernels_with<NoCounters>();
  kernels.plain.ruled_single = SingleRows<WalksNodes, NoCounters, HitRule>().template operator()<ExactTest>();
  kernels.plain.ruled_stream = {closest_stream<ExactTest, NoCounters, HitRule>,
                                any_stream<ExactTest, NoCounters, HitRule>, OctantScratch::bytes};
  kernels.plain.ruled_call = {closest_by_rule<ExactTest>, any_by_rule<ExactTest>, nearer_by_rule<ExactTest>};
  kernels.plain.kept = {closest_kept, any_kept};
  kernels.plain.kept_together = kept_together;
  kernels.plain.list_together = list_together<NoCounters>;
  kernels.plain.scratch_bytes = list_scratch_bytes;
  kernels.plain.visit_ray = visit_ray;
  kernels.plain.visit_spheres = visit_spheres;
  if constexpr (RAYLANES_COUNTERS) {
    kernels.counted = kernels_with<CountTests>();
    kernels.counted.ruled_single = {kernels.counted.closest_after,
                                    any_single<WalksNodes, ExactTest, CountTests, HitRule>, no_scratch};
  }
  kernels.map_rays = map_rays;
  return kernels;
}

}  // namespace

RAYLANES_UNIT_TABLE(AllQueryKernels, queries, all_queries())
}  // namespace raylanes
