#include "mesh_build.hpp"

#include "../layout/cost.hpp"
#include "builder_table.hpp"

namespace raylanes {
namespace {

// The shares of a build's time at whose ends the binary tree is there, about: before and after subtrees are moved.
constexpr double end_of_first_tree = 0.5, end_of_tree = 0.7;

}  // namespace

BinaryTree BvhBuild::binary_tree(Array<Reference> references, double waste, const Clipper* clipper) {
  left_out_ = left_out_of(triangles_, references);
  memory.hold(left_out_.size() * sizeof(std::uint32_t));
  if (options_.choose) {
    TreeChoice choice = choose_tree(references.size(), waste, options_.rays);
    options_.builder = choice.builder, options_.choose = false;
    report_.choice = std::move(choice.why);
  }
  report_.boxes_seconds = watch.lap();
  progress.begin_phase(options_.optimize ? end_of_first_tree : end_of_tree);
  const BuilderInfo& builder = builders[static_cast<std::size_t>(options_.builder)];
  BinaryTree binary = builder.build({std::move(references), clipper, run});
  report_.tree_seconds = watch.lap();
  if (options_.optimize) {
    progress.finish_phase();
    progress.begin_phase(end_of_tree);
    binary = reinserted(std::move(binary), run);
    report_.optimize_seconds = watch.lap();
  }
  progress.finish_phase();
  progress.begin_phase(end_of_bvh_layout);
  return binary;
}

void BvhBuild::finish(NodesOfMesh& tree) {
  report_.layout_seconds = watch.lap();
  report_.peak_bytes = memory.peak();
  tree.left_out = std::move(left_out_);
  tree.built_cost = sah_cost(tree);
  tree.set_build(options_, triangles_, std::move(report_));
  BuildMeters::finish();
}

}  // namespace raylanes
