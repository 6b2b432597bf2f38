"""Mutations of the exact test in leaves of streams: the filter in floats, and the winners' numbers in doubles."""
from mutant import Mutant as M

X = 'test_exact'
FILTER, NUMBERS = 'kernels/exact/leaf_filter.hpp', 'kernels/exact/exact_numbers.hpp'

MUTANTS = [
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
