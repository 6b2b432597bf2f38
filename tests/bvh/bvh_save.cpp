// Trees as bytes: what is loaded traces as what was saved did, and what is cut or damaged is refused.
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
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

std::string saved(const Bvh& bvh) {
  std::ostringstream file;
  bvh.save(file);
  return file.str();
}
Bvh loaded(const std::string& bytes) {
  std::istringstream file(bytes);
  return Bvh::load(file);
}

// Says what is in it, but neither where it is nor how much is left.
class Pipe : public std::streambuf {
 public:
  explicit Pipe(const std::string& bytes) : bytes_(bytes) {}

 protected:
  int_type underflow() override {
    if (next_ == bytes_.size()) return traits_type::eof();
    byte_ = bytes_[next_++];
    setg(&byte_, &byte_, &byte_ + 1);
    return traits_type::to_int_type(byte_);
  }

 private:
  std::string bytes_;
  std::size_t next_ = 0;
  char byte_ = 0;
};

void expect_same(const Bvh& a, const Bvh& b, std::span<const Ray> rays, TriangleTest test) {
  for (const TraceOptions& way : ways_to_trace({.test = test})) {
    const std::vector<Hit> hits = trace(a, rays, way), same = trace(b, rays, way);
    EXPECT_EQ(std::memcmp(hits.data(), same.data(), hits.size() * sizeof(Hit)), 0) << name_of(way);
    EXPECT_EQ(trace_occluded(a, rays, way), trace_occluded(b, rays, way)) << name_of(way);
  }
  EXPECT_EQ(a.bounds().lo, b.bounds().lo);
  EXPECT_EQ(a.bounds().hi, b.bounds().hi);
  EXPECT_EQ(a.bytes(), b.bytes());
  EXPECT_EQ(a.node_count(), b.node_count());
  EXPECT_EQ(a.leaf_count(), b.leaf_count());
  EXPECT_EQ(a.decay(), b.decay());
  EXPECT_EQ(a.sah_cost(), b.sah_cost());
}

TEST(SavedTree, traces_the_same_bytes) {
  for (const std::size_t size : {0u, 1u, 8u, 9u, 65u, 700u}) {
    SCOPED_TRACE(size);
    const Mesh mesh = triangle_soup(size, 0.4f, size);
    const std::vector<Ray> rays = mixed_rays(mesh, by_level(300), 2, {0, 0, 0}, 71);
    for (const TriangleTestInfo& test : triangle_tests) {
      if (!test.serves_trees) continue;
      const Bvh bvh(mesh, {.test = test.test});
      expect_same(bvh, loaded(saved(bvh)), rays, test.test);
      EXPECT_EQ(saved(loaded(saved(bvh))), saved(bvh));
    }
  }
  expect_same(Bvh(), loaded(saved(Bvh())), mixed_rays({}, 20, 2, {0, 0, 0}, 72), TriangleTest::exact);
}

TEST(SavedTree, may_lie_among_other_things_and_come_through_a_pipe) {
  const Mesh mesh = triangle_soup(200, 0.4f, 73);
  const std::vector<Ray> rays = mixed_rays(mesh, 200, 2, {0, 0, 0}, 74);
  const Bvh bvh(mesh);
  const std::string bytes = "before" + saved(bvh) + saved(Bvh()) + "behind";
  const auto expect_read = [&](std::istream& file) {
    std::string word(6, ' ');
    file.read(word.data(), 6);
    expect_same(bvh, Bvh::load(file), rays, TriangleTest::exact);
    EXPECT_EQ(Bvh::load(file).leaf_count(), 0u);
    file.read(word.data(), 6);
    EXPECT_EQ(word, "behind");
  };
  std::istringstream file(bytes);
  expect_read(file);
  Pipe pipe(bytes);
  std::istream stream(&pipe);
  expect_read(stream);
}

TEST(SavedTree, is_refitted_as_before) {
  const Mesh mesh = triangle_soup(300, 0.4f, 75);
  Mesh dead = mesh, other = triangle_soup(300, 0.4f, 76);
  for (std::size_t i = 0; i < 100; ++i) dead.vertices[3 * i] = dead.vertices[3 * i + 1];
  const std::vector<Ray> rays = mixed_rays(mesh, by_level(300), 2, {0, 0, 0}, 77);
  for (const Mesh* const first : {&std::as_const(mesh), &std::as_const(dead)}) {
    Bvh bvh(*first, {.test = TriangleTest::precomputed}), again = loaded(saved(bvh));
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
    Bvh tree = loaded(saved(Bvh(dead, options)));
    EXPECT_EQ(tree.report().builder, options.builder);
    EXPECT_EQ(tree.report().optimized, options.optimize);
    EXPECT_EQ(tree.report().triangles, mesh.triangles.size() - 1);
    tree.refit(mesh.vertices, mesh.triangles);
    EXPECT_EQ(saved(tree), saved(Bvh(mesh, options))) << tree_builder_names[i];
  }
}

TEST(SavedTree, is_refused_if_it_was_cut_anywhere) {
  const std::string bytes = saved(Bvh(triangle_soup(20, 0.4f, 78)));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string cut = bytes.substr(0, size);
    ASSERT_NE(message_of<std::runtime_error>([&] { loaded(cut); }).find("ends before"), std::string::npos)
        << size;
    Pipe pipe(cut);
    std::istream stream(&pipe);
    ASSERT_NE(message_of<std::runtime_error>([&] { Bvh::load(stream); }).find("ends before"),
              std::string::npos)
        << size;
  }
}

TEST(SavedTree, is_refused_with_any_bit_the_other_way) {
  std::string bytes = saved(Bvh(triangle_soup(20, 0.4f, 79)));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
    ASSERT_THROW(loaded(bytes), std::runtime_error) << "bit " << bit;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
  }
  EXPECT_EQ(loaded(bytes).leaf_count(), Bvh(triangle_soup(20, 0.4f, 79)).leaf_count());
}

TEST(SavedTree, says_what_is_wrong) {
  const std::string bytes = saved(Bvh(triangle_soup(20, 0.4f, 80)));
  const auto message = [&](std::size_t at, char byte) {
    std::string wrong = bytes;
    wrong[at] = byte;
    return message_of<std::runtime_error>([&] { loaded(wrong); });
  };
  expect_words(message(0, 'x'), {"tree file", "begin"});
  expect_words(message(16, 4), {"byte order"});
  expect_words(message(20, 9), {"version 9", "1"});
  expect_words(message(24, static_cast<char>(bytes[24] + 1)), {"checksum"});
  expect_words(message(bytes.size() - 1, 'x'), {"checksum"});
  std::ostringstream full;
  full.setstate(std::ios::badbit);
  expect_words(message_of<std::runtime_error>([&] { Bvh().save(full); }), {"tree file", "written"});
  std::istringstream bad(bytes);
  bad.setstate(std::ios::badbit);
  expect_words(message_of<std::runtime_error>([&] { Bvh::load(bad); }), {"tree file", "read"});
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
