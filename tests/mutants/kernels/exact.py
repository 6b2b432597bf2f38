"""Mutations of the exact test in leaves of streams: the filter in floats, and the winners' numbers in doubles."""
from mutant import Mutant as M

X = 'test_exact'
FILTER, NUMBERS = 'kernels/exact/leaf_filter.hpp', 'kernels/exact/exact_numbers.hpp'

ALONG, NODES = 'kernels/exact/along_axes.hpp', 'kernels/traverse/node_test.hpp'
SINGLE = 'kernels/traverse/single.hpp'

MUTANTS = [
    M('along axes: zeros of other edges', ALONG, '{0, 0, 0, 4, 0, 2, 1, 7}', '{0, 0, 0, 1, 0, 2, 4, 7}', X),
    M('along axes: zeros of other corners', ALONG, '{0, 6, 5, 7, 3, 7, 7, 7}', '{0, 3, 5, 7, 6, 7, 7, 7}', X),
    M('along axes: any direction', ALONG, 'if (in_order(direction[k]) != 0) continue;', '', X),
    M('along axes: one corner above is enough', ALONG, 'above == 7u ||', 'above != 0u ||', X),
    M('along axes: order of bits', ALONG, 'return bits < 0 ? -size : size;', 'return bits;', X),
    M('along axes: a difference that doubles round', ALONG, 'is_kept(corner) && lost == 0.0', 'is_kept(corner)', X),
    M('along axes: subnormal corners', ALONG, '(bits & exponent) != 0 || (bits & magnitude) == 0', 'true', X),
    M('along axes: corners that others meet', ALONG, '{-1, -1, -1, 2, -1, 1, 0, -1}',
      '{-1, -1, -1, 0, -1, 1, 2, -1}', X),
    M('along axes: equal t of later triangles', 'kernels/exact/deferred_hits.hpp',
      '(t == nearest.tmax && triangles.primitive(leaf_triangle) >\n',
      '(t == nearest.tmax && triangles.primitive(leaf_triangle) <\n', X),
    M('along axes: boxes that hold the origin go', NODES, 'holds && node.lo[axis][child] <= origin_[axis]', 'false', X),
    M('along axes: rays of lists never go alone', 'kernels/query/hit_lists.hpp',
      'if (has_zero(ray.direction)) [[unlikely]]', 'if (false) [[unlikely]]', X),
    M('along axes: lists stay together', 'kernels/query/list_streams.hpp',
      '  if (heap.misses_left == 0) {\n', '  if (false) {\n', X),
    M('nodes: flushed numbers of rays that begin before their origin', NODES, 'of_entry + more + min_pad',
      'of_entry + more', X),
    M('along axes: the search ends', SINGLE, '      walk_beside<Test>(tree, ray, query, counters);\n}',
      '      counters.leaf();\n}', X, path='scalar'),
    M('beside rays: boxes that are not flat', NODES, 'in_order(node.lo[axis][child]) ==',
      'in_order(node.lo[axis][child]) <=', X),
    M('beside rays: any direction', NODES, 'if (is_zero_[axis] && in_order', 'if (in_order', X),
    M('streams: a ray beside triangles goes on', 'kernels/traverse/stream_leaves.hpp',
      'best = query, best.tmax = ended;', 'best.tmax = ended;', X),
    M('filter: sure though bounds overlap', FILTER, '(t_hi < range.accept_below());',
      '(t_lo < range.accept_below());', X),
    M('filter: what may be behind is open', FILTER, '(t_lo > range.tmax) | (t_hi < range.tmin);',
      '(t_hi > range.tmax) | (t_hi < range.tmin);', X),
    M('filter: far weights without a bound', FILTER, 'V(far_factor * unit)', 'V(0.0f)', X),
    M('filter: near weights without a bound', FILTER, 'V(31.0f * unit)', 'V(0.0f)', X),
    M('filter: far volumes without a bound', FILTER, 'V(10.3f * unit)', 'V(0.0f)', X),
    M('filter: products of normals without a bound', FILTER, 'V(4.3f * unit)', 'V(0.0f)', X),
    # Without 4.4 |n| the other bounds of volumes have room for all that is tried: crosses.gappa alone notices.
    M('filter: near volumes without a bound', FILTER, '+ of_normal);', '+ V(0.0f) * of_normal);', X),
    # Survive, not shown to be equivalent: bounds of weights or volumes ten times too large, within the fence of open
    # lanes; no guard of leaves whose products overflow, where NaN may leave lanes open as well.
    M('numbers: far weights without a bound', NUMBERS, 'V(3.1)', 'V(0.0)', X),
    # Survive, not shown to be equivalent: near weights (15.0), t near (5.4) and far (10.4), and the quotient's rounding
    # (2^-51) without a bound, each beside others that have room for all that is tried.
    M('numbers: any length of a direction', NUMBERS, 'length > V(0x1p-64)', 'length > V(-1.0)', X),
]
