"""Mutations of the box tests."""
from mutant import Mutant as M

TESTS = 'test_box_forms'
BOX = 'kernels/box/box_forms.hpp'
BOX_LOOPS = 'kernels/box/box_loops.hpp'
DERIVED = 'kernels/simd/derived.hpp'
ORDER = 'kernels/ray/lane_order.hpp'
SUPPORT = 'kernels/ray/loop_support.hpp'

MUTANTS = [
    M('box: near and far swapped on an axis', BOX_LOOPS, 'far[j] = negative ? lo[j] : hi[j];', 'far[j] = hi[j];',
      TESTS),
    M('box: near and far swapped for rays', ORDER, 'select_negative(inverse[axis], lo[axis], hi[axis])', 'hi[axis]',
      TESTS),
    M('box: an improper single ray let through', SUPPORT, 'const bool proper = is_proper(ray);\n  return {Floats',
      'const bool proper = true;\n  return {Floats', TESTS),
    M('box: added by the multipliers', DERIVED, 'return fused(a, one, -b);', 'return fused(a, one, b);', TESTS),
    M('box: one is another number', DERIVED, 'float one = 1.0f;', 'float one = 1.0000001f;', TESTS),
    M('box: x twice', BOX, 'inside.exit = min(form.far(axis, far_plane[axis]), inside.exit);',
      'inside.exit = min(form.far(axis, far_plane[axis > 0 ? axis - 1 : 0]), inside.exit);', TESTS),
    M('box: the far side not widened', 'kernels/box/ray_box.hpp',
      '1.0f + 3.0f * std::numeric_limits<float>::epsilon()', '1.0f', TESTS),
    M('box: open where it grazes', BOX, 'return (entry <= exit) & proper;', 'return (entry < exit) & proper;', TESTS),
    M('box: a NaN plane ignored on the last axis', BOX, 'entry = max(entry, form.near(2, near_plane[2]));',
      'entry = max(form.near(2, near_plane[2]), entry);', TESTS),
    M('box: a NaN plane ignored on the first', BOX, 'return (entry <= exit) & proper;', 'return (entry <= exit);',
      TESTS),
    M('box: bound first in the maximum', BOX, 'inside.entry = max(form.near(axis, near_plane[axis]), inside.entry);',
      'inside.entry = max(inside.entry, form.near(axis, near_plane[axis]));', TESTS),
    M('directional box: no padding', BOX, 'Floats<W>(8 * 0x1p-24f) * abs(product)', 'Floats<W>(0.0f) * abs(product)',
      TESTS),
    M('directional box: no slack', BOX, 'select(tiny, slack, zero)', 'zero', TESTS),
    M('directional box: no zero repair', BOX, 'select(tiny, repaired, direction[axis])', 'direction[axis]', TESTS),
    M('directional box: the sign of zero lost', BOX, 'as<float>(as<std::uint32_t>(least) | sign)', 'least', TESTS),
]
