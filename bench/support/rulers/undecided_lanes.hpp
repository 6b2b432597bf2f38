// How often the exact test's floats, and then its doubles, leave a lane undecided.
#pragma once

#include <raylanes/bvh.hpp>
#include <raylanes/triangles.hpp>
#include <raylanes/types.hpp>

#include "../std.hpp"

namespace raylanes::bench {

struct UndecidedLanes {
  std::uint64_t tests = 0;         // of a ray and a triangle
  std::uint64_t after_floats = 0;  // neither a certain hit nor a certain miss, t included
  std::uint64_t after_doubles = 0;
  double per_million(std::uint64_t UndecidedLanes::*of) const {
    return tests == 0 ? 0.0 : 1e6 * static_cast<double>(this->*of) / static_cast<double>(tests);
  }
};

// Counts undecided lanes of single rays for nearest hits, in a tree of its own.
class UndecidedLaneCounter {
 public:
  explicit UndecidedLaneCounter(const Mesh& mesh) : tree_(mesh) {}
  UndecidedLanes count(std::span<const Ray> rays) const;

 private:
  Bvh tree_;
};

// Adds the lane of one ray and one triangle to `lanes`.
void add_undecided_lane(const Ray& ray, const Triangle& triangle, UndecidedLanes& lanes);

}  // namespace raylanes::bench
