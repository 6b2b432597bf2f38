// Bvhs as bytes: refitted as before, and refused if they are no tree though their checksum is right.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../accel/file/tree_file.hpp"
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"
#include "../trees/both_trees.hpp"

namespace raylanes::testing {
namespace {

TEST(SavedTree, is_refitted_as_before) {
  const Mesh mesh = triangle_soup(300, 0.4f, 75);
  Mesh dead = mesh, other = triangle_soup(300, 0.4f, 76);
  for (std::size_t i = 0; i < 100; ++i) dead.vertices[3 * i] = dead.vertices[3 * i + 1];
  const std::vector<Ray> rays = mixed_rays(mesh, by_level(300), 2, {0, 0, 0}, 77);
  for (const Mesh* const first : {&std::as_const(mesh), &std::as_const(dead)}) {
    Bvh bvh(*first, {.test = TriangleTest::precomputed}), again = loaded<Bvh>(saved(bvh));
    for (Bvh* const tree : {&bvh, &again}) tree->refit(other.vertices, other.triangles, tree == &bvh ? 2 : 1);
    expect_same(bvh, again, rays, TriangleTest::precomputed);
    EXPECT_EQ(saved(bvh), saved(again)) << "with any number of threads";
    EXPECT_GT(again.decay(), 0);
  }
}

TEST(SavedTree, knows_its_builder) {
  const Mesh mesh = triangle_soup(300, 0.4f, 82);
  Mesh dead = mesh;
  dead.vertices[mesh.triangles[0][0]] = mesh.vertices[mesh.triangles[0][1]];
  for (std::size_t i = 0; i < tree_builder_names.size(); ++i) {
    const BuildOptions options{.builder = static_cast<TreeBuilder>(i), .optimize = i % 2 == 0};
    Bvh tree = loaded<Bvh>(saved(Bvh(dead, options)));
    EXPECT_EQ(tree.report().builder, options.builder);
    EXPECT_EQ(tree.report().optimized, options.optimize);
    EXPECT_EQ(tree.report().triangles, mesh.triangles.size() - 1);
    tree.refit(mesh.vertices, mesh.triangles);
    EXPECT_EQ(saved(tree), saved(Bvh(mesh, options))) << tree_builder_names[i];
  }
}

// A tree with one thing changed, saved with a right checksum.
std::string refusal_of(const std::function<void(WideTree&, LeafBlock<9>*)>& change) {
  std::stringstream file, again;
  file << saved(Bvh(triangle_soup(300, 0.4f, 81)));
  WideTree tree = load_tree(file);
  EXPECT_GT(tree.nodes.size(), 2u);
  change(tree, static_cast<LeafBlock<9>*>(tree.corners.blocks()));
  save_tree(tree, again);
  return message_of<std::runtime_error>([&] { load_tree(again); });
}

std::size_t slot_of(const WideNode& node, bool leaf) {
  std::size_t slot = 0;
  while (node.child[slot] == empty_reference || refers_to_leaf(node.child[slot]) != leaf) ++slot;
  return slot;
}

TEST(SavedTree, that_is_no_tree_is_refused_though_its_checksum_is_right) {
  const auto expect_refused = [&](const std::vector<std::string>& words,
                                  const std::function<void(WideTree&, LeafBlock<9>*)>& change) {
    expect_words(refusal_of(change), words);
  };
  expect_refused({"root"}, [](WideTree& tree, auto*) { tree.root = 1; });
  expect_refused({"root"}, [](WideTree& tree, auto*) { tree.root = leaf_bit; });
  expect_refused({"root"}, [](WideTree& tree, auto*) { tree.root = empty_reference; });
  expect_refused({"node 0", "range"}, [](WideTree& tree, auto*) {
    tree.nodes[0].child[slot_of(tree.nodes[0], false)] = 0;  // round and round
  });
  expect_refused({"range"}, [](WideTree& tree, auto*) {
    tree.nodes[0].child[slot_of(tree.nodes[0], false)] = static_cast<TreeReference>(tree.nodes.size());
  });
  expect_refused({"two parents"}, [](WideTree& tree, auto*) {
    WideNode& root = tree.nodes[0];
    const std::size_t slot = slot_of(root, false);
    for (std::size_t other = 0; other < tree_width; ++other)
      if (other != slot && !refers_to_leaf(root.child[other])) root.child[other] = root.child[slot];
  });
  expect_refused({"block", "exist"}, [](WideTree& tree, auto*) {
    for (WideNode& node : tree.nodes)
      for (TreeReference& child : node.child)
        if (child != empty_reference && refers_to_leaf(child)) child |= leaf_block_mask - 1;
  });
  expect_refused({"block", "has a triangle"}, [](WideTree& tree, auto*) {
    for (WideNode& node : tree.nodes)
      for (TreeReference& child : node.child)
        if (child != empty_reference && refers_to_leaf(child)) child |= 7u << 28;
  });
  expect_refused({"children"}, [](WideTree& tree, auto*) { tree.nodes.back().occupied = 0; });
  expect_refused({"children"}, [](WideTree& tree, auto*) { tree.nodes.back().occupied |= 256; });
  expect_refused({"behind"}, [](WideTree& tree, auto*) { tree.nodes.back().unused[6] = 1; });
  expect_refused({"box"}, [](WideTree& tree, auto*) { tree.nodes[1].lo[2][0] = nan; });
  expect_refused({"box"}, [](WideTree& tree, auto*) { tree.nodes[1].hi[2][0] = infinity; });
  expect_refused({"box"},
                 [](WideTree& tree, auto*) { std::swap(tree.nodes[1].lo[0][0], tree.nodes[1].hi[0][0]); });
  expect_refused({"bounds"}, [](WideTree& tree, auto*) { tree.bounds.lo[1] = nan; });
  expect_refused({"cost"}, [](WideTree& tree, auto*) { tree.built_cost = -1; });
  expect_refused({"corner"}, [](WideTree&, LeafBlock<9>* blocks) { blocks[1].number[8][0] = infinity; });
  expect_refused({"triangle"}, [](WideTree&, LeafBlock<9>* blocks) { blocks[1].primitive[0] = 300; });
  expect_refused({"counts"}, [](WideTree& tree, auto*) { tree.mesh_triangles = max_mesh_triangles + 1; });
  expect_refused({"number of triangles 268435456"},
                 [](WideTree& tree, auto*) { tree.mesh_triangles = max_mesh_triangles; });
  expect_refused({"number of triangles 301"}, [](WideTree& tree, auto*) { ++tree.mesh_triangles; });
  expect_refused({"number of triangles"},
                 [](WideTree&, LeafBlock<9>* blocks) { blocks[1].primitive[0] = blocks[0].primitive[0]; });
  expect_refused({"left-out triangle", "leaf"},
                 [](WideTree& tree, auto*) { ++tree.mesh_triangles, tree.left_out = {3}; });
  expect_refused({"left-out"}, [](WideTree& tree, auto*) { tree.left_out = {3, 3}; });
  expect_refused({"left-out"}, [](WideTree& tree, auto*) { tree.left_out = {300}; });
  expect_refused({"test 99"},
                 [](WideTree& tree, auto*) { tree.prepared_for = static_cast<TriangleTest>(99); });
  expect_refused({"builder 6"}, [](WideTree& tree, auto*) { tree.built_with.builder = TreeBuilder{6}; });
  expect_refused({"no leaf"}, [](WideTree& tree, LeafBlock<9>* blocks) {
    const LeafBlock<9> again = blocks[0];
    std::memcpy(tree.corners.grow(1), &again, sizeof again);
  });
}

// Nodes with one child each, and a leaf.
void make_chain(WideTree& tree, std::size_t nodes) {
  const LeafBlock<9> block = *static_cast<const LeafBlock<9>*>(tree.corners.blocks());
  const auto size = std::find(block.primitive, block.primitive + tree_width, no_primitive) - block.primitive;
  const TreeReference leaf = tree_reference({0, static_cast<std::uint32_t>(size)});
  WideNode node = tree.nodes[0];
  for (std::size_t slot = 0; slot < tree_width; ++slot) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.lo[axis][slot] = slot == 0 ? -2 : infinity;
      node.hi[axis][slot] = slot == 0 ? 2 : -infinity;
    }
    node.child[slot] = empty_reference;
  }
  node.occupied = 1;
  tree.nodes.assign(nodes, node);
  for (std::size_t i = 0; i < nodes; ++i)
    tree.nodes[i].child[0] = i + 1 < nodes ? static_cast<TreeReference>(i + 1) : leaf;
  tree.corners = Leaves(TriangleTest::exact, 0);
  std::memcpy(tree.corners.grow(1), &block, sizeof block);
  tree.left_out.clear();
  for (std::uint32_t i = 0; i < tree.mesh_triangles; ++i)
    if (std::find(block.primitive, block.primitive + size, i) == block.primitive + size)
      tree.left_out.push_back(i);
}

TEST(SavedTree, may_be_as_deep_as_traversals_can_follow) {
  EXPECT_EQ(refusal_of([](WideTree& tree, auto*) { make_chain(tree, max_tree_depth); }), "no exception");
  expect_words(refusal_of([](WideTree& tree, auto*) { make_chain(tree, max_tree_depth + 1); }), {"deep"});
}

// Each level takes room for eight lists; where there is none left a stream's rays go on alone.
TEST(SavedTree, that_is_as_deep_has_the_same_hits_in_every_mode) {
  const Mesh mesh = triangle_soup(300, 0.6f, 83);
  std::stringstream file, deep;
  file << saved(Bvh(mesh));
  WideTree tree = load_tree(file);
  make_chain(tree, max_tree_depth);
  save_tree(tree, deep);
  const Bvh chain = Bvh::load(deep);
  const std::vector<Ray> rays = mixed_rays(mesh, 2000, 2, {0, 0, 0}, 84);
  const std::vector<Hit> hits = trace(chain, rays, {.mode = TraversalMode::single});
  EXPECT_GT(std::ranges::count_if(hits, [](const Hit& hit) { return static_cast<bool>(hit); }), 5);
  expect_hits(chain, rays, hits);
}

}  // namespace
}  // namespace raylanes::testing
