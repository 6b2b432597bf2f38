// The triangles of all meshes of a scene as one mesh.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "scene.hpp"

namespace embree {

// Whether Embree takes these coordinates; it leaves out primitives of larger ones.
inline bool is_fit(const float* v) {
  constexpr float largest = 1.844e18f;
  return v[0] > -largest && v[0] < largest && v[1] > -largest && v[1] < largest && v[2] > -largest &&
         v[2] < largest;
}

// In the order of ids, then of primitives. A single mesh of fit triangles is a view of its caller's buffers.
struct Meshes {
  raylanes::VertexView vertices;
  raylanes::IndexView indices;
  std::vector<Face> faces;

  explicit Meshes(const std::vector<Part>& parts);
  Meshes(const Meshes&) = delete;
  Meshes& operator=(const Meshes&) = delete;

 private:
  bool view(const Geometry& geometry, std::uint32_t part);
  void copy(const Geometry& geometry, std::uint32_t part);
  // The number of a buffer's first vertex among the own ones: a buffer of many geometries is copied once.
  std::uint32_t copied(const BufferView& vertex);
  void copy_indices(const BufferView& index, const BufferView& vertex, std::uint32_t part, std::uint32_t base,
                    std::uint32_t corners);
  void copy_grids(const BufferView& grids, const BufferView& vertex, std::uint32_t part, std::uint32_t base);

  struct Copy {
    std::uint32_t base;
    std::size_t count;
  };
  std::map<std::pair<const void*, std::size_t>, Copy> copies_;  // by address and stride
  std::vector<raylanes::Float3> own_vertices_;
  std::vector<raylanes::Index3> own_indices_;
};

}  // namespace embree
