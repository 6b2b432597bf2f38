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

// The answers to rays in every form of batch, asked by lists of hits behind the search, or by each hit during it.
template <class AnyHit, class Tree, class AnyRay, class Options>
struct FilteredBatch {
  std::vector<AnyHit> records, arrays;
  std::vector<std::uint8_t> dark_records, dark_arrays, shadows, towards;

  // Shadows are of points, from the first origin and in the first direction.
  template <class Rejects>
  FilteredBatch(const Tree& tree, const std::vector<AnyRay>& rays,
                const std::vector<decltype(AnyRay::origin)>& points, const Options& options,
                const Rejects& rejects)
      : records(rays.size()),
        arrays(rays.size()),
        dark_records(rays.size(), 9),
        dark_arrays(rays.size(), 9),
        shadows(rays.size(), 9),
        towards(rays.size(), 9) {
    const RayColumns columns(rays);
    tree.closest(rays, records, rejects, options);
    tree.closest(columns.view(), arrays, rejects, options);
    tree.occluded(rays, dark_records, rejects, options);
    tree.occluded(columns.view(), dark_arrays, rejects, options);
    tree.occluded_from(rays[0].origin, points, shadows, rejects, {}, options);
    tree.occluded_towards(rays[0].direction, points, towards, rejects, options);
  }
  void expect(std::size_t i, const AnyHit& wanted, bool is_shadowed, bool is_shadowed_towards) const {
    EXPECT_TRUE(same_bytes(records[i], wanted)) << "ray " << i;
    EXPECT_TRUE(same_bytes(arrays[i], wanted)) << "ray " << i;
    EXPECT_EQ(dark_records[i], wanted ? 1 : 0) << "ray " << i;
    EXPECT_EQ(dark_arrays[i], wanted ? 1 : 0) << "ray " << i;
    EXPECT_EQ(shadows[i], is_shadowed ? 1 : 0) << "point " << i;
    EXPECT_EQ(towards[i], is_shadowed_towards ? 1 : 0) << "point " << i;
  }
};

// all_of(ray) are all hits of a ray in order.
template <class AnyHit, class Tree, class AnyRay, class Options, class AllOf>
void expect_filtered(const Tree& tree, const std::vector<AnyRay>& rays, const Options& options,
                     const AllOf& all_of) {
  using Number = typename RayColumns<AnyRay>::Number;
  const auto filter = [](std::span<const std::size_t> some, std::span<const AnyHit> hits,
                         std::span<std::uint8_t> rejected) {
    for (std::size_t k = 0; k < some.size(); ++k) rejected[k] = keeps(some[k], hits[k]) ? 0 : 1;
  };
  const auto rejects_any = [](std::size_t ray, const AnyHit& hit) { return !keeps(ray, hit); };
  const std::size_t n = rays.size();
  // Points before and behind.
  std::vector<decltype(AnyRay::origin)> points(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) points[i][k] = rays[i].origin[k] + 2 * rays[i].direction[k];
  const FilteredBatch<AnyHit, Tree, AnyRay, Options> behind(tree, rays, points, options, filter),
      within(tree, rays, points, options, rejects_any);
  std::size_t turned_down = 0;
  for (std::size_t i = 0; i < n && !::testing::Test::HasFailure(); ++i) {
    const std::vector<AnyHit> all = all_of(rays[i]);
    const AnyHit wanted = first_kept(i, all);
    turned_down += !all.empty() && !same_bytes(all[0], wanted) ? 1 : 0;
    const auto rejects = [&](const AnyHit& hit) {
      const auto is_this = [&](const AnyHit& other) { return same_bytes(hit, other); };
      EXPECT_TRUE(std::ranges::any_of(all, is_this)) << "ray " << i << ", primitive " << hit.primitive;
      return !keeps(i, hit);
    };
    EXPECT_TRUE(same_bytes(tree.closest(rays[i], rejects, options), wanted)) << "ray " << i;
    EXPECT_EQ(tree.occluded(rays[i], rejects, options), static_cast<bool>(wanted)) << "ray " << i;
    const auto is_shadowed = [&](const AnyRay& ray) { return static_cast<bool>(first_kept(i, all_of(ray))); };
    const bool from = is_shadowed(segment_to<Number>(rays[0].origin, points[i])),
               towards =
                   is_shadowed({points[i], 0, rays[0].direction, std::numeric_limits<Number>::infinity()});
    behind.expect(i, wanted, from, towards), within.expect(i, wanted, from, towards);
  }
  EXPECT_GT(turned_down, n / 50);
}

}  // namespace raylanes::testing
