// The BVH that rows are called with, and the memory that they are given.
#pragma once

#include "../../accel/layout/bvh_arrays.hpp"
#include "../support/meshes.hpp"
#include "emulated_inputs.hpp"

namespace raylanes::testing {

struct alignas(64) Line {
  std::byte byte[64];
};

inline Mesh small_mesh() {
  Mesh mesh;
  for (const Triangle& triangle : some_triangles()) append(mesh, triangle);
  return mesh;
}

struct SmallTree {
  Mesh mesh = small_mesh();
  BvhArrays arrays = build_bvh(mesh.vertices, mesh.triangles, {});
  TreeView view = arrays.view();
};

}  // namespace raylanes::testing
