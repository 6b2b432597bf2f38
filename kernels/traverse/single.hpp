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
  int near_plane[3], far_plane[3];   // offsets of the plane arrays in a WideNode
  Floats<L> origin[3], backward[3];  // minus the direction
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
    Floats<L> direction[3];
    for (int j = 0; j < 3; ++j) {
      origin[j] = Floats<L>(ray.origin[order[j]]);
      direction[j] = Floats<L>(ray.direction[order[j]]);
    }
    negate<L>(direction, backward);
    if constexpr (test == TriangleTest::watertight) sheared = shear_ray<L>(origin, direction);
  }
};

// The children whose padded box the ray meets within [tmin, tmax], as bits, and where it enters each. Never an
// empty slot, whatever NaN does.
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
  return met & node.occupied;
}

template <TriangleTest test, Grade grade>
inline ScaledTriangleHit<node_lanes> test_lanes(const SingleRay<test>& ray, const TriangleBlock& block,
                                                int first) {
  constexpr int L = node_lanes;
  Corner<L> corner[3];
  for (int c = 0; c < 3; ++c)
    for (int j = 0; j < 3; ++j) corner[c][j] = Floats<L>::load(&block.corner[c][ray.order[j]][first]);
  if constexpr (test == TriangleTest::watertight)
    return scaled_watertight<grade, L>(ray.sheared, corner);
  else
    return scaled_moller_trumbore<grade, L>(ray.origin, ray.backward, corner);
}

// Takes the best of the lanes in `hits` into `best`. u and v are divided for a lane that wins, no other.
inline void keep_best(const ScaledTriangleHit<node_lanes>& h, Floats<node_lanes> lane_t, std::uint32_t hits,
                      const std::uint32_t* primitives, Hit& best) {
  float t[node_lanes], u[node_lanes], v[node_lanes], det[node_lanes];
  lane_t.store(t), h.scaled_u.store(u), h.scaled_v.store(v), h.det.store(det);
  for (; hits != 0; hits &= hits - 1) {
    const int lane = std::countr_zero(hits);
    if (is_better(t[lane], primitives[lane], best.t, best.primitive))
      best = {t[lane], u[lane] / det[lane] + 0.0f, v[lane] / det[lane] + 0.0f, primitives[lane]};
  }
}

// Takes the best of a leaf's triangles into `best`; with any_hit, tells whether there is one. Most leaves
// that a ray comes to hold no triangle that it passes through: those cost no division.
template <TriangleTest test, Grade grade, bool any_hit>
inline bool visit_leaf(const SingleRay<test>& ray, const TriangleBlock& block, int size, float tmax,
                       Hit& best) {
  constexpr int L = node_lanes;
  for (int first = 0; first < size; first += L) {
    const ScaledTriangleHit<L> h = test_lanes<test, grade>(ray, block, first);
    if (!any(h.inside)) continue;
    const Floats<L> t = h.t();
    const std::uint32_t hits = bits(h.inside & (t >= Floats<L>(ray.tmin)) & (t <= Floats<L>(tmax)));
    if constexpr (any_hit) {
      if (hits != 0) return true;
    } else {
      keep_best(h, t, hits, block.primitive + first, best);
    }
  }
  return false;
}

// Appends children first to last of `met` so that the nearest is on top.
inline StackEntry* push_sorted(StackEntry* top, const WideNode& node, std::uint32_t met,
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

// Goes on with the nearest of the met children, at least one, and leaves the others on the stack. One or two
// children, the most frequent by far, take no loop.
inline StackEntry descend_nearest(StackEntry*& top, const WideNode& node, std::uint32_t met,
                                  const float (&entry)[tree_width]) {
  const int first = std::countr_zero(met);
  const StackEntry a{node.child[first], entry[first]};
  met &= met - 1;
  if (met == 0) return a;
  const int second = std::countr_zero(met);
  const StackEntry b{node.child[second], entry[second]};
  if ((met & (met - 1)) == 0) {
    const bool a_is_nearer = a.entry < b.entry;
    *top++ = a_is_nearer ? b : a;
    return a_is_nearer ? a : b;
  }
  top = push_sorted(top, node, met | 1u << first, entry);
  return *--top;
}

// Any hit ends the search, so the order matters little: sorting would cost more than it saves.
inline TreeReference descend_first(TreeReference*& top, const WideNode& node, std::uint32_t met) {
  const TreeReference first = node.child[std::countr_zero(met)];
  for (met &= met - 1; met != 0; met &= met - 1) *top++ = node.child[std::countr_zero(met)];
  return first;
}

inline const TriangleBlock& block_of(const TreeView& tree, TreeReference leaf) {
  return tree.blocks[leaf & leaf_block_mask];
}

// The nearest hit, depth first, nearest child first. A subtree is dropped only if it begins behind the best
// hit: at equal distance it may hold a smaller primitive.
template <TriangleTest test, Grade grade>
inline Hit trace_closest(const TreeView& tree, const Ray& user_ray) {
  Hit best = miss();
  if (tree.root == empty_reference || !is_traceable(user_ray)) return best;
  const SingleRay<test> ray(user_ray, tree);
  float tmax = last_t(user_ray);
  StackEntry stack[max_stack];
  StackEntry* top = stack;
  *top++ = {tree.root, user_ray.tmin};
  while (top != stack) {
    StackEntry current = *--top;
    if (current.entry > tmax) continue;
    std::uint32_t met = 1;
    while (!is_leaf(current.reference)) {
      const WideNode& node = tree.nodes[current.reference];
      float entry[tree_width];
      met = meet_children(ray, node, tmax, entry);
      if (met == 0) break;
      current = descend_nearest(top, node, met, entry);
    }
    if (met == 0) continue;
    visit_leaf<test, grade, false>(ray, block_of(tree, current.reference), leaf_size(current.reference), tmax,
                                   best);
    tmax = best.t < tmax ? best.t : tmax;
  }
  return best;
}

template <TriangleTest test, Grade grade>
inline bool trace_any(const TreeView& tree, const Ray& user_ray) {
  if (tree.root == empty_reference || !is_traceable(user_ray)) return false;
  const SingleRay<test> ray(user_ray, tree);
  const float tmax = last_t(user_ray);
  TreeReference stack[max_stack];
  TreeReference* top = stack;
  *top++ = tree.root;
  while (top != stack) {
    TreeReference current = *--top;
    std::uint32_t met = 1;
    while (!is_leaf(current)) {
      const WideNode& node = tree.nodes[current];
      float entry[tree_width];
      met = meet_children(ray, node, tmax, entry);
      if (met == 0) break;
      current = descend_first(top, node, met);
    }
    Hit found;
    if (met != 0 &&
        visit_leaf<test, grade, true>(ray, block_of(tree, current), leaf_size(current), tmax, found))
      return true;
  }
  return false;
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void closest_single(const TreeView& tree, const Ray* rays, Hit* hits, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) hits[i] = trace_closest<test, grade>(tree, rays[i]);
}

template <TriangleTest test, Grade grade>
[[gnu::flatten]] void any_single(const TreeView& tree, const Ray* rays, std::uint8_t* occluded,
                                 std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) occluded[i] = trace_any<test, grade>(tree, rays[i]);
}

}  // namespace
}  // namespace raylanes
