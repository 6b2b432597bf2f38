// Hashes of rays that a row traces, whatever its signature: a tracer takes a batch, and fills in its hits and whether
// they are there.
#pragma once

#include "every_row.hpp"

namespace raylanes::testing {

template <class T>
using Tracer = std::function<void(const TraceBatchOf<T>&)>;

template <class T>
void say_which_hit(const TraceBatchOf<T>& batch) {
  for (std::size_t i = 0; i < batch.size; ++i) batch.occluded[i] = batch.hits[i] ? 1 : 0;
}

// By two rows of batches, which get as much scratch as they ask for; or by one that makes hits alone.
template <class T>
using BatchRow = void (*)(const TreeViewOf<T>& tree, const TraceBatchOf<T>& batch);
template <class T>
Tracer<T> by_batches(const TreeViewOf<T>& tree, BatchRow<T> closest, BatchRow<T> any,
                     std::size_t (*bytes)(std::size_t) = nullptr) {
  return [=](TraceBatchOf<T> batch) {
    const std::size_t size = bytes != nullptr ? bytes(batch.size) : 0;
    Scratch scratch(Scratch::bytes_of<std::byte>(size));
    batch.scratch = scratch.take<std::byte>(size);
    TraceBatchOf<T> nearest = batch, whether = batch;
    nearest.occluded = nullptr, whether.hits = nullptr;
    if (nearest.shared_point == SharedApex::end) nearest.shared_point = SharedApex::none;
    closest(tree, nearest);
    any != nullptr ? any(tree, whether) : say_which_hit(batch);
  };
}
inline Tracer<float> by_batches(const TreeView& tree, const TraversalRow& row) {
  return by_batches<float>(tree, row.closest, row.any, row.scratch_bytes);
}

// By rows of one ray: closest(ray, batch, i) and any(ray, batch, i).
template <class T, class Closest, class Any>
Tracer<T> by_calls(const Closest& closest, const Any& any) {
  return [=](const TraceBatchOf<T>& batch) {
    for (std::size_t i = 0; i < batch.size; ++i) {
      batch.hits[i] = closest(batch.rays[i], batch, i);
      batch.occluded[i] = any(batch.rays[i], batch, i) ? 1 : 0;
    }
  };
}
template <class T>
std::uint32_t skipped_by(const TraceBatchOf<T>& batch, std::size_t i) {
  return batch.skip != nullptr ? batch.skip[i] : no_primitive;
}

// The rules of a batch that a tracer follows: none; which sides and triangles count; also behind which hit.
enum class Rules { none, chosen, behind };

inline constexpr std::pair<Together, SharedApex> batches[] = {{Together::no, SharedApex::none},
                                                              {Together::no, SharedApex::origin},
                                                              {Together::from_eye, SharedApex::origin},
                                                              {Together::to_eye, SharedApex::end}};

template <class T>
void add_hits(Hash& hash, const Tracer<T>& trace, TraceBatchOf<T> batch, const std::vector<RayOf<T>>& rays,
              std::vector<HitOf<T>>& hits) {
  std::vector<std::uint8_t> occluded(rays.size(), 7);
  batch.rays = rays.data(), batch.size = rays.size(), batch.hits = hits.data(),
  batch.occluded = occluded.data();
  trace(batch);
  for (const HitOf<T>& hit : hits) hash.add(hit);
  hash.add(occluded);
}

// The hits of rays that have nothing in common, an origin or an end. counts: whether the row adds to the counters.
template <class T>
Hash hash_of_hits(const Tracer<T>& trace, Rules rules, bool counts = false) {
  Hash hash;
  TraceCounters counters;
  std::size_t found = 0;
  for (const auto& [together, apex] : batches)
    for (const Facing facing : {Facing::any, Facing::front, Facing::back})
      for (const std::size_t size : sizes) {
        if (facing != Facing::any && (rules == Rules::none || apex == SharedApex::end)) continue;
        std::vector<RayOf<T>> rays = some_rays<T>(together);
        rays.resize(size);
        TraceBatchOf<T> batch;
        batch.counters = &counters, batch.facing = facing;
        batch.shared_point = apex, batch.shared_end = as<T>(eye);
        std::vector<HitOf<T>> hits(size), first;
        add_hits(hash, trace, batch, rays, hits);
        for (const HitOf<T>& hit : hits) found += hit ? 1 : 0;
        if (rules == Rules::none) continue;
        first = hits;
        std::vector<std::uint32_t> skip;
        for (std::size_t i = 0; i < size; ++i) skip.push_back(i % 4 == 0 ? no_primitive : first[i].primitive);
        batch.skip = skip.data();
        add_hits(hash, trace, batch, rays, hits);
        if (rules == Rules::chosen) continue;
        batch.after = first.data();
        add_hits(hash, trace, batch, rays, hits);
        batch.skip = nullptr, hits = first;
        for (int layer = 0; layer < 2; ++layer) add_hits(hash, trace, batch, rays, hits), first = hits;
      }
  EXPECT_EQ(counters.triangle_tests > 0, counts);
  EXPECT_GT(found, 100u);
  return hash;
}

}  // namespace raylanes::testing
