// Filters in every form of call: batches of records and of arrays, segments from a point, single rays.
#pragma once

#include <raylanes/numbers.hpp>

#include "../traverse/reference/segment_to.hpp"
#include "same_bytes.hpp"

namespace raylanes::testing {

// Rays as one array per number.
template <class AnyRay>
struct RayColumns {
  using Number = std::remove_const_t<decltype(AnyRay::tmin)>;
  std::vector<Number> column[8];

  explicit RayColumns(const std::vector<AnyRay>& rays) {
    for (const AnyRay& ray : rays) {
      for (std::size_t k = 0; k < 3; ++k)
        column[k].push_back(ray.origin[k]), column[3 + k].push_back(ray.direction[k]);
      column[6].push_back(ray.tmin), column[7].push_back(ray.tmax);
    }
  }
  RayArraysOf<Number> view() const {
    const auto at = [&](std::size_t k) { return column[k].data(); };
    return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, at(6), at(7), column[0].size()};
  }
};

// A rule that keeps some hits of some rays.
template <class AnyHit>
bool keeps(std::size_t ray, const AnyHit& hit) {
  return (hit.primitive * 7 + ray) % 3 == 0;
}

// A filter that rejects the hits of primitives with an even index.
template <class AnyHit>
void reject_even(std::span<const std::size_t>, std::span<const AnyHit> hits,
                 std::span<std::uint8_t> rejected) {
  for (std::size_t k = 0; k < hits.size(); ++k) rejected[k] = hits[k].primitive % 2 == 0 ? 1 : 0;
}

// The first hit that is kept, or a miss.
template <class AnyHit>
AnyHit first_kept(std::size_t ray, const std::vector<AnyHit>& all) {
  const auto kept = std::ranges::find_if(all, [&](const AnyHit& hit) { return keeps(ray, hit); });
  return kept != all.end() ? *kept : AnyHit();
}

// all_of(ray) are all hits of a ray in order.
template <class AnyHit, class Tree, class AnyRay, class Options, class AllOf>
void expect_filtered(const Tree& tree, const std::vector<AnyRay>& rays, const Options& options,
                     const AllOf& all_of) {
  const auto filter = [](std::span<const std::size_t> some, std::span<const AnyHit> hits,
                         std::span<std::uint8_t> rejected) {
    for (std::size_t k = 0; k < some.size(); ++k) rejected[k] = keeps(some[k], hits[k]) ? 0 : 1;
  };
  const std::size_t n = rays.size();
  const RayColumns columns(rays);
  std::vector<AnyHit> records(n), arrays(n);
  std::vector<std::uint8_t> dark_records(n, 9), dark_arrays(n, 9);
  tree.closest(rays, records, filter, options);
  tree.closest(columns.view(), arrays, filter, options);
  tree.occluded(rays, dark_records, filter, options);
  tree.occluded(columns.view(), dark_arrays, filter, options);
  std::size_t turned_down = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<AnyHit> all = all_of(rays[i]);
    const AnyHit wanted = first_kept(i, all);
    turned_down += !all.empty() && !same_bytes(all[0], wanted) ? 1 : 0;
    const auto rejects = [&](const AnyHit& hit) {
      const auto is_this = [&](const AnyHit& other) { return same_bytes(hit, other); };
      EXPECT_TRUE(std::ranges::any_of(all, is_this)) << "ray " << i << ", primitive " << hit.primitive;
      return !keeps(i, hit);
    };
    ASSERT_TRUE(same_bytes(records[i], wanted)) << "ray " << i;
    ASSERT_TRUE(same_bytes(arrays[i], wanted)) << "ray " << i;
    ASSERT_TRUE(same_bytes(tree.closest(rays[i], rejects, options), wanted)) << "ray " << i;
    ASSERT_EQ(tree.occluded(rays[i], rejects, options), static_cast<bool>(wanted)) << "ray " << i;
    ASSERT_EQ(dark_records[i], wanted ? 1 : 0) << "ray " << i;
    ASSERT_EQ(dark_arrays[i], wanted ? 1 : 0) << "ray " << i;
  }
  EXPECT_GT(turned_down, n / 50);
  // From the first origin to points before and behind.
  std::vector<decltype(AnyRay::origin)> points(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) points[i][k] = rays[i].origin[k] + 2 * rays[i].direction[k];
  std::vector<std::uint8_t> shadows(n, 9);
  tree.occluded_from(rays[0].origin, points, shadows, filter, {}, options);
  for (std::size_t i = 0; i < n; ++i) {
    const AnyRay segment = segment_to<typename RayColumns<AnyRay>::Number>(rays[0].origin, points[i]);
    ASSERT_EQ(shadows[i], first_kept(i, all_of(segment)) ? 1 : 0) << "point " << i;
  }
}

}  // namespace raylanes::testing
