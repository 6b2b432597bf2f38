"""Mutations of the builders of trees, of the clipper and of what lays trees out."""
from mutant import Mutant as M

TESTS, TREES = 'test_builders', 'test_trees'
MEDIAN = 'accel/builders/median.cpp'
EQUAL = 'accel/builders/equal_partition.cpp'
SWEEP = 'accel/builders/sah/sweep_sah.cpp'
BINNED, SPATIAL = 'accel/builders/sah/binned_sah.cpp', 'accel/builders/sah/spatial_splits.cpp'
MORTON = 'accel/builders/morton.cpp'
BINS = 'accel/builders/sah/object_bins.hpp'
IN_PLACE = 'accel/builders/in_place.hpp'
TOP_DOWN = 'accel/builders/top_down.hpp'
LEVELS, KEPT = 'accel/builders/level_order.hpp', 'accel/batch/meters.hpp'
LINKED, REINSERT = 'accel/builders/linked_tree.cpp', 'accel/builders/reinsertion.cpp'
CLIPPER, MESH = 'accel/builders/sah/triangle_clipper.cpp', 'accel/trees/bvh_build.cpp'
REFERENCES, MESH_BUILD = 'accel/builders/mesh_references.hpp', 'accel/builders/mesh_build.hpp'
CHOOSE = 'accel/builders/mesh_build.cpp'
CHOICE = 'accel/builders/choice.cpp'
ORDER, LEAVES = 'accel/layout/occlusion_order.hpp', 'accel/layout/leaves.cpp'
WIDE, PLAN, REPORT = 'accel/layout/collapse_nodes.cpp', 'accel/layout/slot_plan.cpp', 'accel/layout/tree_report.cpp'

MUTANTS = [
    M('choice: many rays build quickly', CHOICE, 'each < few_rays', 'each >= few_rays', TESTS),
    M('choice: needles as others', CHOICE, 'waste > much_waste', 'waste < 0', TESTS),
    M('choice: areas of whole vectors', CHOICE, 'x * x + y * y + z * z', 'x * x + y * y', TESTS),
    M('choice: not taken', CHOOSE, 'options.builder = choice.builder, ', '', TESTS),
    M('median: at a quarter', MEDIAN, 'list.begin() + part.count / 2', 'list.begin() + part.count / 4', TESTS),
    M('median: along any axis', MEDIAN, 'longest_axis(part.box)', '2', TESTS),
    M('equal partition: at the end', EQUAL, 'centre(part.box)[axis]', 'part.box.lo[axis]', TESTS),
    M('equal partition: never ends', EQUAL, 'depth >= last_split_depth || ', '', TESTS),
    M('bins: the last bin is forgotten', BINS, 'i < binning_.bins(); ++i)\n      extend(i < bin',
      'i + 1 < binning_.bins(); ++i)\n      extend(i < bin', TESTS, '', BINNED),
    M('binned: never ends', BINNED, 'depth >= last_split_depth || ', '', TESTS),
    M('sweep: left sides count once', SWEEP, 'cost_of_side(box, i) +', 'cost_of_side(box, 1) +', TESTS),
    M('sweep: one axis', SWEEP, 'axis < 3; ++axis) sweep', 'axis < 1; ++axis) sweep', TESTS),
    M('spatial: upper parts dropped', SPATIAL, 'if (!is_empty(halves.above)) above', 'if (false) above', TESTS),
    M('spatial: nothing is cut', SPATIAL, 'cut.cost < border.cost && has_room', 'false && has_room', TESTS),
    M('spatial: no room between parts', SPATIAL, 'right.begin = part.begin + left.capacity;',
      'right.begin = part.begin + left.count;', TESTS),
    M('morton: boxes of first references', MORTON, 'extend(box, reference.box);',
      'if (i == begin) box = reference.box;', TESTS),
    M('morton: buckets are not sorted', MORTON, 'ends[bucket] - begin)', 'begin - begin)', TESTS),
    M('morton: buckets overlap', MORTON, 'buckets + bucket], end);', 'buckets + bucket], end) / 2;', TESTS),
    M('morton: bits of the last part alone', MORTON, 'any_bits_ |= all, common_bits_ &= common;',
      'any_bits_ = all, common_bits_ = common;', TESTS),
    M('kept: copies over each other', KEPT, 'used_ += lines;', 'used_ += lines - 1;', TESTS, '', BINNED),
    M('kept: blocks without end', KEPT, 'blocks_.back().size() - used_ < lines', 'false', TESTS, '', BINNED),
    M('top down: children one too far', TOP_DOWN, 'node.left += first - 1;', 'node.left += first;', TESTS, '', BINNED),
    M('top down: progress of each subtree is negative', LEVELS, 'progress.advance((1.0 - share_of_large) *',
      'progress.advance(-0.1 *', TESTS, '', BINNED),
    M('clipper: crossings not pushed out', CLIPPER, '0x1p-23 * std::fabs(x)', '0.0 * std::fabs(x)', TESTS),
    M('clipper: corners on the plane in one half', CLIPPER, 'if (a[axis] >= at)', 'if (a[axis] > at)', TESTS),
    M('clipper: beyond the given box', CLIPPER, 'below = common(below, box), above', 'above', TESTS),
    M('mesh: gaps where triangles are left out', REFERENCES, 'if (size != block * grain)', 'if (false)', TESTS,
      source='accel/builders/mesh_references.cpp'),
    M('mesh: any builder', CHOOSE, 'builder.build({', 'build_binned_sah({', TESTS),
    M('mesh: any number of threads', MESH_BUILD, 'require_threads(name, options.threads);', '', TREES, '', MESH),
    M('optimize: primitives of another leaf', LINKED, 'original_.order.begin() + node.begin', 'original_.order.begin()',
      TESTS),
    M('optimize: boxes left as they were', LINKED, 'refit_up_from(above);', '', TESTS),
    M('optimize: what becomes smaller is a loss', REINSERT, 'gain += finite_half_area(tree_[above].box) -',
      'gain -= finite_half_area(tree_[above].box) -', TESTS),
    M('optimize: the first places alone', REINSERT, 'if (target.is_leaf()) continue;', 'continue;', TESTS),
    M('optimize: the smallest boxes', REINSERT, 'return a.area > b.area ||', 'return a.area < b.area ||', TESTS),
    M('optimize: subtrees one node short', LINKED, 'tree_.subtrees.push_back({at.to, begin, end})',
      'tree_.subtrees.push_back({at.to, begin, end - 1})', TESTS),
    M('optimize: never asked for', CHOOSE, 'if (options.optimize) {', 'if (false) {', TESTS),
    M('wide: seams to the wrong piece', WIDE, '>(node_base[i + 1]);', '>(node_base[i]);', TESTS),
    M('wide: leaves of the first piece', WIDE, '? leaf_base : node_base', '? 0 : node_base', TESTS),
    M('plan: leaves of nine', PLAN, 'node.count > tree_width ||', 'node.count > tree_width + 1 ||', TESTS),
    M('plan: five slots for the left child as six', PLAN, 'left.many[0] + shifted<1>', 'left.many[1] + shifted<1>',
      TESTS),
    M('plan: right costs of one slot too many', PLAN, 'take_less(left.few[3] + right.few,',
      'take_less(left.few[3] + shifted<1>(none, right.few),', TESTS),
    M('plan: ties go to the last', PLAN, 'best_for_left = cost < best ?', 'best_for_left = cost <= best ?', TESTS),
    M('report: overlap of each child with itself', REPORT, 'b < a; ++b', 'b <= a; ++b', TESTS),
    M('report: references of a leaf count once', REPORT, 'report_.references += leaf_of(reference).size',
      'report_.references += 1', TESTS),
    M('order: what hides least comes first', ORDER, 'child.rank > children[to - 1].rank',
      'child.rank < children[to - 1].rank', TESTS, '', WIDE),
    M('order: boxes stay where they were', ORDER, 'sorted.lo[axis][to] = node.lo[axis][from]',
      'sorted.lo[axis][to] = node.lo[axis][to]', TESTS, '', WIDE),
    M('order: one triangle a leaf', LEAVES, 'area += area_of(corners);', 'area = area_of(corners);', TESTS),
    M('order: as if leaves were not to be met', ORDER, '0.5f * depth_of(of.triangles)', '0.0f', TESTS, '', WIDE),
    M('order: the first piece alone', WIDE, 'i = begin + 1; i < end + 1; ++i)', 'i = begin + 1; i < end; ++i)', TESTS),
    M('mesh: what is left out forgotten', MESH, 'tree.left_out = std::move(left_out);', '', TESTS),
]
