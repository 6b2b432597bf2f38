// Any rays, one a call, whose callers reject hits.
#pragma once

#include "../support/same_bytes.hpp"
#include "support.hpp"

namespace raylanes::testing {

// hits[i] are the hits of ray i in order, but for the skipped ones.
template <class Tree, class AnyRay, class AnyHit, class Options>
void expect_kept(const Tree& tree, const std::vector<AnyRay>& rays,
                 const std::vector<std::vector<AnyHit>>& hits, const Options& options) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Options of_ray = options;
    of_ray.skip = {};
    const std::uint32_t skipped = options.skip.first != nullptr ? options.skip[i] : no_primitive;
    if (options.skip.first != nullptr) of_ray.skip = skipped;
    const std::uint32_t divisor = 1 + static_cast<std::uint32_t>(i) % 4;
    const auto keeps = [&](const AnyHit& hit) { return hit.primitive % divisor != 0 || divisor == 4; };
    const auto rejects = [&](const AnyHit& hit) {
      if (std::ranges::none_of(hits[i], [&](const AnyHit& other) { return same_bytes(hit, other); }))
        fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": asked about no hit");
      return !keeps(hit);
    };
    const auto first = std::ranges::find_if(hits[i], keeps);
    const AnyHit wanted = first == hits[i].end() ? AnyHit() : *first;
    if (!same_bytes(tree.closest(rays[i], rejects, of_ray), wanted) ||
        tree.occluded(rays[i], rejects, of_ray) != static_cast<bool>(wanted))
      fail(std::string(options.path->name) + ": ray " + std::to_string(i) + ": another hit is kept");
  }
}

}  // namespace raylanes::testing
