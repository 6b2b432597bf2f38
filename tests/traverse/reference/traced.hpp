// Tracing a tree in every way there is, and holding the hits to a brute force.
#pragma once

#include <raylanes/kdtree.hpp>

#include "../../support/testing.hpp"

namespace raylanes::testing {

// Every mode that has kernels on every supported path, one thread; the rest as in `base`.
std::vector<TraceOptions> ways_to_trace(const TraceOptions& base = {});

// The same with every test of trees in both grades.
std::vector<TraceOptions> ways_by_every_test();

// For messages: path, mode, test, grade, threads.
std::string name_of(const TraceOptions& options);

std::vector<Hit> trace(const TriangleTree& tree, std::span<const Ray> rays, const TraceOptions& options);
std::vector<std::uint8_t> trace_occluded(const TriangleTree& tree, std::span<const Ray> rays,
                                         const TraceOptions& options);

// Adds a test failure unless the hits have the bytes of `expected`, and a ray is occluded exactly if it hits: in every
// way to trace with the options of `base`.
void expect_hits(const TriangleTree& tree, std::span<const Ray> rays, std::span<const Hit> expected,
                 const TraceOptions& base = {});

// The same with the hits of exact arithmetic over the mesh, for a BVH in both grades (one where quick() holds) and for
// k-d trees. The watertight test of the reproducible grade has the hits of brute_force; in cells of needles it has not,
// as most rays come nearly in the plane of one, which is outside of its promise. Returns how many rays hit.
std::size_t expect_brute_force(const Mesh& mesh, std::span<const Ray> rays, bool are_needles = false);

// Through the tree, with the hits of exact arithmetic, also where subnormals count as zeros. Returns how many hit.
std::size_t expect_exact_hits(const TriangleTree& tree, const Mesh& mesh, std::span<const Ray> rays);

// The same for a BVH and a k-d tree, with hits of at least so many rays. And every way to trace has the hits of single
// rays by scalar code for triangles of one side, and without the triangles that most rays hit first.
void expect_exact(const Mesh& mesh, std::span<const Ray> rays, std::size_t min_hits);

}  // namespace raylanes::testing
