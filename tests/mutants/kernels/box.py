"""Mutations of the box tests, and of what all array kernels share."""
from mutant import Mutant as M

TESTS = 'test_boxes'
SLABS = 'kernels/box/slabs.hpp'
DIRECTIONAL = 'kernels/box/directional.hpp'
BOXES = 'kernels/box/box_kernels.cpp'
DERIVED = 'kernels/simd/derived.hpp'
RAYS = 'kernels/ray/ray_columns.hpp'
VALID = 'kernels/ray/valid_ray.hpp'
SLICES = 'kernels/simd/slices.hpp'

MUTANTS = [
    M('box: near and far swapped on an axis', BOXES, 'far[j] = negative ? lo[j] : hi[j];', 'far[j] = hi[j];', TESTS),
    M('box: near and far swapped for rays', BOXES, 'select_negative(prepared.inverse[axis], lo[axis], hi[axis])',
      'hi[axis]', TESTS),
    M('box: an invalid single ray let through', RAYS, 'if (is_valid(ray)) return', 'return', TESTS),
    M('box: an invalid single ray let through, yes or no', BOXES,
      'if (!is_valid(ray)) return store_no_hits(n, active, out);', '', TESTS),
    M('box: invalid rays let through', BOXES, '& under.valid & loaded.are_valid()', '& under.valid', TESTS),
    M('box: invalid rays let through, intervals', BOXES, 'under.valid & loaded.are_valid(), slice',
      'under.valid, slice', TESTS),
    M('box: added by the multipliers', DERIVED, 'return fused(a, one, -b);', 'return fused(a, one, b);', TESTS),
    M('box: one is another number', DERIVED, 'float one = 1.0f;', 'float one = 1.0000001f;', TESTS),
    M('box: x twice', SLABS, 'inside.tmax = min(ray.far(axis, far_plane[axis]), inside.tmax);',
      'inside.tmax = min(ray.far(axis, far_plane[axis > 0 ? axis - 1 : 0]), inside.tmax);', TESTS),
    M('box: the far side not widened', SLABS, '1.0f + 3.0f * std::numeric_limits<float>::epsilon()', '1.0f', TESTS),
    M('box: the plain one widened', SLABS, 'is_widened = test == BoxTest::conservative', 'is_widened = true', TESTS),
    M('box: open where it grazes', BOXES, 'return (entry <= exit) & is_box;', 'return (entry < exit) & is_box;', TESTS),
    M('box: a NaN plane ignored on the last axis', BOXES, 'entry = max(entry, ray.near(2, near_plane[2]));',
      'entry = max(ray.near(2, near_plane[2]), entry);', TESTS),
    M('box: a NaN plane ignored on the first', BOXES, 'return (entry <= exit) & is_box;', 'return (entry <= exit);',
      TESTS),
    M('box: bound first in the maximum', SLABS, 'inside.tmin = max(ray.near(axis, near_plane[axis]), inside.tmin);',
      'inside.tmin = max(inside.tmin, ray.near(axis, near_plane[axis]));', TESTS),
    M('directional box: no padding', DIRECTIONAL, 'V(8 * 0x1p-24f) * abs(product)', 'V(0.0f) * abs(product)', TESTS),
    M('directional box: no slack', DIRECTIONAL, 'select(tiny, slack, zero)', 'zero', TESTS),
    M('directional box: no zero repair', DIRECTIONAL, 'select(tiny, repaired, direction[axis])', 'direction[axis]',
      TESTS),
    M('directional box: the sign of zero lost', DIRECTIONAL, 'flip(least, sign_of(direction[axis]))', 'least', TESTS),
    M('valid ray: an infinite origin', VALID, 'for (const V& x : origin) nothing = nothing * x;', '', TESTS),
    M('valid ray: an infinite direction', VALID, 'for (const V& x : direction) nothing = nothing * x;', '', TESTS),
    M('valid ray: no direction', VALID, '& ~(as<float>(any_bits) == zero)', '', TESTS),
    M('valid ray: no direction along z', VALID, '| as<std::uint32_t>(direction[2])', '', TESTS),
    M('rest: the last element left out', SLICES, '(1u << left) - 1u', '(1u << (left - 1)) - 1u', TESTS),
    M('rest: one element too many', SLICES, 'return bits & ((1u << left) - 1u);', 'return bits & ((2u << left) - 1u);',
      TESTS),
    M('rest: all lanes loaded', SLICES,
      'return Floats<W>::load(p + i, lanes, Floats<W>(std::numeric_limits<float>::quiet_NaN()));',
      'return Floats<W>::load(p + i);', TESTS),
    M('rest: all lanes stored', SLICES, 'x.store(p + i, lanes);', 'x.store(p + i);', TESTS),
    M('rest: bits behind the last cleared', SLICES, 'const std::uint32_t others = mine == 0xffu ? 0u : out[b] & ~mine;',
      'const std::uint32_t others = 0u;', TESTS),
    M('rest: the byte of another eight', SLICES, 'b < bytes; ++b, hits >>= 8, taken >>= 8',
      'b < bytes; ++b, taken >>= 8', TESTS, 'avx512'),
    M('mask: a byte off', SLICES, 'active[i / 8]) >>', 'active[i / 8 + 1]) >>', TESTS),
    M('mask: the second byte left out', SLICES, 'if (left > 8) bits |=', 'if (left > 80) bits |=', TESTS, 'avx512'),
    M('mask: lanes of the first register alone', SLICES, 'taken >> k & all_lanes', 'taken & all_lanes', TESTS, 'sse2'),
    M('mask: ignored', SLICES, 'if (active != nullptr) {', 'if (active != nullptr && end == 0) {', TESTS),
    M('mask: ignored where nothing is hit', BOXES, 'store_no_hits(n, active, out)', 'store_no_hits(n, nullptr, out)',
      TESTS),
]
