// The first and the last steps of a build over triangles, for any tree.
#pragma once

#include <raylanes/bvh.hpp>

#include "../../dispatch/checked.hpp"
#include "../layout/bvh_arrays.hpp"
#include "builder_table.hpp"
#include "mesh_references.hpp"

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

struct TreeChoice {
  TreeBuilder builder;
  std::string why;  // one line
};

// How much larger boxes are than their content: half the surfaces of the boxes of triangles by twice the areas of the
// triangles. It is 1 for triangles that fill flat boxes, about 1.5 for a scan, and large for needles that lie askew.
// Looks at 4,096 references at most, in doubles: the result is the same on every machine. Returns 1 if no triangle has
// an area.
double box_waste(const Array<Reference>& references, const VertexView& vertices, const IndexView& triangles);

// `rays` means the same as in BuildOptions.
TreeChoice choose_tree(std::size_t triangles, double waste, double rays);

// The shares of a build's time at whose ends a bounding volume hierarchy has boxes, and nodes with leaves, about.
inline constexpr double end_of_bvh_boxes = 0.1, end_of_bvh_layout = 0.999;

// The build of a bounding volume hierarchy but for its boxes and leaves, which depend on the kind of numbers.
class BvhBuild : public BuildMeters {
 public:
  BvhBuild(const BuildOptions& options, std::size_t triangles, int threads)
      : BuildMeters(options.progress, threads, end_of_bvh_boxes), options_(options), triangles_(triangles) {}

  // Whether the builder is chosen by what references waste, as box_waste() says.
  bool chooses() const { return options_.choose; }
  // The tree over boxes as the options ask for, in phases of its own; begins the phase of the layout. The clipper is
  // for builders that split.
  BinaryTree binary_tree(Array<Reference> references, double waste, const Clipper* clipper);
  // The tree has its leaves: what it keeps of its build. A refit that has to build goes by the choice, too.
  void finish(NodesOfMesh& tree);

 private:
  BuildOptions options_;
  std::size_t triangles_;
  std::vector<std::uint32_t> left_out_;
  TreeReport report_;
};

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
