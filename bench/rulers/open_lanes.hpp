// How often the exact test's floats, and then its doubles, leave a decision open.
#pragma once

#include <cstdint>
#include <span>

#include <raylanes/bvh.hpp>
#include <raylanes/triangles.hpp>
#include <raylanes/types.hpp>

namespace raylanes::bench {

struct OpenLanes {
  std::uint64_t tests = 0;         // of a ray and a triangle
  std::uint64_t after_floats = 0;  // neither surely hit nor surely not, t included
  std::uint64_t after_doubles = 0;
  double per_million(std::uint64_t OpenLanes::*of) const {
    return tests == 0 ? 0.0 : 1e6 * static_cast<double>(this->*of) / static_cast<double>(tests);
  }
};

// Counts of the triangles that nearest hits are sought among, one by one, in a tree of its own.
class OpenLaneCounter {
 public:
  explicit OpenLaneCounter(const Mesh& mesh) : tree_(mesh) {}
  OpenLanes count(std::span<const Ray> rays) const;

 private:
  Bvh tree_;
};

// Of one ray and one triangle, added to `lanes`.
void add_open_lane(const Ray& ray, const Triangle& triangle, OpenLanes& lanes);

}  // namespace raylanes::bench
