// The first and the last steps of a build over triangles, for any tree.
#pragma once

#include <string>

#include <raylanes/bvh.hpp>

#include "../../dispatch/checked.hpp"
#include "../layout/binary_tree.hpp"
#include "../mesh/valid_mesh.hpp"
#include "mesh_references.hpp"
#include "sah/triangle_clipper.hpp"

namespace raylanes {

// A build's meters; its first phase ends at `end_of_boxes`.
struct BuildMeters {
  ProgressMeter progress;
  MemoryMeter memory;
  BuildRun run;
  StopWatch watch;

  BuildMeters(const Progress& reports_to, int threads, double end_of_boxes)
      : progress(reports_to), run{threads, progress, memory} {
    progress.advance(0.0);
    progress.begin_phase(end_of_boxes);
  }
  void finish() {
    progress.begin_phase(1.0);
    progress.finish_phase();
  }
};

// With the boxes of the triangles, which it makes in the first phase. Throws as validate_mesh.
struct MeshBuild : BuildMeters {
  TriangleClipper clipper;
  Array<Reference> references;

  MeshBuild(VertexView vertices, IndexView triangles, const Progress& reports_to, int threads,
            double end_of_boxes)
      : BuildMeters(reports_to, threads, end_of_boxes), clipper(vertices, triangles) {
    require_valid_mesh(vertices, triangles, threads);
    references = references_of(vertices, triangles, run, end_of_boxes);
  }
};

// The shares of a build's time at whose ends a bounding volume hierarchy has boxes, and nodes with leaves, about.
inline constexpr double end_of_bvh_boxes = 0.1, end_of_bvh_layout = 0.999;

// Puts the builder and `optimize` that suit the mesh into the options, by which a refit that has to build goes, too;
// returns why. `waste` is box_waste().
std::string take_choice(const Array<Reference>& references, double waste, BuildOptions& options);
// The tree over boxes as the options ask for, in phases of its own; begins the phase of the layout. The clipper is for
// builders that split. The report gets what the boxes and the tree took.
BinaryTree binary_tree_of(Array<Reference> references, const TriangleClipper* clipper,
                          const BuildOptions& options, BuildMeters& build, TreeReport& report);

// Checks what the options of all trees have in common, then calls build(threads) where its threads are. The prefix of
// messages is the tree's name.
template <class Options, class Build>
auto build_checked(const char* name, IndexView triangles, const Options& options, const Build& build) {
  require_threads(name, options.threads);
  require_triangle_count(name, triangles.count);
  const QuietFloats quiet;
  decltype(build(0)) tree;
  on_threads(options.threads, [&](int threads) { tree = build(threads); });
  return tree;
}

}  // namespace raylanes
