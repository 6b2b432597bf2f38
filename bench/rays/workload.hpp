// The rays that a scene is traced with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <raylanes/bvh.hpp>

#include "ray_sets.hpp"

namespace raylanes::bench {

enum class Query { closest, any };

struct RaySet {
  std::string name;
  Query query;
  std::vector<Ray> rays;
};

inline constexpr std::array<std::string_view, 4> ray_set_names{"primary", "shadow", "diffuse", "ao"};

// The rays of a scene at a resolution, made once from the primary hits of the default kernels (watertight,
// reproducible), so that all contenders trace the same ones.
class Workload {
 public:
  Workload(const Scene& scene, const Bvh& bvh, std::uint32_t width, std::uint32_t height);

  // One of ray_set_names: primary and diffuse ask for the closest hit, shadow and ao for any.
  RaySet rays(std::string_view name) const;

  const std::vector<Ray>& primary() const { return primary_; }
  const std::vector<Hit>& primary_hits() const { return hits_; }
  const Float3& light() const { return light_; }

 private:
  const Scene& scene_;
  std::vector<Ray> primary_;
  std::vector<Hit> hits_;
  Float3 light_;
};

}  // namespace raylanes::bench
