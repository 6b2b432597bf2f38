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
#include <iterator>
#include <string_view>

#include <raylanes/boxes.hpp>
#include <raylanes/root_methods.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>
#include <raylanes/types.hpp>

#include "tree.hpp"

namespace raylanes {

// Traversal of a tree by n rays in the order given; hits[i] belongs to rays[i]; rays and hits do not overlap.
// Of several hits the nearest wins, of equal t the smallest primitive: with the watertight test in the
// reproducible grade the result does not depend on the tree, the path or the mode (single or packet), as long
// as the test itself neither overflows nor underflows: the product of t and twice the area of a triangle that is
// hit, seen along the major axis of the direction, must be in [2^-100, 2^120] or zero. In a scene of extent
// 1e-12, with areas of 1e-24 and less, a direction of length 1e12 gives t of 1e-24, and their product is lost.
using ClosestHitFunction = void (*)(const TreeView& tree, const Ray* rays, Hit* hits, std::size_t n);
// occluded[i] = 1 if anything is hit within [tmin, tmax], else 0.
using AnyHitFunction = void (*)(const TreeView& tree, const Ray* rays, std::uint8_t* occluded, std::size_t n);

struct TraversalRow {
  ClosestHitFunction closest_single;
  ClosestHitFunction closest_packet;
  AnyHitFunction any_single;
  AnyHitFunction any_packet;
};

// Primitives as one array per number that a test reads of them.
using Soa = const float* const*;

// A row per test and grade: [enumerator][Grade].
template <class Row, std::size_t tests>
struct Rows {
  Row row[tests][grade_names.size()];
};

// The tests over arrays, any n, with the elements of `active` or all; the contracts are those of the calls in
// <raylanes/triangles.hpp>, boxes.hpp and spheres.hpp. triangles: what the test reads; triangle: the numbers of one,
// one after the other.
struct TriangleRow {
  // What the test reads of n triangles, from their corners v0 v1 v2, into arrays that overlap nothing. directional
  // needs the direction of all rays, three numbers; others do not look at it, it may be null.
  void (*prepare)(Soa corners, std::size_t n, const float* direction, float* const* out);
  void (*any_of_triangles)(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits);
  void (*closest_of_triangles)(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, Hit& nearest);
  // u and v may be null.
  void (*closest_of_rays)(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits,
                          float* t, float* u, float* v);
};
using TriangleKernels = Rows<TriangleRow, std::size(triangle_tests)>;

// box: lo and hi.
struct BoxRow {
  void (*any_of_boxes)(const Ray& ray, Soa boxes, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* box, LaneBits active, std::uint8_t* bits);
  void (*intervals_of_boxes)(const Ray& ray, Soa boxes, std::size_t n, LaneBits active, std::uint8_t* bits,
                             float* entry, float* exit);
  void (*intervals_of_rays)(const RayArrays& rays, const float* box, LaneBits active, std::uint8_t* bits,
                            float* entry, float* exit);
};
using BoxKernels = Rows<BoxRow, std::size(box_tests)>;

// sphere: centre and signed_square of the radius.
struct SphereRow {
  void (*any_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active, std::uint8_t* bits);
  void (*any_of_rays)(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* bits);
  void (*closest_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active, Hit& nearest);
  void (*distances_of_spheres)(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                               std::uint8_t* bits, float* near, float* far);
  void (*distances_of_rays)(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* bits,
                            float* near, float* far);
};
struct SphereKernels : Rows<SphereRow, std::size(sphere_tests)> {
  // Of whole lines, [Grade].
  void (*line_of_spheres[grade_names.size()])(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                                              std::uint8_t* bits);
};

struct TraversalKernels {
  TraversalRow triangle[triangle_test_names.size()][grade_names.size()];
};

// One function of roots: its methods, numbered as in the enumeration, and the fastest one measured for each accuracy.
// Contracts and bounds: <raylanes/root_methods.hpp>.
template <class T>
using ArrayFunction = void (*)(const T* x, T* y, std::size_t n);
template <class T, class Method, std::size_t Count>
struct RootRows {
  ArrayFunction<T> by[Count];
  Method within[accuracies.size()];
};

struct RootKernels {
  RootRows<float, SqrtMethod, sqrt_methods.size()> sqrt;
  RootRows<float, RsqrtMethod, rsqrt_methods.size()> rsqrt;
  RootRows<float, ReciprocalMethod, reciprocal_methods.size()> reciprocal;
  RootRows<double, DoubleSqrtMethod, double_sqrt_methods.size()> double_sqrt;
  RootRows<double, DoubleRsqrtMethod, double_rsqrt_methods.size()> double_rsqrt;
  RootRows<double, DoubleReciprocalMethod, double_reciprocal_methods.size()> double_reciprocal;
};

// Five objects of one path, each from a unit of its own (kernels/*/).
struct KernelTable {
  const RootKernels& roots;
  const TriangleKernels& triangles;
  const BoxKernels& boxes;
  const SphereKernels& spheres;
  const TraversalKernels& traversal;
};

}  // namespace raylanes
