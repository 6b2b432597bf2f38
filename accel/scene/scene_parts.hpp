// What a scene holds.
#pragma once

#include <variant>
#include <vector>

#include "../../dispatch/table/kernel_table.hpp"
#include "../queries/checked_traversal.hpp"
#include "instance.hpp"
#include "sphere_leaves.hpp"

namespace raylanes {

// The arrays behind trees that scenes have a share in; null of nothing.
struct Triangles {
  Bvh tree;
};
struct Spheres {
  SphereTree tree;
  const SphereLeaves* leaves;
};
struct UserPrimitives {
  BoundedTree tree;
  const BoxTree* boxes;
  LeafCallback test;
};
using Geometry = std::variant<Triangles, Spheres, UserPrimitives>;

// A tree over instances that need about the same padding.
struct TopLevel {
  BoxTree tree;        // its slack is what exact tests need
  BoxPadding rounded;  // what tests whose numbers are rounded need as well
};

struct SceneParts {
  std::vector<Geometry> geometries;
  std::vector<Instance> instances;
  // Small shares first. Each instance that can be hit is in one of them.
  std::vector<TopLevel> tops;
  bool is_current = true;  // whether tops are up to date
};

// Answers to rays of a scene: hits or occluded, the other is null. On this thread; all are set.
struct SceneBatch {
  const Ray* rays;
  std::size_t size;
  SceneHit* hits;
  std::uint8_t* occluded;
  detail::RayNumbers numbers = {};  // of the rays in the caller's batch
};
struct SceneQuery {
  const SceneParts& scene;
  TriangleTest test;
  TraversalChoice choice;
  std::uint32_t mask;
  const KernelTable& kernels;
  TraceCounters* counters;
};
void trace_scene(const SceneQuery& query, const SceneBatch& batch);

}  // namespace raylanes
