// Files of Bvh and BvhD.

#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "tree_file.hpp"

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
struct Format<BvhArrays> {
  static constexpr FileKind kind = FileKind::bvh;
  static FilePart leaves(const BvhArrays& tree) { return {tree.corners.blocks(), tree.corners.bytes()}; }
  static Leaves& leaves(BvhArrays& tree) { return tree.corners; }
  struct Place {};
  static Place place(const BvhArrays&) { return {}; }
  static std::size_t place_bytes() { return 0; }
  static void put(const Place&, BvhArrays&) {}
  static void require_possible(const Header& header) { require_older_test(header.older_test); }
  static void finish(BvhArrays&) {}
};

template <>
struct Format<BvhDArrays> {
  static constexpr FileKind kind = FileKind::bvh_of_doubles;
  static FilePart leaves(const BvhDArrays& tree) { return {tree.halves.data(), tree.halves.bytes()}; }
  static Array<LeafHalf>& leaves(BvhDArrays& tree) { return tree.halves; }
  // Behind the header.
  struct Place {
    BoxD bounds;
    Double3 centre;
    std::int64_t power;
  };
  static_assert(sizeof(Place) == 80, "no padding");
  static Place place(const BvhDArrays& tree) {
    return {tree.mesh_bounds, tree.frame.centre, tree.frame.power};
  }
  static std::size_t place_bytes() { return sizeof(Place); }
  static void put(const Place& place, BvhDArrays& tree) {
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
  static void finish(BvhDArrays& tree) {
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

// --- Validation.
constexpr float infinity = std::numeric_limits<float>::infinity();

// `blocks` are its leaves, whose corners have numbers of type T.
template <class T>
class Check {
 public:
  Check(const NodesOfMesh& tree, const void* blocks, std::size_t block_count)
      : tree_(tree), blocks_(blocks), depths_(tree.nodes.size(), 0), is_leaf_(block_count, false) {
    // Not by a count that the file alone claims.
    const std::size_t lanes = block_bytes / (10 * sizeof(T)) * block_count;
    is_in_leaf_.resize(std::min(tree.mesh_triangles, lanes + tree.left_out.size()));
  }

  void run() {
    check_root();
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) check_node(i);
    const auto unused = std::find(is_leaf_.begin(), is_leaf_.end(), false);
    if (unused != is_leaf_.end())
      refuse("block", static_cast<std::size_t>(unused - is_leaf_.begin()), "is no leaf");
    check_left_out();
    check_triangles();
  }

 private:
  void check_root() {
    const bool is_empty = tree_.root == empty_reference, is_leaf = !is_empty && refers_to_leaf(tree_.root);
    if (is_empty ? !tree_.nodes.empty() : is_leaf != tree_.nodes.empty() || (!is_leaf && tree_.root != 0))
      refuse("root", tree_.root, "is not the first node");
    if (is_leaf) check_leaf(tree_.root);
    if (!is_leaf && !is_empty) depths_[0] = 1;
    validate_bounds(tree_.bounds, is_empty || tree_.bounds.lo == empty_box.lo);
    if (!(tree_.built_cost >= 0 && std::isfinite(tree_.built_cost))) refuse("cost", 0, "is none");
  }

  void check_node(std::size_t index) {
    const WideNode& node = tree_.nodes[index];
    if (depths_[index] == 0) refuse("node", index, "has no parent before it");
    if (depths_[index] > max_tree_depth) refuse("node", index, "is too deep");
    const bool has_children = std::any_of(std::begin(node.child), std::end(node.child),
                                          [](TreeReference child) { return child != empty_reference; });
    if (!has_children || node.occupied >> tree_width != 0) refuse("node", index, "has impossible children");
    if (std::any_of(std::begin(node.unused), std::end(node.unused), [](std::uint32_t x) { return x != 0; }))
      refuse("node", index, "has something behind it");
    for (std::size_t slot = 0; slot < tree_width; ++slot) {
      const bool is_occupied = (node.occupied >> slot & 1u) != 0;
      check_box(index, slot, is_occupied);
      if (is_occupied || node.child[slot] != empty_reference) check_child(index, node.child[slot]);
    }
  }

  void check_box(std::size_t index, std::size_t slot, bool is_occupied) const {
    const WideNode& node = tree_.nodes[index];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float lo = node.lo[axis][slot], hi = node.hi[axis][slot];
      if (!(is_occupied ? is_box(lo, hi) : lo == infinity && hi == -infinity))
        refuse("node", index, "has a box that is none");
    }
  }

  void check_child(std::size_t parent, TreeReference child) {
    if (refers_to_leaf(child)) return check_leaf(child);
    if (child <= parent || child >= tree_.nodes.size()) refuse("node", parent, "has a child out of range");
    if (depths_[child] != 0) refuse("node", child, "has two parents");
    depths_[child] = depths_[parent] + 1;
  }

  void check_leaf(TreeReference reference) {
    const auto [index, size] = leaf_of(reference);
    const std::size_t end = index + blocks_of_leaf<T>(size);
    if (end > is_leaf_.size()) refuse("block", end - 1, "does not exist");
    for (std::size_t block = index; block < end; ++block) {
      if (is_leaf_[block]) refuse("block", block, "is two leaves");
      is_leaf_[block] = true;
    }
    validate_leaf<T>(blocks_, index, size, tree_.mesh_triangles,
                     [this](std::uint32_t primitive) { put_in_leaf(primitive); });
  }

  void put_in_leaf(std::uint32_t primitive) {
    if (primitive >= is_in_leaf_.size() || is_in_leaf_[primitive]) return;
    is_in_leaf_[primitive] = true;
    ++triangles_;
  }

  void check_left_out() const {
    for (std::size_t i = 0; i < tree_.left_out.size(); ++i)
      if (tree_.left_out[i] >= tree_.mesh_triangles || (i > 0 && tree_.left_out[i] <= tree_.left_out[i - 1]))
        refuse("left-out triangle", i, "is out of range or order");
  }
  // Each triangle of the mesh is in leaves or left out. So the file is as large as its mesh.
  void check_triangles() const {
    if (triangles_ + tree_.left_out.size() != tree_.mesh_triangles)
      refuse("number of triangles", tree_.mesh_triangles, "is not that of leaves and left-out ones");
    for (const std::uint32_t triangle : tree_.left_out)
      if (is_in_leaf_[triangle]) refuse("left-out triangle", triangle, "is in a leaf");
  }

  const NodesOfMesh& tree_;
  const void* blocks_;
  std::vector<int> depths_;       // of nodes; 0: no parent so far
  std::vector<bool> is_leaf_;     // of blocks
  std::vector<bool> is_in_leaf_;  // of triangles, as many as there can be
  std::size_t triangles_ = 0;     // in leaves
};

// Throws std::runtime_error, which names the first offender, unless
//   each node but the first is the child of one node before it, no deeper than max_tree_depth, and has children itself;
//   each block, or half, belongs to the leaf of one node, or alone to the root; a lane in use has finite corners and a
//   triangle of the mesh, another one NaN and no_primitive;
//   boxes are finite, lo <= hi, others are as WideNode says; the bounds are such a box, or that of nothing;
//   triangles that are left out rise, and are triangles of the mesh.
// Whether boxes hold what is below them is not looked at: where they do not hits are missed, and no more.
void validate_tree(const BvhArrays& tree) {
  Check<float>(tree, tree.corners.blocks(), tree.corners.count()).run();
}

void validate_tree(const BvhDArrays& tree) {
  Check<double>(tree, tree.halves.data(), tree.halves.size()).run();
  validate_bounds(tree.mesh_bounds, tree.live_root() == empty_reference);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!std::isfinite(tree.frame.centre[axis]))
      refuse("frame along axis", axis, "has a centre that is none");
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
  const QuietFloats quiet;
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

template void save_tree(const BvhArrays& tree, std::ostream& file);
template void save_tree(const BvhDArrays& tree, std::ostream& file);
template BvhArrays load_tree(std::istream& file);
template BvhDArrays load_tree(std::istream& file);

void Bvh::save(std::ostream& file) const {
  const BvhArrays empty;
  save_tree(tree_ ? *tree_ : empty, file);
}

Bvh Bvh::load(std::istream& file) {
  return Bvh(std::make_unique<BvhArrays>(load_tree<BvhArrays>(file)));
}

void BvhD::save(std::ostream& file) const {
  const BvhDArrays empty{};
  save_tree(tree_ ? *tree_ : empty, file);
}

BvhD BvhD::load(std::istream& file) {
  return BvhD(std::make_unique<BvhDArrays>(load_tree<BvhDArrays>(file)));
}

}  // namespace raylanes
