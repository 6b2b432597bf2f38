// The kernel table: everything a path offers. One constant table per path; every function in it computes the same
// function on every path, and in the reproducible grade the same bits. Each family of kernels has a header beside this
// one, so that a change of a family compiles its kernels and their callers alone.
//
// Common to all: n = 0 is allowed; pointers need the alignment of their type only; nothing is read or
// written outside the n elements; MXCSR is neither read nor changed (bits and bounds hold for round to nearest
// without FTZ and DAZ); no function throws or allocates.
#pragma once

#include <raylanes/paths.hpp>

namespace raylanes {

struct RootKernels;
struct TriangleKernels;
struct BoxKernels;
struct SphereKernels;
struct TraversalKernels;
struct KdKernels;
struct PointKernels;
struct WindingKernels;
struct AllQueryKernels;
struct DoubleRayKernels;

// The objects of a path, each from a translation unit of its own (kernels/*/).
struct KernelTable {
  const RootKernels& roots;
  const TriangleKernels& triangles;
  const BoxKernels& boxes;
  const SphereKernels& spheres;
  const TraversalKernels& traversal;
  const KdKernels& kdtree;
  // The rest is compiled once for each instruction set: paths by Highway have that of xsimd's path, if it is built.
  // The text of `traversal` once more, with counters: the same bytes of answers, and what they cost. Null where a test
  // is not counted, and all of them where the build was asked for no counters.
  const TraversalKernels& counted;
  const PointKernels& points;
  const WindingKernels& winding;
  const AllQueryKernels& queries;
  const DoubleRayKernels& doubles;

  bool has_counters() const;
};

// The part of a path that its users do not see.
struct PathKernels {
  static constexpr Path make(const char* name, const char* isa, const char* library, int lanes,
                             CpuFeatures required, const KernelTable& kernels) {
    return {name, isa, library, lanes, required, kernels};
  }
  static constexpr const KernelTable& of(const Path& path) { return path.kernels_; }
};

// Call them only if the path is supported.
inline const KernelTable& kernels_of(const Path& path) {
  return PathKernels::of(path);
}

}  // namespace raylanes
