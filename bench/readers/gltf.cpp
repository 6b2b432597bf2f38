#include <assimp/scene.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <assimp/Importer.hpp>

#include "mesh_formats.hpp"

namespace raylanes::bench {
namespace {

void append_vertices(Mesh& mesh, const aiMesh& part, const aiMatrix4x4& to_world) {
  // Without a transformation the bits of the file must stay, -0 included.
  const bool identity = to_world.IsIdentity();
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D p = identity ? part.mVertices[i] : to_world * part.mVertices[i];
    mesh.vertices.push_back({p.x, p.y, p.z});
  }
}

void append_part(Mesh& mesh, const aiMesh& part, const aiMatrix4x4& to_world) {
  const std::size_t first = mesh.vertices.size();
  if (first + part.mNumVertices > std::numeric_limits<std::uint32_t>::max())
    throw std::runtime_error("has more than 4294967295 vertices");
  append_vertices(mesh, part, to_world);
  std::vector<std::size_t> corners;
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices < 3) continue;  // a point or a line
    corners.clear();
    for (unsigned k = 0; k < face.mNumIndices; ++k) corners.push_back(first + face.mIndices[k]);
    append_fan(mesh, corners, "mesh '" + std::string(part.mName.C_Str()) + "' face " + std::to_string(i));
  }
}

Mesh flatten(const aiScene& scene) {
  Mesh mesh;
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> pending{{scene.mRootNode, aiMatrix4x4()}};
  while (!pending.empty()) {
    const auto [node, parent_to_world] = pending.back();
    pending.pop_back();
    if (!node) continue;
    const aiMatrix4x4 to_world = parent_to_world * node->mTransformation;
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
      append_part(mesh, *scene.mMeshes[node->mMeshes[i]], to_world);
    for (unsigned i = node->mNumChildren; i-- > 0;) pending.emplace_back(node->mChildren[i], to_world);
  }
  return mesh;
}

}  // namespace

Mesh read_gltf(const std::filesystem::path& file) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (!scene) {
    std::string message = importer.GetErrorString();
    std::replace(message.begin(), message.end(), '\n', ' ');
    throw std::runtime_error("cannot be read: " + message);
  }
  return flatten(*scene);
}

}  // namespace raylanes::bench
