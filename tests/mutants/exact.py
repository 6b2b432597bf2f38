"""Mutations of the exact test in leaves of streams: the filter in floats, and the winners' numbers in doubles."""
from mutant import Mutant as M

X = 'test_exact'
FILTER, NUMBERS = 'kernels/exact/leaf_filter.hpp', 'kernels/triangle/exact_numbers.hpp'

MUTANTS = [
    M('filter: sure though bounds overlap', FILTER, '(behind < range.surely_of_use());',
      '(before < range.surely_of_use());', X),
    M('filter: what may be behind is open', FILTER, '(before > range.tmax) | (behind < range.tmin);',
      '(behind > range.tmax) | (behind < range.tmin);', X),
    M('filter: far weights without a bound', FILTER, 'V(far_factor * unit)', 'V(0.0f)', X),
    M('filter: near weights without a bound', FILTER, 'V(31.0f * unit)', 'V(0.0f)', X),
    M('filter: far volumes without a bound', FILTER, 'V(10.3f * unit)', 'V(0.0f)', X),
    M('filter: products of normals without a bound', FILTER, 'V(4.3f * unit)', 'V(0.0f)', X),
    M('filter: sums of normals without a bound', FILTER, 'V(4.4f * unit)', 'V(0.0f)', X),
    M('filter: near volumes without a bound', FILTER, '+ of_normal);', '+ V(0.0f) * of_normal);', X),
    M('filter: a bound of weights by norms ten times too large', FILTER, 'V(far_factor * unit)',
      'V(10 * far_factor * unit)', X),
    M('filter: a bound of volumes ten times too large', FILTER, 'V(10.3f * unit)', 'V(103.0f * unit)', X),
    M('filter: lanes that overflow are sure', FILTER, '(square < V(0x1p80f)) & (square * V(farthest) < V(0x1p118f))',
      '(square < V(0x1p127f))', X),
    M('numbers: far weights without a bound', NUMBERS, 'V(3.1)', 'V(0.0)', X),
    M('numbers: near weights without a bound', NUMBERS, 'V(15.0) * size', 'V(0.0) * size', X),
    M('numbers: t near without a bound', NUMBERS, 'V(5.4) * size', 'V(0.0) * size', X),
    M('numbers: t far without a bound', NUMBERS, 'V(10.4) * reach', 'V(0.0) * reach', X),
    M('numbers: weights without a quotient', NUMBERS, 'share, V(0x1p-51)', 'share, V(0.0)', X),
    M('numbers: any length of a direction', NUMBERS, 'length > V(0x1p-64)', 'length > V(-1.0)', X),
]
