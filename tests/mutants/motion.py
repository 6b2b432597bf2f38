"""Mutations of what follows meshes in motion, and of trees in files."""
from mutant import Mutant as M

TESTS, TREES = 'test_bvh', 'test_trees'
REFIT, DOOR, LEAVES = 'accel/layout/refit.cpp', 'accel/bvh_refit.cpp', 'accel/layout/leaves.cpp'
NODES = 'accel/layout/refit.hpp'
FILE, VALID, COST = 'accel/file/tree_file.cpp', 'accel/file/valid_tree.cpp', 'accel/layout/cost.cpp'
STREAM, PARTS = 'accel/file/tree_stream.cpp', 'accel/file/valid_parts.cpp'

MUTANTS = [
    M('refit: nodes before their children', NODES, 'if (at.inner == 0) {', 'if (at.inner == 0 || depth > 1) {', TESTS,
      '', REFIT),
    M('refit: the first child forgotten', NODES, 'return inner & node.occupied;', 'return inner & node.occupied & ~1u;',
      TESTS, '', REFIT),
    M('refit: inner boxes stay', NODES, ': box_of(node.child[slot]);', ': empty_box;', TESTS, '', REFIT),
    M('refit: upper nodes forgotten', NODES, 'i = upper.begin; i-- > 0;', 'i = 0; i-- > 0;', TESTS, '', REFIT),
    M('refit: upper nodes from the root down', NODES, 'update(upper.nodes[i]);',
      'update(upper.nodes[upper.begin - 1 - i]);', TESTS, '', REFIT),
    M('refit: the last subtree forgotten', NODES, 'subtrees.subspan(begin, end - begin)',
      'subtrees.subspan(begin, end - begin - (end == subtrees.size()))', TESTS, '', REFIT),
    M('refit: numbers of the test stay', REFIT, 'if (prepares != nullptr)', 'if (false)', TESTS),
    M('refit: a leaf written before the path is there', REFIT, 'const TriangleRow* const prepares =',
      'if (tree.corners.count() > 0) tree.corners.refill(0, 1, vertices, triangles);\n  '
      'const TriangleRow* const prepares =', TESTS),
    M('refit: bounds stay', NODES, 'tree_.bounds = box_of(tree_.root);', '', TESTS, '', REFIT),
    M('refit: bounds of a leaf stay', NODES, 'tree_.bounds = refill_(tree_.root);', 'refill_(tree_.root);', TESTS, '',
      REFIT),
    M('refit: what comes to life stays out', DOOR, 'tree_ && comes_back(', 'false && comes_back(', TESTS),
    M('refit: copies without the numbers of the test', 'accel/layout/leaves.hpp',
      'prepared_for(other.prepared_for), prepared(other.prepared) {}', 'prepared_for(other.prepared_for) {}', TESTS,
      source=DOOR),
    M('refit: any number of triangles', DOOR, 'if (triangles != of_tree)', 'if (triangles < of_tree)', TESTS),
    M('refit: invalid meshes', DOOR, 'validate_mesh(vertices, triangles);', '', TESTS),
    M('leaves: refilled lanes alike', LEAVES, 'names[std::min(first + lane, count - 1)]', 'names[first]', TESTS),
    M('leaves: unused lanes get triangles', LEAVES, '(row | unused)', 'row', TESTS),
    M('leaves: y and z swapped', LEAVES, 'point + 2 * sizeof(float)', 'point + sizeof(float)', TESTS),
    M('cost: leaves free', COST, 'sum += cost_of(child) *',
      'sum += (refers_to_leaf(child) ? 0 : 1) *', TESTS),
    M('cost: the root free', COST, 'cost_of(tree.root) + sum / whole', 'sum / whole', TESTS),
    M('file: checksum unread', STREAM, 'if (checksum_->value() != expected_)', 'if (false)', TREES),
    M('file: what is read is not checked', STREAM, 'checksum_->add(to, size);', '', TREES),
    M('file: left-out triangles lost', FILE, 'reader.read_array(header.left_out, tree.left_out);',
      'std::vector<std::uint32_t> lost; reader.read_array(header.left_out, lost);', TESTS),
    M('file: test lost', FILE, 'tree.prepare(tree.built_with.test)',
      'tree.prepare(TriangleTest::exact)', TREES),
    M('file: builder lost', FILE,
      'tree.built_with.builder = static_cast<TreeBuilder>(header.builder & ~optimized_bit);', '', TREES),
    M('refit: builds as by default', DOOR, 'BuildOptions options = tree_->built_with;', 'BuildOptions options;', TESTS),
    M('file: short reads', STREAM, 'if (static_cast<std::size_t>(file_.gcount()) != size)', 'if (false)', TREES),
    M('file: any version', STREAM, 'if (start.version != version)', 'if (false)', TREES),
    M('file: not validated', FILE, 'validate_tree(tree);', '', TESTS),
    M('valid: cycles', VALID, 'child <= parent || child >=', 'child >=', TESTS),
    M('valid: nodes out of range', VALID, 'child >= tree_.nodes.size())', 'child > tree_.nodes.size())', TESTS),
    M('valid: two parents', VALID, 'if (depths_[child] != 0)', 'if (false)', TESTS),
    M('valid: too deep', VALID, 'depths_[index] > max_tree_depth)', 'depths_[index] > max_tree_depth + 1)', TESTS),
    M('valid: not as deep as allowed', VALID, 'depths_[index] > max_tree_depth)', 'depths_[index] >= max_tree_depth)',
      TESTS),
    M('valid: blocks out of range', VALID, 'if (index >= is_leaf_.size())', 'if (index > leaf_block_mask)', TESTS),
    M('valid: triangles out of range', PARTS, 'block.primitive[lane] >= mesh_triangles',
      'block.primitive[lane] > mesh_triangles', TESTS),
    M('valid: boxes with NaN', PARTS, 'return std::isfinite(lo) && std::isfinite(hi) && lo <= hi;',
      'return !(lo > hi) && !std::isinf(lo) && !std::isinf(hi);', TESTS),
    M('valid: blocks without a leaf', VALID, 'if (unused != is_leaf_.end())', 'if (false)', TESTS),
]
