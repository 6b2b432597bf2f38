#include "ray_lists.hpp"

#include "answers/surface_answers.hpp"
#include "traced_tree.hpp"

namespace raylanes {
namespace {

// Entries that kernels keep before they add them to counts: few enough to stay in the first level of caches.
constexpr std::size_t room_for_counts = 1024;

}  // namespace

void count_in_kernels(const ListMaker<float>& maker, const RaySource& rays, std::size_t begin,
                      std::size_t end, TraceCounters* counters, std::span<CrossingCount> counts) {
  const std::size_t max_rays = ListRoom<float>::rays_of_a_call(maker, end - begin);
  const bool together = ListRoom<float>::goes_together(maker, max_rays);
  Scratch memory(ActiveRays<RaySource>::bytes(rays, max_rays) + Scratch::bytes_of<CrossingCount>(max_rays));
  ActiveRays active(rays, max_rays, memory);
  Array<ListEntryOf<float>> list(together ? 0 : room_for_counts);
  Array<std::byte> scratch(together ? maker.kernels.scratch_bytes(max_rays, room_for_counts) : 0);
  ListBatch batch;
  batch.kind = maker.kind, batch.list = list.data(), batch.room = room_for_counts;
  batch.counts = memory.take<CrossingCount>(max_rays), batch.scratch = scratch.data(),
  batch.counters = counters, batch.facing = maker.facing, batch.masks = maker.masks;
  for (; begin < end; begin += max_rays) {
    active.load(begin, std::min(max_rays, end - begin));
    batch.rays = active.rays, batch.size = active.size, batch.skip = active.skip;
    (together ? maker.kernels.list_together : maker.kernels.list)(maker.tree, batch);
    for (std::size_t i = 0; i < batch.size; ++i) counts[active.indices[i]] = batch.counts[i];
  }
}

template <>
struct SurfaceDoor<TriangleTree> : SurfaceOfTree<float, TracedTree> {
  explicit SurfaceDoor(const TriangleTree& tree) : SurfaceOfTree(TreeAccess::traced(tree)) {}
  static void require_closest_crossing(const TraceOptions& options) { require_exact(options); }
};
template class SurfaceQueries<TriangleTree>;

}  // namespace raylanes
