// A mesh cut into parts, as most scenes consist of many meshes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <raylanes/mesh.hpp>

namespace raylanes::bench {

// The parts of a mesh whose triangles lie in the order of the parts: triangle k of part i is triangle first[i] + k of
// the mesh.
struct Parts {
  std::vector<Mesh> meshes;
  std::vector<std::uint32_t> first;
};

// Cuts the mesh where its groups begin: `first` has the first triangle of each, ascending; triangles before are a part,
// too. A group without triangles is none.
Parts parts_of_groups(const Mesh& mesh, std::vector<std::uint32_t> first);

// Cuts the mesh into its connected pieces: no corner of one has the coordinates of a corner of another. Gathers pieces,
// in the order of their first triangles, into at most `count` parts of about equal size, and sorts the triangles of the
// mesh by part. `count` is at least 1.
Parts cut_into_parts(Mesh& mesh, std::size_t count);

}  // namespace raylanes::bench
