#include "tree_file.hpp"

#include "tree_stream.hpp"
#include "valid_parts.hpp"
#include "valid_tree.hpp"

namespace raylanes {
namespace {

constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t nodes, blocks, left_out, mesh_triangles;
  double built_cost;
  Box bounds;
  std::uint32_t unused[3], root, older_test, builder;
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

// In what files of trees differ by the numbers of their corners.
template <class Tree>
struct Format;

template <>
struct Format<WideTree> {
  static constexpr FileKind kind = FileKind::bvh;
  static FilePart leaves(const WideTree& tree) { return {tree.corners.blocks(), tree.corners.bytes()}; }
  static Leaves& leaves(WideTree& tree) { return tree.corners; }
  struct Place {};
  static Place place(const WideTree&) { return {}; }
  static std::size_t place_bytes() { return 0; }
  static void put(const Place&, WideTree&) {}
  static void require_possible(const Header& header) { require_older_test(header.older_test); }
  static void finish(WideTree&) {}
};

template <>
struct Format<DoubleTree> {
  static constexpr FileKind kind = FileKind::bvh_of_doubles;
  static FilePart leaves(const DoubleTree& tree) { return {tree.halves.data(), tree.halves.bytes()}; }
  static Array<LeafHalf>& leaves(DoubleTree& tree) { return tree.halves; }
  // Behind the header.
  struct Place {
    BoxD bounds;
    Double3 centre;
    std::int64_t power;
  };
  static_assert(sizeof(Place) == 80, "no padding");
  static Place place(const DoubleTree& tree) {
    return {tree.mesh_bounds, tree.frame.centre, tree.frame.power};
  }
  static std::size_t place_bytes() { return sizeof(Place); }
  static void put(const Place& place, DoubleTree& tree) {
    // Meshes of doubles have no other power, and a larger one would take its time.
    if (place.power < -1100 || place.power > 2200) refuse_file("its frame is impossible");
    tree.mesh_bounds = place.bounds;
    tree.frame = {place.centre, static_cast<int>(place.power)};
  }
  static void require_possible(const Header& header) {
    if (header.older_test != 0) refuse_file("it has something where its header is unused");
    if ((header.builder & ~optimized_bit) == static_cast<std::uint32_t>(TreeBuilder::spatial_splits))
      refuse_file("trees of doubles do not split triangles; the builder is spatial_splits");
  }
  static void finish(DoubleTree& tree) {
    tree.leaves = 0;
    each_leaf_reference(tree, [&](TreeReference) { ++tree.leaves; });
  }
};

template <class Tree>
Header header_of(const Tree& tree) {
  Header header{};
  header.nodes = tree.nodes.size(), header.blocks = Format<Tree>::leaves(tree).size / block_bytes;
  header.left_out = tree.left_out.size(), header.mesh_triangles = tree.mesh_triangles;
  header.built_cost = tree.built_cost, header.bounds = tree.bounds;
  header.root = tree.root;
  header.builder =
      static_cast<std::uint32_t>(tree.built_with.builder) | (tree.built_with.optimize ? optimized_bit : 0);
  return header;
}

// Numbers that no tree has, before they are multiplied or cast.
void require_possible(const Header& header) {
  if (header.nodes >= leaf_bit || header.blocks > leaf_block_mask ||
      header.mesh_triangles > max_mesh_triangles || header.left_out > header.mesh_triangles)
    refuse_file("its counts are impossible");
  const std::uint32_t builder = header.builder & ~optimized_bit;
  if (builder >= tree_builder_names.size())
    refuse_file("builder " + std::to_string(builder) + " does not exist");
  if ((header.unused[0] | header.unused[1] | header.unused[2]) != 0)
    refuse_file("it has something where its header is unused");
}

}  // namespace

template <class Tree>
void save_tree(const Tree& tree, std::ostream& file) {
  const Header header = header_of(tree);
  const auto place = Format<Tree>::place(tree);
  const FilePart parts[] = {{&header, sizeof header},
                            {&place, Format<Tree>::place_bytes()},
                            {tree.nodes.data(), tree.nodes.size() * sizeof(WideNode)},
                            Format<Tree>::leaves(tree),
                            {tree.left_out.data(), tree.left_out.size() * sizeof(std::uint32_t)}};
  write_tree(file, Format<Tree>::kind, format_version, parts);
}

template <class Tree>
Tree load_tree(std::istream& file) {
  TreeReader reader(file, Format<Tree>::kind, format_version);
  Header header;
  reader.read(&header, sizeof header);
  Tree tree;
  require_possible(header);
  Format<Tree>::require_possible(header);
  typename Format<Tree>::Place place;
  reader.read(&place, Format<Tree>::place_bytes());
  Format<Tree>::put(place, tree);
  reader.read_array(header.nodes, tree.nodes);
  reader.read_array(header.blocks, Format<Tree>::leaves(tree));
  reader.read_array(header.left_out, tree.left_out);
  reader.require_checksum();
  tree.root = header.root, tree.bounds = header.bounds;
  tree.mesh_triangles = static_cast<std::size_t>(header.mesh_triangles);
  tree.built_cost = header.built_cost;
  tree.built_with.builder = static_cast<TreeBuilder>(header.builder & ~optimized_bit);
  tree.built_with.optimize = (header.builder & optimized_bit) != 0;
  validate_tree(tree);
  Format<Tree>::finish(tree);
  return tree;
}

template void save_tree(const WideTree& tree, std::ostream& file);
template void save_tree(const DoubleTree& tree, std::ostream& file);
template WideTree load_tree(std::istream& file);
template DoubleTree load_tree(std::istream& file);

}  // namespace raylanes
