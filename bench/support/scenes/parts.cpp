#include "parts.hpp"

namespace raylanes::bench {
namespace {

// Disjoint sets of vertices, each named by its least member (Tarjan 1975, with halved paths).
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// Numbers the pieces by their first triangles; returns the piece of each triangle.
std::vector<std::uint32_t> pieces_of(const Mesh& mesh) {
  Sets sets(mesh.vertices.size());
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return mesh.vertices[a] < mesh.vertices[b]; });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (mesh.vertices[order[k - 1]] == mesh.vertices[order[k]]) sets.join(order[k - 1], order[k]);
  for (const auto& [a, b, c] : mesh.triangles) sets.join(a, b), sets.join(b, c);

  std::vector<std::uint32_t> pieces, number(mesh.vertices.size(), no_primitive);
  std::uint32_t count = 0;
  for (const Index3& triangle : mesh.triangles) {
    std::uint32_t& piece = number[sets.of(triangle[0])];
    if (piece == no_primitive) piece = count++;
    pieces.push_back(piece);
  }
  return pieces;
}

Mesh mesh_of(const Mesh& whole, std::size_t begin, std::size_t end, std::vector<std::uint32_t>& number) {
  Mesh part;
  for (std::size_t i = begin; i < end; ++i) {
    Index3 triangle = whole.triangles[i];
    for (std::uint32_t& corner : triangle) {
      if (number[corner] == no_primitive) {
        number[corner] = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(whole.vertices[corner]);
      }
      corner = number[corner];
    }
    part.triangles.push_back(triangle);
  }
  for (std::size_t i = begin; i < end; ++i)
    for (const std::uint32_t corner : whole.triangles[i]) number[corner] = no_primitive;
  return part;
}

}  // namespace

bool Parts::has_transforms() const {
  const Transform identity;
  return std::ranges::any_of(placed.places, [&](const PlacedMeshes::Place& place) {
    return std::memcmp(&place.transform, &identity, sizeof identity) != 0;
  });
}

Parts parts_of_nodes(const Mesh& mesh, const std::vector<std::uint32_t>& first, PlacedMeshes nodes) {
  Parts parts = parts_of_groups(mesh, first);
  std::erase_if(nodes.places,
                [&](const PlacedMeshes::Place& place) { return nodes.meshes[place.mesh].triangles.empty(); });
  if (parts.first.size() > 1) parts.placed = std::move(nodes);
  return parts;
}

Parts parts_of_groups(const Mesh& mesh, std::vector<std::uint32_t> first) {
  Parts parts;
  first.insert(first.begin(), 0);
  std::vector<std::uint32_t> number(mesh.vertices.size(), no_primitive);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const std::size_t end = i + 1 < first.size() ? first[i + 1] : mesh.triangles.size();
    if (end == first[i]) continue;
    parts.meshes.push_back(mesh_of(mesh, first[i], end, number));
    parts.first.push_back(first[i]);
  }
  return parts;
}

Parts cut_into_parts(Mesh& mesh, std::size_t count) {
  const std::vector<std::uint32_t> pieces = pieces_of(mesh);
  std::vector<std::uint32_t> order(pieces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return pieces[a] < pieces[b]; });
  std::vector<Index3> triangles;
  std::vector<std::uint32_t> first;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool begins_a_piece = i == 0 || pieces[order[i]] != pieces[order[i - 1]];
    if (begins_a_piece && (i == 0 || i * count >= first.size() * order.size()))
      first.push_back(static_cast<std::uint32_t>(i));
    triangles.push_back(mesh.triangles[order[i]]);
  }
  mesh.triangles = std::move(triangles);
  return parts_of_groups(mesh, first);
}

}  // namespace raylanes::bench
