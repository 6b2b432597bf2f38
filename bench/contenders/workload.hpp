// The rays that a scene is traced with.
#pragma once

#include <raylanes/bvh.hpp>

#include "../support/rays/ray_sets.hpp"

namespace raylanes::bench {

enum class Query { closest, any };

struct RaySet {
  std::string name;
  Query query;
  std::vector<Ray> rays;
  std::vector<std::uint32_t> left =
      {};  // the triangle that each ray begins on; empty if rays begin elsewhere
};

enum class RayKind : std::uint8_t { primary, shadow, light, diffuse, ao, random };
inline constexpr std::array<std::string_view, 6> ray_kind_names{"primary", "shadow", "light",
                                                                "diffuse", "ao",     "random"};
inline std::string name_of(RayKind kind) {
  return std::string(ray_kind_names[static_cast<std::size_t>(kind)]);
}

// Whether neighbouring rays go everywhere.
inline bool are_scattered(RayKind kind) {
  return kind == RayKind::diffuse || kind == RayKind::ao || kind == RayKind::random;
}

// The rays of a scene at a resolution, made once from the primary hits of the default kernels (watertight,
// reproducible), so that all contenders trace the same ones.
class Workload {
 public:
  // Secondary rays come in the order of the primary ones; the rays of a pixel stay together.
  Workload(const Scene& scene, const Bvh& bvh, std::uint32_t width, std::uint32_t height,
           PixelOrder order = PixelOrder::rows, std::uint32_t samples = 1);

  // Primary, diffuse and random rays ask for the closest hit; there are as many random rays as primary ones. Shadow,
  // light (the same the other way, from the light) and ao (ambient occlusion) ask for any.
  RaySet rays(RayKind kind) const;

  const std::vector<Ray>& primary() const { return primary_; }
  const std::vector<Hit>& primary_hits() const { return hits_; }
  const Float3& light() const { return light_; }

 private:
  std::vector<std::uint32_t> left() const;

  const Scene& scene_;
  std::vector<Ray> primary_;
  std::vector<Hit> hits_;
  Float3 light_;
};

}  // namespace raylanes::bench
