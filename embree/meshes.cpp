// The triangles of all meshes of a scene as one mesh.
#include "meshes.hpp"

#include <algorithm>

namespace embree {
namespace {

Face face_of(std::uint32_t part, std::size_t primitive, Face::Half half, const float* a, const float* b,
             const float* c) {
  Face face{{}, part, static_cast<std::uint32_t>(primitive), half, 0, 0, 0, 0};
  const float e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, f[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  for (int k = 0; k < 3; ++k) {
    const int y = (k + 1) % 3, z = (k + 2) % 3;
    face.normal[k] = e[y] * f[z] - e[z] * f[y];
  }
  return face;
}

bool are_fit(const BufferView& vertex, const std::uint32_t* corner, std::uint32_t corners) {
  return std::all_of(corner, corner + corners,
                     [&](std::uint32_t i) { return i < vertex.count && is_fit(vertex.at<float>(i)); });
}

// Calls add(half, a, b, c) for the triangles of a quad.
template <class Add>
void halve(const std::uint32_t* q, Add&& add) {
  add(Face::Half::first, q[0], q[1], q[3]);
  add(Face::Half::second, q[2], q[3], q[1]);
}

}  // namespace

Meshes::Meshes(const std::vector<Part>& parts) {
  std::vector<std::uint32_t> meshes;
  for (std::uint32_t part = 0; part < parts.size(); ++part)
    if (parts[part].geometry->is_mesh()) meshes.push_back(part);
  if (meshes.size() == 1 && view(*parts[meshes[0]].geometry, meshes[0])) return;
  faces.clear();
  for (const std::uint32_t part : meshes) copy(*parts[part].geometry, part);
  vertices = own_vertices_, indices = own_indices_;
}

bool Meshes::view(const Geometry& geometry, std::uint32_t part) {
  const BufferView* index = geometry.find(RTC_BUFFER_TYPE_INDEX);
  const BufferView* vertex = geometry.find(RTC_BUFFER_TYPE_VERTEX);
  if (geometry.type != RTC_GEOMETRY_TYPE_TRIANGLE || index == nullptr || vertex == nullptr ||
      index->count == 0)
    return false;
  faces.reserve(index->count);
  for (std::size_t i = 0; i < index->count; ++i) {
    const auto* t = index->at<std::uint32_t>(i);
    if (!are_fit(*vertex, t, 3)) return false;
    faces.push_back(face_of(part, i, Face::Half::none, vertex->at<float>(t[0]), vertex->at<float>(t[1]),
                            vertex->at<float>(t[2])));
  }
  vertices = {vertex->data, vertex->count, vertex->stride};
  indices = {index->at<std::uint32_t>(0), index->count, index->stride};
  return true;
}

void Meshes::copy(const Geometry& geometry, std::uint32_t part) {
  const bool is_grid = geometry.type == RTC_GEOMETRY_TYPE_GRID;
  const BufferView* index = geometry.find(is_grid ? RTC_BUFFER_TYPE_GRID : RTC_BUFFER_TYPE_INDEX);
  const BufferView* vertex = geometry.find(RTC_BUFFER_TYPE_VERTEX);
  if (index == nullptr || vertex == nullptr) return;
  const std::uint32_t base = copied(*vertex);
  if (is_grid)
    copy_grids(*index, *vertex, part, base);
  else
    copy_indices(*index, *vertex, part, base, geometry.type == RTC_GEOMETRY_TYPE_QUAD ? 4 : 3);
}

std::uint32_t Meshes::copied(const BufferView& vertex) {
  const auto first = static_cast<std::uint32_t>(own_vertices_.size());
  Copy& copy = copies_.try_emplace({vertex.data, vertex.stride}, Copy{first, 0}).first->second;
  if (copy.count >= vertex.count) return copy.base;
  require_allowed(own_vertices_.size() + vertex.count <= 0xffffffffu, "too many vertices in a scene");
  copy = {first, vertex.count};
  for (std::size_t i = 0; i < vertex.count; ++i) {
    const auto* v = vertex.at<float>(i);
    own_vertices_.push_back({v[0], v[1], v[2]});
  }
  return first;
}

void Meshes::copy_indices(const BufferView& index, const BufferView& vertex, std::uint32_t part,
                          std::uint32_t base, std::uint32_t corners) {
  for (std::size_t i = 0; i < index.count; ++i) {
    const auto* corner = index.at<std::uint32_t>(i);
    if (!are_fit(vertex, corner, corners)) continue;
    const auto add = [&](Face::Half half, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      own_indices_.push_back({base + a, base + b, base + c});
      faces.push_back(face_of(part, i, half, vertex.at<float>(a), vertex.at<float>(b), vertex.at<float>(c)));
    };
    if (corners == 4)
      halve(corner, add);
    else
      add(Face::Half::none, corner[0], corner[1], corner[2]);
  }
}

void Meshes::copy_grids(const BufferView& grids, const BufferView& vertex, std::uint32_t part,
                        std::uint32_t base) {
  for (std::size_t i = 0; i < grids.count; ++i) {
    const RTCGrid& grid = *grids.at<RTCGrid>(i);
    if (grid.width < 2 || grid.height < 2) continue;
    for (std::uint32_t y = 0; y + 1 < grid.height; ++y) {
      const std::uint64_t first = grid.startVertexID + std::uint64_t{y} * grid.stride;
      if (first + grid.stride >= vertex.count) break;  // as all rows that follow
      for (std::uint32_t x = 0; x + 1 < grid.width && first + x < vertex.count; ++x) {
        const auto a = static_cast<std::uint32_t>(first) + x, b = a + grid.stride;
        const std::uint32_t quad[4] = {a, a + 1, b + 1, b};
        if (!are_fit(vertex, quad, 4)) continue;
        halve(quad, [&](Face::Half half, std::uint32_t p, std::uint32_t q, std::uint32_t r) {
          own_indices_.push_back({base + p, base + q, base + r});
          Face& face = faces.emplace_back(
              face_of(part, i, half, vertex.at<float>(p), vertex.at<float>(q), vertex.at<float>(r)));
          face.x = static_cast<std::uint16_t>(x), face.y = static_cast<std::uint16_t>(y);
          face.width = static_cast<std::uint16_t>(grid.width - 1);
          face.height = static_cast<std::uint16_t>(grid.height - 1);
        });
      }
    }
  }
}

}  // namespace embree
