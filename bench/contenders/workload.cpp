#include "workload.hpp"

namespace raylanes::bench {
namespace {

constexpr std::uint64_t bounce_seed = 1;

// The rays of pixels, so many for each, in the order of these.
std::vector<Ray> ordered(const std::vector<Ray>& rays, const std::vector<std::size_t>& pixels,
                         std::uint32_t samples) {
  std::vector<Ray> ordered;
  ordered.reserve(rays.size());
  for (const std::size_t pixel : pixels)
    for (std::size_t i = pixel * samples; i < (pixel + 1) * samples; ++i) ordered.push_back(rays[i]);
  return ordered;
}

}  // namespace

Workload::Workload(const Scene& scene, const Bvh& bvh, std::uint32_t width, std::uint32_t height,
                   PixelOrder order, std::uint32_t samples)
    : scene_(scene),
      primary_(ordered(primary_rays(scene.camera, width, height, samples), pixels_in(order, width, height),
                       samples)),
      hits_(primary_.size()),
      light_(default_light(scene)) {
  bvh.closest(primary_, hits_);
}

std::vector<std::uint32_t> Workload::left() const {
  std::vector<std::uint32_t> left;
  for (const std::size_t i : secondary_origins(hits_, scene_.mesh)) left.push_back(hits_[i].primitive);
  return left;
}

RaySet Workload::rays(RayKind kind) const {
  switch (kind) {
    case RayKind::primary:
      return {"primary", Query::closest, primary_};
    case RayKind::shadow:
      return {"shadow", Query::any, shadow_rays(hits_, scene_.mesh, light_), left()};
    case RayKind::light:
      return {"light", Query::any, rays_from_light(shadow_rays(hits_, scene_.mesh, light_), light_)};
    case RayKind::diffuse:
      return {"diffuse", Query::closest, diffuse_rays(primary_, hits_, scene_.mesh, bounce_seed), left()};
    case RayKind::ao:
      return {"ao", Query::any, ambient_occlusion_rays(primary_, hits_, scene_.mesh, bounce_seed), left()};
    case RayKind::random:
      return {"random", Query::closest, random_rays(scene_.mesh, primary_.size(), bounce_seed)};
  }
  throw std::invalid_argument("rays: unknown kind " + std::to_string(static_cast<int>(kind)));
}

}  // namespace raylanes::bench
