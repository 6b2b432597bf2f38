#include "tree_file.hpp"

#include "tree_stream.hpp"
#include "valid_tree.hpp"

namespace raylanes {
namespace {

constexpr Magic magic{'r', 'a', 'y', 'l', 'a', 'n', 'e', 's', ' ', 't', 'r', 'e', 'e', '\r', '\n', '\x1a'};
constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t nodes, blocks, left_out, mesh_triangles;
  double built_cost;
  Box bounds;
  std::uint32_t unused[3], root, test, builder;
};
static_assert(sizeof(Header) == 88 && alignof(Header) == 8, "no padding");

// Stored in files: an enumerator keeps its value, new ones come last.
static_assert(tree_builder_names.size() == 6 && static_cast<int>(TreeBuilder::median) == 0 &&
              static_cast<int>(TreeBuilder::equal_partition) == 1 &&
              static_cast<int>(TreeBuilder::binned_sah) == 2 &&
              static_cast<int>(TreeBuilder::sweep_sah) == 3 &&
              static_cast<int>(TreeBuilder::spatial_splits) == 4 &&
              static_cast<int>(TreeBuilder::morton) == 5);

// The bit of a file's builder number that says that the tree is optimized.
constexpr std::uint32_t optimized_bit = 0x80000000u;

Header header_of(const WideTree& tree) {
  Header header{};
  header.nodes = tree.nodes.size(), header.blocks = tree.corners.count();
  header.left_out = tree.left_out.size(), header.mesh_triangles = tree.mesh_triangles;
  header.built_cost = tree.built_cost, header.bounds = tree.bounds;
  header.root = tree.root, header.test = static_cast<std::uint32_t>(tree.prepared_for);
  header.builder =
      static_cast<std::uint32_t>(tree.built_with.builder) | (tree.built_with.optimize ? optimized_bit : 0);
  return header;
}

// Numbers that no tree has, before they are multiplied or cast.
void require_possible(const Header& header) {
  if (header.nodes >= leaf_bit || header.blocks > leaf_block_mask ||
      header.mesh_triangles > max_mesh_triangles || header.left_out > header.mesh_triangles)
    refuse_file("its counts are impossible");
  require_test(header.test);
  const std::uint32_t builder = header.builder & ~optimized_bit;
  if (builder >= tree_builder_names.size())
    refuse_file("builder " + std::to_string(builder) + " does not exist");
  if ((header.unused[0] | header.unused[1] | header.unused[2]) != 0)
    refuse_file("it has something where its header is unused");
}

}  // namespace

void save_tree(const WideTree& tree, std::ostream& file) {
  const Header header = header_of(tree);
  const FilePart parts[] = {{&header, sizeof header},
                            {tree.nodes.data(), tree.nodes.size() * sizeof(WideNode)},
                            {tree.corners.blocks(), tree.corners.bytes()},
                            {tree.left_out.data(), tree.left_out.size() * sizeof(std::uint32_t)}};
  write_tree(file, magic, format_version, parts);
}

WideTree load_tree(std::istream& file) {
  TreeReader reader(file, magic, format_version);
  Header header;
  reader.read(&header, sizeof header);
  WideTree tree;
  require_possible(header);
  reader.read_array(header.nodes, tree.nodes);
  reader.read_array(header.blocks, tree.corners);
  reader.read_array(header.left_out, tree.left_out);
  reader.require_checksum();
  tree.root = header.root, tree.bounds = header.bounds;
  tree.mesh_triangles = static_cast<std::size_t>(header.mesh_triangles);
  tree.built_cost = header.built_cost;
  tree.built_with.test = static_cast<TriangleTest>(header.test);
  tree.built_with.builder = static_cast<TreeBuilder>(header.builder & ~optimized_bit);
  tree.built_with.optimize = (header.builder & optimized_bit) != 0;
  validate_tree(tree);
  tree.prepare(tree.built_with.test);
  return tree;
}

}  // namespace raylanes
