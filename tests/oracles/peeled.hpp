// All answers of rays, asked for again and again behind the last ones.
#pragma once

#include "../support/same_bytes.hpp"

namespace raylanes::testing {

// closest(rays, hits, options) and closest(ray, options) must give the expected answers of each ray one behind the
// other, then misses; of some rays alone, too. Returns how many there are.
template <class AnyRay, class AnyHit, class Options, class Closest>
std::size_t expect_peeled(const std::vector<AnyRay>& rays, const std::vector<std::vector<AnyHit>>& expected,
                          const Options& options, const Closest& closest) {
  AnyHit before_all;
  before_all.t = -std::numeric_limits<decltype(before_all.t)>::infinity(), before_all.primitive = 0;
  std::vector<AnyHit> hits(rays.size()), first(rays.size(), before_all);
  closest(rays, hits, options);
  Options behind = options;
  behind.after = first;
  closest(rays, first, behind);
  EXPECT_TRUE(same_bytes(first, hits));
  std::size_t found = 0, most = 0;
  for (const std::vector<AnyHit>& all : expected) most = std::max(most, all.size());
  for (std::size_t layer = 0; layer <= most; ++layer) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool is_right = same_bytes(hits[i], layer < expected[i].size() ? expected[i][layer] : AnyHit());
      EXPECT_TRUE(is_right) << "ray " << i << ", layer " << layer << " of " << expected[i].size() << ", t "
                            << hits[i].t;
      if (!is_right) return found;
      found += hits[i] ? 1 : 0;
    }
    const std::vector<AnyHit> last = hits;
    behind.after = hits;
    closest(rays, hits, behind);
    for (std::size_t i = layer % 17; i < rays.size(); i += 17) {
      behind.after = last[i];
      EXPECT_TRUE(same_bytes(closest(rays[i], behind), hits[i])) << "ray " << i << " alone, layer " << layer;
    }
  }
  return found;
}
// As expect_peeled() asks: rays among all, and a ray alone, which skips what it skips there.
template <class AnyRay, class Skip, class Call>
auto skipping(const std::vector<AnyRay>& rays, const std::vector<Skip>& skip, const Call& call) {
  return [&rays, &skip, call](const auto& from, auto&&... rest) {
    if constexpr (sizeof...(rest) == 2) {
      call(from, rest...);
    } else {
      auto options = (rest, ...);
      if (options.skip.first != nullptr) options.skip = skip[static_cast<std::size_t>(&from - rays.data())];
      return call(from, options);
    }
  };
}
// Asks a tree or a scene for hits, or for closest crossings.
template <class Tree, class AnyRay, class Skip>
auto hits_of(const Tree& tree, const std::vector<AnyRay>& rays, const std::vector<Skip>& skip) {
  return skipping(rays, skip, [&tree](auto&&... call) { return tree.closest(call...); });
}
template <class Tree, class AnyRay, class Skip>
auto closest_crossings_of(const Tree& tree, const std::vector<AnyRay>& rays, const std::vector<Skip>& skip) {
  return skipping(rays, skip, [&tree](auto&&... call) { return tree.closest_crossing(call...); });
}
// all_of(ray) gives the expected answers.
template <class AnyHit, class AnyRay, class Options, class Closest, class AllOf>
void expect_peeled(const std::vector<AnyRay>& rays, const Options& options, const Closest& closest,
                   const AllOf& all_of) {
  std::vector<std::vector<AnyHit>> expected;
  for (const AnyRay& ray : rays) expected.push_back(all_of(ray));
  EXPECT_GT(expect_peeled(rays, expected, options, closest), 2u);
}

}  // namespace raylanes::testing
