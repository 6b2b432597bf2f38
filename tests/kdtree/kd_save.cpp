// k-d trees as bytes: refused if they are no tree though their checksum is right.
#include "../../accel/file/tree_file.hpp"
#include "../support/message_of.hpp"
#include "../support/same_bytes.hpp"
#include "../trees/both_trees.hpp"
#include "kd_trees.hpp"

namespace raylanes::testing {
namespace {

// A tree with one thing changed, saved with a right checksum.
std::string refusal_of(const std::function<void(KdTreeArrays&, LeafBlock<9>*)>& change) {
  std::stringstream file, again;
  file << saved(KdTree(triangle_soup(100, 0.4f, 81), {.builder = KdBuilder::midpoint}));
  KdTreeArrays tree = load_cells(file);
  EXPECT_TRUE(tree.nodes.size() > 4 && tree.nodes[0].keeps_triangles());
  change(tree, static_cast<LeafBlock<9>*>(tree.corners.blocks()));
  save_cells(tree, again);
  return message_of<std::runtime_error>([&] { load_cells(again); });
}

// Planes in a row, each with an empty leaf below it, and a leaf at the end.
void make_chain(KdTreeArrays& tree, std::uint32_t planes) {
  const LeafBlock<9> block = *static_cast<const LeafBlock<9>*>(tree.corners.blocks());
  std::uint32_t size = 0;
  while (size < tree_width && block.primitive[size] != no_primitive) ++size;
  tree.nodes.assign(1, {});
  for (std::uint32_t i = 0; i < planes; ++i) {
    tree.nodes[2 * i] = KdNode::inner(2, -2, false, 2 * i + 1);
    tree.nodes.push_back(KdNode::leaf(0, 0));
    tree.nodes.push_back({});
  }
  tree.nodes.back() = KdNode::leaf(0, size);
  tree.corners = Leaves(0);
  std::memcpy(tree.corners.grow(1), &block, sizeof block);
  tree.build_report.triangles = size;
}

TEST(SavedKdTree, that_is_no_tree_is_refused_though_its_checksum_is_right) {
  const auto expect_refused = [&](const std::vector<std::string>& words,
                                  const std::function<void(KdTreeArrays&, LeafBlock<9>*)>& change) {
    expect_words(refusal_of(change), words);
  };
  const auto root_with_child = [](std::size_t first) {
    return [first](KdTreeArrays& tree, auto*) {
      tree.nodes[0] = KdNode::inner(0, tree.nodes[0].plane(), true, static_cast<std::uint32_t>(first));
    };
  };
  expect_refused({"node 0", "range"}, root_with_child(0));
  expect_refused({"node 0", "range"}, root_with_child(max_kd_nodes - 1));
  expect_refused({"node", "parent"},
                 [](KdTreeArrays& tree, auto*) { tree.nodes.push_back(tree.nodes.back()); });
  expect_refused({"node 3", "two parents"}, [](KdTreeArrays& tree, auto*) {
    make_chain(tree, 1);
    const KdNode leaf = tree.nodes.back(), below_both = KdNode::inner(2, -2, false, 3);
    tree.nodes = {KdNode::inner(2, -2, false, 1), below_both, below_both, KdNode::leaf(0, 0), leaf};
  });
  expect_refused({"plane"},
                 [](KdTreeArrays& tree, auto*) { tree.nodes[0] = KdNode::inner(1, nan, true, 1); });
  expect_refused({"keeps"},
                 [](KdTreeArrays& tree, auto*) { tree.nodes[3] = KdNode::leaf(tree.nodes[3].first(), 0); });
  expect_refused({"block"}, [](KdTreeArrays& tree, auto*) {
    for (KdNode& node : tree.nodes)
      if (node.is_leaf() && node.count() > 0) node.value += 8;
  });
  expect_refused({"block"}, [](KdTreeArrays& tree, auto*) {
    for (KdNode& node : tree.nodes)
      if (node.is_leaf() && node.count() > 0) node.value = 0xffffffffu;
  });
  expect_refused({"node", "blocks behind"}, [](KdTreeArrays& tree, auto*) {
    for (KdNode& node : tree.nodes)
      if (node.is_leaf()) node.link += 8;
  });
  expect_refused({"corner"}, [](KdTreeArrays&, LeafBlock<9>* blocks) { blocks[1].number[8][0] = infinity; });
  expect_refused({"triangle"}, [](KdTreeArrays&, LeafBlock<9>* blocks) { blocks[1].primitive[0] = 100; });
  expect_refused({"bounds"}, [](KdTreeArrays& tree, auto*) { tree.bounds.lo[1] = nan; });
  expect_refused({"counts"}, [](KdTreeArrays& tree, auto*) { tree.mesh_triangles = max_mesh_triangles + 1; });
  expect_refused({"number of triangles 99"},
                 [](KdTreeArrays& tree, auto*) { --tree.build_report.triangles; });
  expect_refused({"number of triangles 100"}, [](KdTreeArrays&, LeafBlock<9>* blocks) {
    blocks[1].primitive[0] = blocks[0].primitive[0];
  });
  expect_refused({"builder 2"}, [](KdTreeArrays& tree, auto*) { tree.built_with.builder = KdBuilder{2}; });
}

TEST(SavedKdTree, may_be_as_deep_as_traversals_can_follow) {
  EXPECT_EQ(refusal_of([](KdTreeArrays& tree, auto*) { make_chain(tree, max_kd_depth); }), "no exception");
  expect_words(refusal_of([](KdTreeArrays& tree, auto*) { make_chain(tree, max_kd_depth + 1); }), {"deep"});
}

}  // namespace
}  // namespace raylanes::testing
