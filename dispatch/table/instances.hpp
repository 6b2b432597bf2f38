// Instances of trees, and a tree over these, as kernels walk them.
#pragma once

#include "traversal.hpp"

namespace raylanes {

// The tree of an instance and the map to its space. Scenes derive from it what only they read.
struct alignas(64) PlacedTree {
  double inverse
      [13];  // columns of three: x, y, z and the translation; and a zero, as kernels read four at a time
  const TreeView* tree;  // null: not of triangles, or empty
  std::uint32_t geometry, mask;
  bool is_identity;
};

// An element of a leaf of the top level: an instance, from a node or leaf of its tree on.
struct InstanceEntry {
  std::uint32_t instance;
  TreeReference from;
};

// How trees of instances are searched by options that the kernel of instances does not know. `call` is passed on.
struct InstanceSearch {
  Hit (*closest)(const void* call, const TreeView& tree, const Ray& ray, std::uint32_t instance);
  bool (*any)(const void* call, const TreeView& tree, const Ray& ray, std::uint32_t instance);
  const void* call;
};

// A tree over entries, which lie in the order of its leaves.
struct InstancesView {
  TreeView tree;
  const InstanceEntry* entries;  // null: not all instances consist of triangles
  const PlacedTree* instances;   // the first one
  std::size_t stride;            // bytes from an instance to the next

  [[gnu::always_inline]] const PlacedTree& instance(std::uint32_t number) const {
    return *reinterpret_cast<const PlacedTree*>(reinterpret_cast<const std::byte*>(instances) +
                                                number * stride);
  }
};

}  // namespace raylanes
