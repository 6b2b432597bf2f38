// One ray through a tree: a node's eight children, then a leaf's triangles, side by side in lanes.
#pragma once

#include <bit>

#include "traversal_ray.hpp"

namespace raylanes {
namespace {

inline constexpr int node_lanes = native_lanes < tree_width ? native_lanes : tree_width;
inline constexpr int max_stack = max_tree_depth * (tree_width - 1) + 1;

struct StackEntry {
  TreeReference reference;
  float entry;  // where the ray enters the box
};

// A ray broadcast to lanes, ready for both tests.
template <TriangleTest test>
struct SingleRay {
  static constexpr int L = node_lanes;
  SlabRay<L> slab;
  int near_plane[3], far_plane[3];  // offsets of the plane arrays in a WideNode
  Floats<L> origin[3], direction[3];
  ShearedRay<L> sheared;
  int order[3];  // the axes as the triangle test wants them
  float tmin;

  SingleRay(const Ray& ray, const TreeView& tree) : tmin(ray.tmin) {
    const PaddedSlab padded = padded_slab(ray, tree);
    for (int axis = 0; axis < 3; ++axis) {
      slab.near_origin[axis] = Floats<L>(padded.near_origin[axis]);
      slab.far_origin[axis] = Floats<L>(padded.far_origin[axis]);
      slab.near_inverse[axis] = slab.far_inverse[axis] = Floats<L>(padded.inverse[axis]);
      near_plane[axis] = (axis + (padded.negative[axis] ? 3 : 0)) * tree_width;
      far_plane[axis] = (axis + (padded.negative[axis] ? 0 : 3)) * tree_width;
    }
    const ShearAxes k = test == TriangleTest::watertight ? shear_axes(ray.direction) : ShearAxes{0, 1, 2};
    order[0] = k.x, order[1] = k.y, order[2] = k.z;
    for (int j = 0; j < 3; ++j) {
      origin[j] = Floats<L>(ray.origin[order[j]]);
      direction[j] = Floats<L>(ray.direction[order[j]]);
    }
    if constexpr (test == TriangleTest::watertight) sheared = shear_ray<L>(origin, direction);
  }
};

// The children whose padded box the ray meets within [tmin, tmax], as bits, and where it enters each.
template <TriangleTest test>
inline std::uint32_t meet_children(const SingleRay<test>& ray, const WideNode& node, float tmax,
                                   float (&entry)[tree_width]) {
  constexpr int L = node_lanes;
  const float* planes = &node.lo[0][0];
  std::uint32_t met = 0;
  for (int first = 0; first < tree_width; first += L) {
    Floats<L> near_plane[3], far_plane[3];
    for (int axis = 0; axis < 3; ++axis) {
      near_plane[axis] = Floats<L>::load(planes + ray.near_plane[axis] + first);
      far_plane[axis] = Floats<L>::load(planes + ray.far_plane[axis] + first);
    }
    const SlabInterval<L> inside =
        clip_to_slabs<L>(ray.slab, near_plane, far_plane, Floats<L>(ray.tmin), Floats<L>(tmax));
    inside.entry.store(entry + first);
    met |= bits(inside.entry <= inside.exit) << first;
  }
  return met;
}

template <TriangleTest test, Grade grade>
inline TriangleHit<node_lanes> test_lanes(const SingleRay<test>& ray, const TriangleBlock& block, int first,
                                          float tmax) {
  constexpr int L = node_lanes;
  Corner<L> corner[3];
  for (int c = 0; c < 3; ++c)
    for (int j = 0; j < 3; ++j) corner[c][j] = Floats<L>::load(&block.vertex[c][ray.order[j]][first]);
  if constexpr (test == TriangleTest::watertight)
    return watertight<grade, L>(ray.sheared, corner, Floats<L>(ray.tmin), Floats<L>(tmax));
  else
    return moller_trumbore<grade, L>(ray.origin, ray.direction, corner, Floats<L>(ray.tmin), Floats<L>(tmax));
}

// Takes the best of a leaf's triangles into `best`; with `any`, tells whether there is one.
template <TriangleTest test, Grade grade, bool any_hit>
inline bool visit_leaf(const SingleRay<test>& ray, const TriangleBlock& block, int size, float tmax,
                       Hit& best) {
  constexpr int L = node_lanes;
  for (int first = 0; first < size; first += L) {
    const TriangleHit<L> h = test_lanes<test, grade>(ray, block, first,
                                                     any_hit         ? tmax
                                                     : best.t < tmax ? best.t
                                                                     : tmax);
    std::uint32_t hits = bits(h.hit);
    if (hits == 0) continue;
    if constexpr (any_hit) return true;
    float t[L], u[L], v[L];
    h.t.store(t), h.u.store(u), h.v.store(v);
    for (; hits != 0; hits &= hits - 1) {
      const int lane = std::countr_zero(hits);
      const std::uint32_t primitive = block.primitive[first + lane];
      if (is_better(t[lane], primitive, best.t, best.primitive))
        best = {t[lane], u[lane], v[lane], primitive};
    }
  }
  return false;
}

// Appends the met children, the nearest last.
inline StackEntry* push_children(StackEntry* top, const WideNode& node, std::uint32_t met,
                                 const float (&entry)[tree_width]) {
  StackEntry* const base = top;
  for (; met != 0; met &= met - 1) {
    const int child = std::countr_zero(met);
    const StackEntry incoming{node.child[child], entry[child]};
    StackEntry* slot = top++;
    for (; slot != base && slot[-1].entry < incoming.entry; --slot) *slot = slot[-1];
    *slot = incoming;
  }
  return top;
}

// Depth first, nearest child first. A subtree is dropped only if it begins behind the best hit: at equal
// distance it may hold a smaller primitive.
template <TriangleTest test, Grade grade, bool any_hit>
inline Hit trace_single(const TreeView& tree, const Ray& user_ray) {
  Hit best = miss();
  if (tree.root == empty_reference || !is_traceable(user_ray)) return best;
  const SingleRay<test> ray(user_ray, tree);
  StackEntry stack[max_stack];
  StackEntry* top = stack;
  *top++ = {tree.root, user_ray.tmin};
  while (top != stack) {
    const StackEntry current = *--top;
    const float tmax = best.t < user_ray.tmax ? best.t : user_ray.tmax;
    if (current.entry > tmax) continue;
    if (is_leaf(current.reference)) {
      const TriangleBlock& block = tree.blocks[current.reference & leaf_block_mask];
      if (visit_leaf<test, grade, any_hit>(ray, block, leaf_size(current.reference), user_ray.tmax, best)) {
        best.primitive = 0;
        return best;
      }
    } else {
      const WideNode& node = tree.nodes[current.reference];
      float entry[tree_width];
      const std::uint32_t met = meet_children(ray, node, tmax, entry);
      top = push_children(top, node, met, entry);
    }
  }
  return best;
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void closest_single(const TreeView& tree, const Ray* rays, Hit* hits, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) hits[i] = trace_single<test, grade, false>(tree, rays[i]);
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void any_single(const TreeView& tree, const Ray* rays, std::uint8_t* occluded,
                                 std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    occluded[i] = trace_single<test, grade, true>(tree, rays[i]).primitive != no_primitive;
}

}  // namespace
}  // namespace raylanes
