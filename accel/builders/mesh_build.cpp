#include "mesh_build.hpp"

#include "builder_table.hpp"
#include "choice.hpp"
#include "reinsertion.hpp"

namespace raylanes {
namespace {

// The shares of a build's time at whose ends the binary tree is there, about: before and after subtrees are moved.
constexpr double end_of_first_tree = 0.5, end_of_tree = 0.7;

}  // namespace

std::string take_choice(const Array<Reference>& references, double waste, BuildOptions& options) {
  const TreeChoice choice = choose_tree(references.size(), waste, options.rays);
  options.builder = choice.builder, options.optimize = choice.optimize, options.choose = false;
  return choice.why;
}

BinaryTree binary_tree_of(Array<Reference> references, const TriangleClipper* clipper,
                          const BuildOptions& options, BuildMeters& build, TreeReport& report) {
  report.boxes_seconds = build.watch.lap();
  build.progress.begin_phase(options.optimize ? end_of_first_tree : end_of_tree);
  const BuilderInfo& builder = builders[static_cast<std::size_t>(options.builder)];
  BinaryTree binary = builder.build({std::move(references), clipper, build.run});
  report.tree_seconds = build.watch.lap();
  if (options.optimize) {
    build.progress.finish_phase();
    build.progress.begin_phase(end_of_tree);
    binary = reinserted(std::move(binary), build.run);
    report.optimize_seconds = build.watch.lap();
  }
  build.progress.finish_phase();
  build.progress.begin_phase(end_of_bvh_layout);
  return binary;
}

}  // namespace raylanes
