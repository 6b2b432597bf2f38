#include "cell_file.hpp"

#include "../layout/collapse_cells.hpp"
#include "tree_stream.hpp"

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

Header header_of(const CellTree& tree) {
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

}  // namespace

void save_cells(const CellTree& tree, std::ostream& file) {
  const Header header = header_of(tree);
  const FilePart parts[] = {{&header, sizeof header},
                            {tree.nodes.data(), tree.nodes.size() * sizeof(KdNode)},
                            {tree.corners.blocks(), tree.corners.bytes()}};
  write_tree(file, FileKind::kd_tree, format_version, parts);
}

CellTree load_cells(std::istream& file) {
  TreeReader reader(file, FileKind::kd_tree, format_version);
  Header header;
  reader.read(&header, sizeof header);
  CellTree tree;
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

}  // namespace raylanes
