// The queries of all trees: options and views are checked, then rays are traced.
#pragma once

#include <raylanes/bvh.hpp>

#include "../dispatch/tree.hpp"
#include "build/boxes.hpp"
#include "layout/leaves.hpp"

namespace raylanes {

// Which kernels walk a tree.
enum class TreeKind { bvh, kdtree };

struct TracedTree {
  TreeKind kind;
  const TreeLeaves* leaves;  // null: of no triangles
  TreeView view;             // without blocks, which depend on the test
};
inline constexpr TreeView no_tree{nullptr, nullptr, empty_reference, empty_box};

// As of Bvh.
namespace door {

Hit closest(const TracedTree& tree, const Ray& ray, const TraceOptions& options);
bool occluded(const TracedTree& tree, const Ray& ray, const TraceOptions& options);
void closest(const TracedTree& tree, RayView rays, HitView hits, const TraceOptions& options);
void closest(const TracedTree& tree, const RayArrays& rays, HitView hits, const TraceOptions& options);
void occluded(const TracedTree& tree, RayView rays, std::span<std::uint8_t> occluded,
              const TraceOptions& options);
void occluded(const TracedTree& tree, const RayArrays& rays, std::span<std::uint8_t> occluded,
              const TraceOptions& options);
void occluded_from(const TracedTree& tree, const Float3& from, VertexView points,
                   std::span<std::uint8_t> occluded, const SegmentEnds& ends, const TraceOptions& options);

}  // namespace door
}  // namespace raylanes
