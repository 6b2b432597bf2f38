// Scenes: what they report of themselves.
#include <raylanes/scene.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "scene_parts.hpp"

namespace raylanes {

Box Scene::bounds() const noexcept {
  const QuietFloats quiet;
  Box all = empty_box;
  for (const TopLevel& top : parts().tops) extend(all, top.tree.bounds);
  if (!parts().traces_common) return all;
  for (const auto& tree : parts().commons)
    for (const Member& member : tree->members)
      if (!member.is_struck) extend(all, member.box);
  return all;
}
std::size_t Scene::bytes() const noexcept {
  std::size_t bytes = parts().instances.size() * sizeof(Instance);
  for (const TopLevel& top : parts().tops) bytes += top.bytes();
  for (const auto& tree : parts().commons) bytes += tree->bytes();
  return bytes;
}
SceneReport Scene::report() const noexcept {
  SceneReport report;
  for (const auto& geometry : parts().geometries)
    report.mesh_triangles += geometry->mesh_triangles(),
        report.meshes_without_tree += geometry->has_tree() ? 0 : 1;
  for (const auto& tree : parts().commons) {
    report.common_bytes += tree->bytes();
    if (!parts().traces_common) continue;
    ++report.common_trees;
    report.common_instances += tree->members_left();
    report.common_triangles += tree->triangles - tree->struck;
  }
  return report;
}

}  // namespace raylanes
