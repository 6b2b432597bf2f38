// The next hits, and filters, which are loops over batches of these.
#include "checked_traversal.hpp"
#include "lists.hpp"

namespace raylanes {
namespace {

// Few enough for their hits to stay in the first levels of caches.
constexpr std::size_t rays_of_a_call = 1024;

void require_exact(const TraceOptions& options) {
  if (options.test != TriangleTest::exact)
    throw std::invalid_argument(
        "trace: what comes after a hit is asked of the test exact alone; others have no order of hits that "
        "holds");
}

// Rays whose hits were turned down, with these.
struct TurnedDown {
  std::vector<std::size_t> number;
  std::vector<Ray> rays;
  std::vector<Hit> hits;

  // Keeps those for whose places in the arrays it holds.
  template <class Holds>
  void keep(const Holds& holds) {
    std::size_t left = 0;
    for (std::size_t k = 0; k < number.size(); ++k) {
      if (!holds(k)) continue;
      number[left] = number[k], rays[left] = rays[k], hits[left++] = hits[k];
    }
    number.resize(left), rays.resize(left), hits.resize(left);
  }
};

// Asks the filter about the hits of some rays, by their numbers in the batch, and keeps those that it turns down.
void keep_turned_down(const HitFilter& filter, TurnedDown& some) {
  std::vector<std::uint8_t> rejected(some.number.size(), 0);
  if (!some.number.empty()) filter(some.number, some.hits, rejected);
  some.keep([&](std::size_t k) { return rejected[k] != 0; });
}

}  // namespace

void trace_next(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                const TraceOptions& options) {
  require_exact(options);
  require_size("trace", "after", options.after.count, "rays", rays.size());
  if (options.after.stride < sizeof(Hit) && options.after.count > 1)
    throw std::invalid_argument("trace: hits of after overlap");
  const QueryKernels& kernels = checked_queries("trace", options);
  const TreeView view = tree.view_for(TriangleTest::exact);
  over_calls(
      {options.threads, options.counters, rays_of_a_call, 256, 8}, rays, HitSink<Hit>{hits},
      [](std::size_t n) { return n * sizeof(Hit); },
      [&](const RayCall<Hit>& call) {
        Hit* const last = static_cast<Hit*>(call.scratch);  // hits may lie where answers go
        for (std::size_t k = 0; k < call.size; ++k) last[k] = options.after[call.indices[k]];
        TraceBatch batch;
        batch.rays = call.rays, batch.size = call.size, batch.hits = call.answers;
        batch.after = last, batch.counters = call.counters;
        kernels.next(view, batch);
      });
}

void TriangleTree::filtered_closest(RayView rays, HitView hits, const HitFilter& filter,
                                    const TraceOptions& options) const {
  require_exact(options);
  closest(rays, hits, options);
  if (!filter) return;
  const RaySource source{.records = rays, .active = options.active};
  TurnedDown some;
  for (std::size_t i = 0; i < rays.count; ++i) {
    const Hit hit = source.takes_part(i) ? hits[i] : Hit();
    if (!hit) continue;
    some.number.push_back(i), some.rays.push_back(rays[i]), some.hits.push_back(hit);
  }
  TraceOptions again = options;
  again.active = nullptr;
  for (;;) {
    keep_turned_down(filter, some);
    if (some.number.empty()) return;
    again.after = some.hits;
    trace_next(traced(), {.records = some.rays}, some.hits, again);
    for (std::size_t k = 0; k < some.number.size(); ++k) hits.set(some.number[k], some.hits[k]);
    some.keep([&](std::size_t k) { return static_cast<bool>(some.hits[k]); });
  }
}

void TriangleTree::filtered_occluded(RayView rays, std::span<std::uint8_t> occluded, const HitFilter& filter,
                                     const TraceOptions& options) const {
  require_size("trace", "occluded", occluded.size(), "rays", rays.count);
  std::vector<Hit> hits(rays.count);
  TraceOptions from_the_first = options;
  from_the_first.after = {};  // of closest() only
  closest(rays, hits, filter, from_the_first);
  const RaySource source{.records = rays, .active = options.active};
  for (std::size_t i = 0; i < rays.count; ++i)
    if (source.takes_part(i)) occluded[i] = hits[i] ? 1 : 0;
}

}  // namespace raylanes
