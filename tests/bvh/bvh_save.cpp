// Bvhs and BvhDs as bytes: refitted as before, and refused if they are no tree though their checksum is right.
#include "../support/message_of.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"
#include "../trees/both_trees.hpp"
#include "saved_parts.hpp"

namespace raylanes::testing {
namespace {

template <class Tree>
class SavedTreeOf : public ::testing::Test {};
using WideKinds = ::testing::Types<Bvh, BvhD>;
TYPED_TEST_SUITE(SavedTreeOf, WideKinds, TreeKindNames);

TYPED_TEST(SavedTreeOf, a_mesh_is_refitted_as_before) {
  const auto mesh = soup_for<TypeParam>(300, 75), other = soup_for<TypeParam>(300, 76);
  auto dead = mesh;
  for (std::size_t i = 0; i < 100; ++i) dead.vertices[3 * i] = dead.vertices[3 * i + 1];
  const auto rays = rays_for(other, by_level(300), 77);
  for (const auto* const first : {&mesh, &std::as_const(dead)}) {
    auto tree = built<TypeParam>(*first), again = loaded<TypeParam>(saved(tree));
    tree.refit(other.vertices, other.triangles, 2);
    again.refit(other.vertices, other.triangles);
    expect_same(tree, again, rays, TriangleTest::exact);
    EXPECT_EQ(saved(tree), saved(again)) << "with any number of threads";
  }
}

TYPED_TEST(SavedTreeOf, a_mesh_knows_its_builder) {
  const auto mesh = soup_for<TypeParam>(300, 82);
  auto dead = mesh;
  dead.vertices[mesh.triangles[0][0]] = mesh.vertices[mesh.triangles[0][1]];
  for (auto [name, options] : builds_of<TypeParam>()) {
    auto tree = loaded<TypeParam>(saved(TypeParam(dead.vertices, dead.triangles, options)));
    EXPECT_EQ(tree.report().builder, options.builder);
    EXPECT_EQ(tree.report().optimized, options.optimize);
    EXPECT_EQ(tree.report().triangles, mesh.triangles.size() - 1);
    EXPECT_EQ(tree.report().left_out, 1u);
    tree.refit(mesh.vertices, mesh.triangles);
    EXPECT_EQ(saved(tree), saved(TypeParam(mesh.vertices, mesh.triangles, options))) << name;
  }
}

std::size_t slot_of(const WideNode& node, bool leaf) {
  std::size_t slot = 0;
  while (node.child[slot] == empty_reference || refers_to_leaf(node.child[slot]) != leaf) ++slot;
  return slot;
}

TYPED_TEST(SavedTreeOf, wrong_parts_is_refused_though_its_checksum_is_right) {
  using Kind = Parts<TypeParam>;
  using Inside = typename Kind::Inside;
  const auto expect_refused = [&](const std::vector<std::string>& words,
                                  const std::function<void(Inside&)>& change) {
    expect_words(refusal_of<TypeParam>(change), words);
  };
  expect_refused({"root"}, [](Inside& tree) { tree.root = 1; });
  expect_refused({"root"}, [](Inside& tree) { tree.root = leaf_bit; });
  expect_refused({"root"}, [](Inside& tree) { tree.root = empty_reference; });
  expect_refused({"node 0", "range"}, [](Inside& tree) {
    tree.nodes[0].child[slot_of(tree.nodes[0], false)] = 0;  // round and round
  });
  expect_refused({"range"}, [](Inside& tree) {
    tree.nodes[0].child[slot_of(tree.nodes[0], false)] = static_cast<TreeReference>(tree.nodes.size());
  });
  expect_refused({"two parents"}, [](Inside& tree) {
    WideNode& root = tree.nodes[0];
    const std::size_t slot = slot_of(root, false);
    for (std::size_t other = 0; other < tree_width; ++other)
      if (other != slot && !refers_to_leaf(root.child[other])) root.child[other] = root.child[slot];
  });
  expect_refused({"block", "exist"}, [](Inside& tree) {
    each_leaf_reference(tree, [](TreeReference& leaf) { leaf |= leaf_block_mask - 1; });
  });
  expect_refused({"block", "has a triangle"}, [](Inside& tree) {
    each_leaf_reference(tree, [](TreeReference& leaf) { leaf |= 7u << 28; });
  });
  expect_refused({"children"},
                 [](Inside& tree) { std::ranges::fill(tree.nodes.back().child, empty_reference); });
  expect_refused({"box"}, [](Inside& tree) { tree.nodes.back().occupied = 0; });
  expect_refused({"children"}, [](Inside& tree) { tree.nodes.back().occupied |= 256; });
  expect_refused({"behind"}, [](Inside& tree) { tree.nodes.back().unused[6] = 1; });
  expect_refused({"box"}, [](Inside& tree) { tree.nodes[1].lo[2][0] = nan; });
  expect_refused({"box"}, [](Inside& tree) { tree.nodes[1].hi[2][0] = infinity; });
  expect_refused({"box"}, [](Inside& tree) { std::swap(tree.nodes[1].lo[0][0], tree.nodes[1].hi[0][0]); });
  expect_refused({"bounds"}, [](Inside& tree) { tree.bounds.lo[1] = nan; });
  expect_refused({"cost"}, [](Inside& tree) { tree.built_cost = -1; });
  expect_refused({"corner"}, &Kind::spoil_corner);
  expect_refused({"triangle"}, [](Inside& tree) { Kind::set_triangle(tree, 300); });
  expect_refused({"counts"}, [](Inside& tree) { tree.mesh_triangles = max_mesh_triangles + 1; });
  expect_refused({"number of triangles 268435456"},
                 [](Inside& tree) { tree.mesh_triangles = max_mesh_triangles; });
  expect_refused({"number of triangles 301"}, [](Inside& tree) { ++tree.mesh_triangles; });
  expect_refused({"number of triangles"},
                 [](Inside& tree) { Kind::set_triangle(tree, Kind::first_triangle(tree)); });
  expect_refused({"left-out triangle", "leaf"},
                 [](Inside& tree) { ++tree.mesh_triangles, tree.left_out = {3}; });
  expect_refused({"left-out"}, [](Inside& tree) { tree.left_out = {3, 3}; });
  expect_refused({"left-out"}, [](Inside& tree) { tree.left_out = {300}; });
  expect_refused({"builder 6"}, [](Inside& tree) { tree.built_with.builder = TreeBuilder{6}; });
  expect_refused({"no leaf"}, &Kind::add_block);
}

TEST(SavedTree, of_doubles_has_bounds_tests_builders_and_ends_of_leaves_of_its_own) {
  const auto expect_refused = [&](const std::vector<std::string>& words,
                                  const std::function<void(BvhDArrays&)>& change) {
    expect_words(refusal_of<BvhD>(change), words);
  };
  expect_refused({"bounds along axis 1"}, [](BvhDArrays& tree) { tree.mesh_bounds.hi[1] = infinity; });
  expect_refused({"bounds along axis 2"}, [](BvhDArrays& tree) { tree.mesh_bounds.lo[2] = nan; });
  expect_refused({"bounds along axis 0"},
                 [](BvhDArrays& tree) { std::swap(tree.mesh_bounds.lo[0], tree.mesh_bounds.hi[0]); });
  expect_refused({"bounds along axis 0"}, [](BvhDArrays& tree) { tree.mesh_bounds = empty_double_box; });
  expect_refused({"frame along axis 1"}, [](BvhDArrays& tree) { tree.frame.centre[1] = infinity; });
  expect_refused({"frame is impossible"}, [](BvhDArrays& tree) { tree.frame.power = 2201; });
  expect_refused({"frame is impossible"}, [](BvhDArrays& tree) { tree.frame.power = -1101; });
  expect_refused({"spatial_splits"},
                 [](BvhDArrays& tree) { tree.built_with.builder = TreeBuilder::spatial_splits; });
  expect_refused({"behind"}, [](BvhDArrays& tree) {
    const std::size_t size = block_bytes * halves_of_leaf(Parts<BvhD>::a_leaf(tree).size);
    Parts<BvhD>::bytes(tree)[size - 1] = {};
  });
  // A leaf of two halves whose second one is another leaf, or behind the last one.
  expect_refused({"block"}, [](BvhDArrays& tree) {
    each_leaf_reference(tree, [](TreeReference& leaf) { leaf |= 4u << 28; });
  });
  expect_refused({"exist"}, [](BvhDArrays& tree) {
    const auto last = static_cast<std::uint32_t>(tree.halves.size() - 1);
    for (WideNode& node : tree.nodes) {
      TreeReference& child = node.child[slot_of(tree.nodes[0], false)];
      if (child != empty_reference && refers_to_leaf(child)) child = tree_reference({last, 8});
    }
  });
}

TEST(SavedTree, of_doubles_that_was_refitted_to_lines_loads) {
  DoubleMesh mesh = soup_for<BvhD>(40, 85);
  BvhD tree(mesh.vertices, mesh.triangles);
  for (Double3& vertex : mesh.vertices) vertex = {1, 2, 3};
  tree.refit(mesh.vertices, mesh.triangles);
  BvhD again = loaded<BvhD>(saved(tree));
  EXPECT_EQ(saved(again), saved(tree));
  mesh = soup_for<BvhD>(40, 86);
  again.refit(mesh.vertices, mesh.triangles);
  EXPECT_TRUE(same_bytes(again.bounds(), BvhD(mesh.vertices, mesh.triangles).bounds()));
}

// Nodes with one child each, and a leaf.
void make_chain(BvhArrays& tree, std::size_t nodes) {
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
  tree.corners = Leaves(0);
  std::memcpy(tree.corners.grow(1), &block, sizeof block);
  tree.left_out.clear();
  for (std::uint32_t i = 0; i < tree.mesh_triangles; ++i)
    if (std::find(block.primitive, block.primitive + size, i) == block.primitive + size)
      tree.left_out.push_back(i);
}

TEST(SavedTree, may_be_as_deep_as_traversals_can_follow) {
  EXPECT_EQ(refusal_of<Bvh>([](BvhArrays& tree) { make_chain(tree, max_tree_depth); }), "no exception");
  expect_words(refusal_of<Bvh>([](BvhArrays& tree) { make_chain(tree, max_tree_depth + 1); }), {"deep"});
}

// Each level takes room for eight lists; where there is none left a stream's rays go on alone.
TEST(SavedTree, that_is_as_deep_has_the_same_hits_in_every_mode) {
  const Mesh mesh = triangle_soup(300, 0.6f, 83);
  std::stringstream file, deep;
  file << saved(Bvh(mesh));
  BvhArrays tree = load_tree<BvhArrays>(file);
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
