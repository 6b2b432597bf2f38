#include "../builders/builder_table.hpp"
#include "../builders/mesh_build.hpp"
#include "../mesh/valid_mesh.hpp"

namespace raylanes {
namespace {

BvhArrays build_on(const VertexView& vertices, const IndexView& triangles, const BuildOptions& options,
                   int threads) {
  BvhBuild build(options, triangles.count, threads);
  require_valid_mesh(vertices, triangles, threads);
  const TriangleClipper clipper(vertices, triangles);
  Array<Reference> references = references_of(vertices, triangles, build.run, end_of_bvh_boxes);
  const double waste = build.chooses() ? box_waste(references, vertices, triangles) : 1.0;
  BinaryTree binary = build.binary_tree(std::move(references), waste, &clipper);
  BvhArrays tree = collapse_to_bvh(std::move(binary), {vertices, triangles}, build.run);
  build.finish(tree);
  return tree;
}

}  // namespace

BvhArrays build_bvh(VertexView vertices, IndexView triangles, const BuildOptions& options) {
  checked_index("bvh", "builder", options.builder, std::size(builders));
  return build_checked("bvh", triangles, options,
                       [&](int threads) { return build_on(vertices, triangles, options, threads); });
}

}  // namespace raylanes
