// A mesh cut into parts, as most scenes consist of many meshes.
#pragma once

#include "../readers/mesh_reader.hpp"

namespace raylanes::bench {

// The parts of a mesh whose triangles lie in the order of the parts: triangle k of part i is triangle first[i] + k of
// the mesh. Parts that are nodes have meshes in common: part i is mesh placed.places[i].mesh there, moved.
struct Parts {
  std::vector<Mesh> meshes;
  std::vector<std::uint32_t> first;
  PlacedMeshes placed = {};  // empty: each part stands where it is, and has a mesh of its own

  // The meshes of instances of the parts, and where these stand.
  const std::vector<Mesh>& shared_meshes() const { return placed.places.empty() ? meshes : placed.meshes; }
  PlacedMeshes::Place place(std::uint32_t part) const {
    return placed.places.empty() ? PlacedMeshes::Place{part, {}} : placed.places[part];
  }
  // Whether an instance has other rounding than its part.
  bool has_transforms() const;
};

// Cuts the mesh where its groups begin: `first` has the first triangle of each, ascending; triangles before are a part,
// too. A group without triangles is none.
Parts parts_of_groups(const Mesh& mesh, std::vector<std::uint32_t> first);

// The same for groups that are nodes, if there is more than one with triangles.
Parts parts_of_nodes(const Mesh& mesh, const std::vector<std::uint32_t>& first, PlacedMeshes nodes);

// Cuts the mesh into its connected pieces: no corner of one has the coordinates of a corner of another. Gathers pieces,
// in the order of their first triangles, into at most `count` parts of about equal size, and sorts the triangles of the
// mesh by part. `count` is at least 1.
Parts cut_into_parts(Mesh& mesh, std::size_t count);

}  // namespace raylanes::bench
