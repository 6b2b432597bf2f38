// The first and the last steps of a build over triangles, for any tree.
#pragma once

#include "../../dispatch/checked.hpp"
#include "mesh_references.hpp"
#include "sah/triangle_clipper.hpp"

namespace raylanes {

// A build's meters, and the boxes of its triangles, which it makes in the phase that ends at `end_of_boxes`. Throws as
// validate_mesh.
struct MeshBuild {
  ProgressMeter progress;
  MemoryMeter memory;
  BuildRun run;
  StopWatch watch;
  TriangleClipper clipper;
  Array<Reference> references;

  MeshBuild(VertexView vertices, IndexView triangles, const Progress& reports_to, int threads,
            double end_of_boxes)
      : progress(reports_to), run{threads, progress, memory}, clipper(vertices, triangles) {
    progress.advance(0.0);
    progress.begin_phase(end_of_boxes);
    validate_mesh(vertices, triangles);
    references = references_of(vertices, triangles, run, end_of_boxes);
  }

  void finish() {
    progress.begin_phase(1.0);
    progress.finish_phase();
  }
};

// Checks what the options of all trees have in common, then calls build(threads) where its threads are. The prefix of
// messages is the tree's name.
template <class Options, class Build>
auto build_checked(const char* name, IndexView triangles, const Options& options, const Build& build) {
  checked_tree_test(name, options.test);
  require_threads(name, options.threads);
  require_triangle_count(name, triangles.count);
  const QuietFloats quiet;
  decltype(build(0)) tree;
  on_threads(options.threads, [&](int threads) { tree = build(threads); });
  return tree;
}

}  // namespace raylanes
