// The kernel table: everything a path offers, with its contract. One constant table per path; every
// function in it computes the same function on every path, and in the reproducible grade the same bits.
//
// Common to all: n = 0 is allowed; pointers need the alignment of their type only; nothing is read or
// written outside the n elements; MXCSR is neither read nor changed (the bounds hold for round to nearest
// without FTZ and DAZ); no function throws or allocates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <raylanes/root_methods.hpp>
#include <raylanes/tree.hpp>
#include <raylanes/types.hpp>

namespace raylanes {

// What a kernel promises.
//   reproducible  multiply and add rounded apart, division and root correctly rounded, no estimates: the
//                 same bits on every path
//   fast          fused multiply-add where the path has it; bounds as stated per kernel, bits depend on the
//   path
enum class Grade : std::uint8_t { reproducible, fast };
inline constexpr std::array<std::string_view, 2> grade_names{"reproducible", "fast"};

// Rays, triangles, boxes and their results as one array per component, n elements each; outputs overlap
// nothing. A lane that misses gets t = +infinity, u = v = 0, hit = 0; a hit has hit = 0xffffffff.
struct RayArrays {
  const float* origin[3];
  const float* direction[3];
  const float* tmin;
  const float* tmax;
};
struct TriangleArrays {
  const float* vertex[3][3];  // [corner][axis]
};
struct BoxArrays {
  const float* lo[3];
  const float* hi[3];
};
struct TriangleHitArrays {
  float* t;
  float* u;
  float* v;
  std::uint32_t* hit;
};
// entry and exit: the part of [tmin, tmax] inside the box; entry = +infinity, exit = −infinity for a miss.
struct BoxHitArrays {
  float* entry;
  float* exit;
  std::uint32_t* hit;
};

// Ray–triangle tests. A hit is tmin <= t <= tmax with u, v >= 0, u + v <= 1, all closed. A degenerate
// triangle, a ray in the triangle's plane, and any NaN or infinity among the inputs other than tmin and
// tmax is a miss.
//   watertight       canonical shear (Woop, Benthin, Wald 2013) with exact edge signs: no ray slips between
//                    two triangles that share an edge or a vertex, in either grade. Reproducible: a zero edge
//                    function is decided again in double. Fast: Kahan determinants where the path has FMA.
//                    Usable scene scale 1e-12 … 1e12 with unit directions.
//   moller_trumbore  Möller, Trumbore 1997, decided on scaled values, divided afterwards; no epsilon.
//                    Decisions outside 7u(1+8u)·permanent of each determinant are exact (u = 2^-24); leaks up to a
//                    fifth of rays aimed exactly at edges.
enum class TriangleTest : std::uint8_t { watertight, moller_trumbore };
inline constexpr std::array<std::string_view, 2> triangle_test_names{"watertight", "moller_trumbore"};

// Traversal of a tree by n rays in the order given; hits[i] belongs to rays[i]; rays and hits do not overlap.
// Of several hits the nearest wins, of equal t the smallest primitive: with the watertight test in the
// reproducible grade the result does not depend on the tree, the path or the mode (single or packet). That
// holds for components of the direction that are zero or at least 2^-126 in size: the reciprocal of a smaller
// one overflows, and a hit at t near 2^126 may be culled.
using ClosestHitFunction = void (*)(const TreeView& tree, const Ray* rays, Hit* hits, std::size_t n);
// occluded[i] = 1 if anything is hit within [tmin, tmax], else 0.
using AnyHitFunction = void (*)(const TreeView& tree, const Ray* rays, std::uint8_t* occluded, std::size_t n);

struct TriangleKernels {
  void (*rays_triangle)(const RayArrays& rays, std::size_t n, const TriangleVertices& triangle,
                        const TriangleHitArrays& out);
  void (*ray_triangles)(const Ray& ray, const TriangleArrays& triangles, std::size_t n,
                        const TriangleHitArrays& out);
  ClosestHitFunction closest_single;
  ClosestHitFunction closest_packet;
  AnyHitFunction any_single;
  AnyHitFunction any_packet;
};

// Ray–box test by closed slabs (Williams et al. 2005), conservative: with 0 <= tmin no box that the exact ray
// meets is missed, because the far distance is widened by 1 + 2γ3 = 1 + 6u (Ize 2013, Pharr et al. 2016); a
// box that the ray passes within rounding may be reported. This holds where each component of the direction
// is zero, of either sign, or at least 2^-126 in size, so that its reciprocal is finite, and where no
// difference of bound and origin overflows. A box is missed if lo > hi on an axis or a bound is NaN. Flat and
// infinite boxes are exact. The same bits on every path.
struct BoxKernels {
  void (*rays_box)(const RayArrays& rays, std::size_t n, const Box& box, const BoxHitArrays& out);
  void (*ray_boxes)(const Ray& ray, const BoxArrays& boxes, std::size_t n, const BoxHitArrays& out);
};

struct KernelTable {
  SquareRootKernels roots;
  TriangleKernels triangle[triangle_test_names.size()][grade_names.size()];
  BoxKernels box;
  int lanes;     // floats per register
  bool has_fma;  // whether the fast grade fuses
};

}  // namespace raylanes
