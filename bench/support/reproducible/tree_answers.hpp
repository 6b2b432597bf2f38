// Hashes of the bits of trees' answers to fixed rays: the same on every ISA path.
#pragma once

#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>

#include "hash.hpp"

namespace raylanes::bench {

// A hash of the vertices and triangles.
std::uint64_t hash_of(const Mesh& mesh);

// Closest and any hits of rays through both trees over the mesh, in each mode, for each path: "NAME exact stream bvh";
// and what is beyond the nearest hit: "NAME lists bvh", "NAME points bvh", "NAME windings bvh". A tree of doubles
// has "NAME doubles hits", lists, points and windings.
std::vector<Hashes> hashes_of_tree(const std::vector<const Path*>& paths, const std::string& name,
                                   const Mesh& mesh, const Float3& eye);

}  // namespace raylanes::bench
