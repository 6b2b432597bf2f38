// Any rays, one a call and together, whose callers reject hits.
#pragma once

#include "../support/same_bytes.hpp"
#include "support.hpp"

namespace raylanes::testing {

// Whether ray i keeps a hit.
template <class AnyHit>
bool keeps_in_fuzz(std::size_t i, const AnyHit& hit) {
  const std::uint32_t divisor = 1 + static_cast<std::uint32_t>(i) % 4;
  return hit.primitive % divisor != 0 || divisor == 4;
}

// hits[i] are the hits of ray i in order, but for the skipped ones.
template <class Tree, class AnyRay, class AnyHit, class Options>
void expect_kept(const Tree& tree, const std::vector<AnyRay>& rays,
                 const std::vector<std::vector<AnyHit>>& hits, const Options& options) {
  const std::size_t n = rays.size();
  const auto failed = [&](std::size_t i, const char* what) {
    fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": " + what);
  };
  const auto rejects_of = [&](std::size_t i, const AnyHit& hit) {
    if (std::ranges::none_of(hits[i], [&](const AnyHit& other) { return same_bytes(hit, other); }))
      failed(i, "asked about no hit");
    return !keeps_in_fuzz(i, hit);
  };
  std::vector<AnyHit> together(n);
  std::vector<std::uint8_t> occluded(n, 9);
  Options of_batch = options;
  if constexpr (requires { of_batch.mode; })
    if (n % 2 == 0) of_batch.mode = TraversalMode::stream;
  tree.closest(rays, together, rejects_of, of_batch);
  tree.occluded(rays, occluded, rejects_of, of_batch);
  for (std::size_t i = 0; i < n; ++i) {
    Options of_ray = options;
    of_ray.skip = {};
    const std::uint32_t skipped = options.skip.first != nullptr ? options.skip[i] : no_primitive;
    if (options.skip.first != nullptr) of_ray.skip = skipped;
    const auto rejects = [&](const AnyHit& hit) { return rejects_of(i, hit); };
    const auto first =
        std::ranges::find_if(hits[i], [&](const AnyHit& hit) { return keeps_in_fuzz(i, hit); });
    const AnyHit wanted = first == hits[i].end() ? AnyHit() : *first;
    if (!same_bytes(tree.closest(rays[i], rejects, of_ray), wanted) ||
        tree.occluded(rays[i], rejects, of_ray) != static_cast<bool>(wanted))
      failed(i, "another hit is kept");
    if (!same_bytes(together[i], wanted) || occluded[i] != (wanted ? 1 : 0))
      failed(i, "another hit is kept in a batch");
  }
}

}  // namespace raylanes::testing
