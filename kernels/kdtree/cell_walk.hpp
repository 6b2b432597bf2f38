// One ray through a k-d tree: cells front to back with a short stack (Wald 2004), a leaf's triangles side by side in
// lanes. A cell is padded as the box of a BVH's node: a plane ends the cell in front of it where a box with that last
// plane ends. It begins the cell behind it where a box with that first plane begins. So no cell is left out that holds
// a hit, whatever rounding does, and rays in a plane go to both sides of it.
#pragma once

#include "../traverse/one_by_one.hpp"

namespace raylanes {
namespace {

// Calls visit(reference) for each block of a leaf, until it says true, that the search is over.
template <class Visit>
inline bool visit_blocks(const KdNode& leaf, Visit visit) {
  std::uint32_t block = leaf.first();
  for (std::uint32_t left = leaf.count(); left > 0; ++block) {
    const std::uint32_t size = left < tree_width ? left : std::uint32_t{tree_width};
    if (visit(tree_reference({block, size}))) return true;
    left -= size;
  }
  return false;
}

// A cell that waits, and what of the ray is within it, at most: nothing is before `entry` or behind `exit`.
struct KdEntry {
  std::uint32_t node;
  float entry, exit;
};

// The part of the ray in the box of the tree, from tmin to tmax. Comparisons such that NaN clips nothing.
inline KdEntry enter(const TreeView& tree, const PaddedSlabs& planes, float tmin, float tmax) {
  KdEntry at{0, tmin, tmax};
  for (int axis = 0; axis < 3; ++axis) {
    const bool negative = planes.negative[axis];
    const float near = planes.near(axis, (negative ? tree.bounds.hi : tree.bounds.lo)[axis]);
    const float far = planes.far(axis, (negative ? tree.bounds.lo : tree.bounds.hi)[axis]);
    at.entry = near > at.entry ? near : at.entry;
    at.exit = far < at.exit ? far : at.exit;
  }
  return at;
}

// From a cell down to a leaf along the ray; true ends the search. The cell behind a plane waits.
template <class Test, class Query, class Counters>
inline bool descend(const TreeView& tree, const Ray& ray, const TreeRay<Test, PaddedSlabs>& prepared,
                    KdEntry& at, KdEntry*& top, Query& query, Counters& counters) {
  const auto visit = [&](TreeReference block) {
    return visit_leaf<Test>(tree, block, ray, prepared, query, counters);
  };
  for (;;) {
    const KdNode node = tree.cells[at.node];
    if (node.is_leaf()) return visit_blocks(node, visit);
    counters.node(), counters.boxes(1);
    if (node.keeps_triangles()) [[unlikely]] {
      if (visit_blocks(tree.cells[node.first() + 2], visit)) return true;
      at.exit = query.tmax < at.exit ? query.tmax : at.exit;
    }
    const auto axis = static_cast<int>(node.axis());
    const float plane = node.plane();
    const std::uint32_t first = node.first() + (prepared.nodes.negative[axis] ? 1u : 0u);
    const std::uint32_t second = node.first() + (prepared.nodes.negative[axis] ? 0u : 1u);
    const float begin = prepared.nodes.near(axis, plane), end = prepared.nodes.far(axis, plane);
    // NaN, of a ray in the plane, goes both ways.
    if (begin > at.exit) {
      at.node = first;
    } else if (end < at.entry) {
      at.node = second;
    } else {
      *top++ = {second, begin > at.entry ? begin : at.entry, at.exit};
      at = {first, at.entry, end < at.exit ? end : at.exit};
    }
  }
}

struct WalksCells {
  template <class Test, class Query, class Counters>
  static void walk(const TreeView& tree, const Ray& ray, Query& query, Counters& counters) {
    // Cells are not as flat as their triangles: no other walk would leave them out.
    if constexpr (screens<Test> && requires { query.beside; }) query.beside = never_beside;
    const TreeRay<Test, PaddedSlabs> prepared{LeafRay<Test>(ray, tree.bounds),
                                              padded_slabs<Test>(ray, tree.bounds)};
    KdEntry stack[max_kd_depth], *top = stack;
    KdEntry at = enter(tree, prepared.nodes, prepared.tmin, query.tmax);
    if (!(at.entry <= at.exit)) return;
    while (!descend(tree, ray, prepared, at, top, query, counters)) {
      // Cells that begin where the best hit is may hold another one there, of a smaller primitive.
      do {
        if (top == stack) return;
        at = *--top;
      } while (at.entry > query.tmax);
      at.exit = query.tmax < at.exit ? query.tmax : at.exit;
    }
  }
};

}  // namespace
}  // namespace raylanes
