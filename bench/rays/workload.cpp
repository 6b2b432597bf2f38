#include "workload.hpp"

#include "../tool/commands.hpp"

namespace raylanes::bench {
namespace {

constexpr std::uint64_t bounce_seed = 1;

}  // namespace

Workload::Workload(const Scene& scene, const Bvh& bvh, std::uint32_t width, std::uint32_t height)
    : scene_(scene),
      primary_(primary_rays(scene.camera, width, height)),
      hits_(primary_.size()),
      light_(default_light(scene)) {
  bvh.closest(primary_, hits_);
}

RaySet Workload::rays(std::string_view name) const {
  switch (index_of("--rays", name, ray_set_names)) {
    case 0:
      return {"primary", Query::closest, primary_};
    case 1:
      return {"shadow", Query::any, shadow_rays(hits_, scene_.mesh, light_)};
    case 2:
      return {"diffuse", Query::closest, diffuse_rays(primary_, hits_, scene_.mesh, bounce_seed)};
    default:
      return {"ao", Query::any, ambient_occlusion_rays(primary_, hits_, scene_.mesh, bounce_seed)};
  }
}

}  // namespace raylanes::bench
