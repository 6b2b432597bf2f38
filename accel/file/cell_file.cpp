// Files of KdTree.
#include <raylanes/kdtree.hpp>

#include "../../dispatch/quiet_floats.hpp"
#include "tree_file.hpp"

namespace raylanes {
namespace {

constexpr std::uint32_t format_version = 1;

struct Header {
  std::uint64_t nodes, blocks, mesh_triangles, triangles;
  Box bounds;
  std::uint32_t unused[3], older_test, builder, unused_too;
};
static_assert(sizeof(Header) == 80 && alignof(Header) == 8, "no padding");
// Stored in files: an enumerator keeps its value, new ones come last.
static_assert(kd_builder_names.size() == 2 && static_cast<int>(KdBuilder::midpoint) == 0 &&
              static_cast<int>(KdBuilder::sah) == 1);

Header header_of(const KdTreeArrays& tree) {
  Header header{};
  header.nodes = tree.nodes.size(), header.blocks = tree.corners.count();
  header.mesh_triangles = tree.mesh_triangles, header.triangles = tree.build_report.triangles;
  header.bounds = tree.bounds;
  header.builder = static_cast<std::uint32_t>(tree.built_with.builder);
  return header;
}

// Numbers that no tree has, before they are multiplied or cast.
void require_possible(const Header& header) {
  if (header.nodes > max_kd_nodes || header.blocks > leaf_block_mask ||
      header.mesh_triangles > max_mesh_triangles || header.triangles > header.mesh_triangles)
    refuse_file("its counts are impossible");
  require_older_test(header.older_test);
  if (header.builder >= kd_builder_names.size())
    refuse_file("builder " + std::to_string(header.builder) + " does not exist");
  if ((header.unused[0] | header.unused[1] | header.unused[2] | header.unused_too) != 0)
    refuse_file("it has something where its header is unused");
}

// --- Validation.
class Check {
 public:
  explicit Check(const KdTreeArrays& tree) : tree_(tree), depths_(tree.nodes.size(), -1) {}

  void run() {
    const bool is_empty = tree_.nodes.empty();
    validate_bounds(tree_.bounds, is_empty);
    if (!is_empty) depths_[0] = 0;
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      if (depths_[i] < 0) refuse("node", i, "has no parent before it");
      tree_.nodes[i].is_leaf() ? check_leaf(i) : check_inner(i);
    }
    if (next_block_ != tree_.corners.count()) refuse("block", next_block_, "is no leaf's");
    if (tree_.corners.places().size() != tree_.build_report.triangles)
      refuse("number of triangles", tree_.build_report.triangles, "is not that of the leaves");
  }

 private:
  void check_inner(std::size_t index) {
    const KdNode& node = tree_.nodes[index];
    if (depths_[index] >= max_kd_depth) refuse("node", index, "is too deep");
    if (!std::isfinite(node.plane())) refuse("node", index, "has a plane that is none");
    const std::size_t first = node.first(), children = node.keeps_triangles() ? 3 : 2;
    if (first <= index || first + children > tree_.nodes.size())
      refuse("node", index, "has a child out of range");
    for (std::size_t child = first; child < first + children; ++child) {
      if (depths_[child] >= 0) refuse("node", child, "has two parents");
      depths_[child] = depths_[index] + 1;
    }
    if (node.keeps_triangles() && (!tree_.nodes[first + 2].is_leaf() || tree_.nodes[first + 2].count() == 0))
      refuse("node", index, "keeps what is no leaf");
  }

  void check_leaf(std::size_t index) {
    const KdNode& leaf = tree_.nodes[index];
    if (leaf.keeps_triangles() || leaf.first() != next_block_)
      refuse("node", index, "has not the blocks behind those of leaves before it");
    for (std::size_t left = leaf.count(); left > 0; ++next_block_) {
      if (next_block_ >= tree_.corners.count()) refuse("block", next_block_, "does not exist");
      const std::size_t size = std::min<std::size_t>(left, tree_width);
      validate_leaf<float>(tree_.corners.blocks(), next_block_, size, tree_.mesh_triangles,
                           [](std::uint32_t) {});
      left -= size;
    }
  }

  const KdTreeArrays& tree_;
  std::vector<int> depths_;  // of nodes, in planes above; −1: no parent so far
  std::size_t next_block_ = 0;
};

// Throws std::runtime_error, which names the first offender, unless
//   each node but the first is the child of one node before it, with no more than max_kd_depth of these above it;
//   planes are finite, and what a node keeps is a leaf with triangles;
//   the leaves with triangles have all blocks, one after the other; a lane in use has finite corners and a triangle of
//   the mesh, another one NaN and no_primitive;
//   the bounds are finite, lo <= hi.
// Whether triangles are in their cells is not looked at: where they are not hits are missed, and no more.
void validate_cells(const KdTreeArrays& tree) {
  Check(tree).run();
}

}  // namespace

void save_cells(const KdTreeArrays& tree, std::ostream& file) {
  const Header header = header_of(tree);
  const FilePart parts[] = {{&header, sizeof header},
                            {tree.nodes.data(), tree.nodes.size() * sizeof(KdNode)},
                            {tree.corners.blocks(), tree.corners.bytes()}};
  write_tree(file, FileKind::kd_tree, format_version, parts);
}

KdTreeArrays load_cells(std::istream& file) {
  const QuietFloats quiet;
  TreeReader reader(file, FileKind::kd_tree, format_version);
  Header header;
  reader.read(&header, sizeof header);
  KdTreeArrays tree;
  require_possible(header);
  reader.read_array(header.nodes, tree.nodes);
  reader.read_array(header.blocks, tree.corners);
  reader.require_checksum();
  tree.bounds = header.bounds;
  tree.mesh_triangles = static_cast<std::size_t>(header.mesh_triangles);
  tree.build_report.triangles = static_cast<std::size_t>(header.triangles);
  tree.built_with.builder = static_cast<KdBuilder>(header.builder);
  validate_cells(tree);
  collapse_cells(tree);
  return tree;
}

void KdTree::save(std::ostream& file) const {
  const KdTreeArrays empty;
  save_cells(tree_ ? *tree_ : empty, file);
}

KdTree KdTree::load(std::istream& file) {
  return KdTree(std::make_unique<KdTreeArrays>(load_cells(file)));
}

}  // namespace raylanes
