"""Mutations of k-d trees: their builders, their cells as nodes of eight, their walks and their files."""
from mutant import Mutant as M

TESTS, TREES = 'test_kdtree', 'test_trees'
GROWTH = 'accel/builders/kd/growth.hpp'
MIDPOINT = 'accel/builders/kd/midpoint.cpp'
SAH = 'accel/builders/kd/kd_sah.cpp'
COSTS = 'accel/builders/kd/plane_costs.hpp'
CELLS = 'accel/trees/kdtree_build.cpp'
EIGHTS = 'accel/layout/collapse_cells.cpp'
REPORT, FILE = 'accel/trees/kdtree_report.cpp', 'accel/file/cell_file.cpp'
SINGLE = 'kernels/kdtree/cell_walk.hpp'

MUTANTS = [
    M('single: best hit ends a cell that begins there', SINGLE, 'while (at.entry > query.tmax)',
      'while (at.entry >= query.tmax)', TESTS),
    M('single: a plane begins cells where it ends them', SINGLE, 'begin = prepared.nodes.near(axis, plane)',
      'begin = prepared.nodes.far(axis, plane)', TESTS),
    M('single: a plane ends cells where it begins them', SINGLE, 'end = prepared.nodes.far(axis, plane)',
      'end = prepared.nodes.near(axis, plane)', TESTS),
    M('single: rays in a plane go one way', SINGLE, '} else if (end < at.entry) {', '} else if (!(end >= at.entry)) {',
      TESTS),
    M('single: what a node keeps is left out', SINGLE, 'if (node.keeps_triangles()) [[unlikely]]', 'if (false)', TESTS),
    M('single: the far cell first', SINGLE, 'nodes.negative[axis] ? 1u : 0u', 'nodes.negative[axis] ? 0u : 1u',
      TESTS),
    M('single: the bounds of a positive ray', SINGLE, '(negative ? tree.bounds.hi : tree.bounds.lo)',
      '(tree.bounds.lo)', TESTS),
    M('single: the first block only', SINGLE, 'left > 0; ++block', 'left > 0; left = 0', TESTS),
    M('midpoint: what lies across goes above', MIDPOINT, 'to.keep(reference)', 'to.above(reference)', TESTS),
    M('midpoint: along any axis', MIDPOINT, 'longest_axis(cell.cell)', '2', TESTS),
    M('sah: upper parts dropped', SAH, 'if (!is_empty(halves.above)) to', 'if (false) to', TESTS),
    M('sah: what lies in a plane goes nowhere', SAH, '} else {\n      to.above(reference);',
      '} else if (reference.box.hi[plane.axis] > plane.at) {\n      to.above(reference);', TESTS),
    M('sah: whole boxes in both cells', SAH,
      'clipper_.cut(primitive, reference.box, plane.axis, plane.at)',
      'Clipper::Halves{reference.box, reference.box}', TESTS),
    M('sah: bins end too early', COSTS, 'above -= ends_[axis][i - 1]', 'above -= ends_[axis][i]', TESTS, '', SAH),
    M('sah: as deep as it likes', GROWTH, 'cell.depth < max_kd_depth && ', '', TESTS, '', MIDPOINT),
    M('growth: children of the first subtree', GROWTH, 'moved(below.nodes[k], nodes_at[i], order_at[i])',
      'moved(below.nodes[k], nodes_at[0], order_at[i])', TESTS, '', SAH),
    M('growth: blocks for everybody', COSTS, 'blocks_of(below) + blocks_of(above) <= blocks_', 'true', TESTS, '', SAH),
    M('layout: all leaves at the first block', CELLS, 'KdNode::leaf(static_cast<std::uint32_t>(ranges.size()),',
      'KdNode::leaf(0,', TESTS),
    M('wide nodes: boxes of first corners', EIGHTS, 'k < 9; k += 3', 'k < 3; k += 3', TESTS),
    M('wide nodes: half of a leaf', EIGHTS, 'add(KdNode::leaf(node.first() + half,',
      'if (false) add(KdNode::leaf(node.first() + half,', TESTS),
    M('wide nodes: what a node keeps is left out', EIGHTS, 'if (node.keeps_triangles()) add', 'if (false) add', TESTS),
    M('wide nodes: cells below are not measured', EIGHTS,
      '*std::max_element(below.hi[axis], below.hi[axis] + tree_width)',
      'below.hi[axis][0]', TESTS),
    M('report: kept leaves do not count', REPORT, 'if (node.keeps_triangles()) visit_leaf', 'if (false) visit_leaf',
      TESTS),
    M('file: two parents', FILE, 'if (depths_[child] >= 0) refuse', 'if (false) refuse', TESTS),
    M('file: any depth', FILE, 'if (depths_[index] >= max_kd_depth) refuse', 'if (false) refuse', TESTS),
    M('file: blocks of others', FILE, 'leaf.keeps_triangles() || leaf.first() != next_block_', 'false', TESTS),
    M('queries: planes in every mode', 'accel/queries/nearest.cpp',
      'kind == TreeKind::kdtree && options.mode == TraversalMode::single &&', 'kind == TreeKind::kdtree &&', TESTS),
    M('queries: planes for every test', 'accel/queries/nearest.cpp',
      'options.test == TriangleTest::exact && options.grade', 'options.grade', TESTS),
    M('queries: no planes', 'accel/queries/nearest.cpp', 'kind == TreeKind::kdtree && options',
      'false && options', TESTS),
    M('file: no nodes of eight', FILE, 'collapse_cells(tree);', '', TREES),
]
