"""Mutations of rays of doubles: frames, pairs of doubles, leaves in halves, lists, and what trees make of them."""
from mutant import Mutant as M

D = 'test_doubles'
FRAME, RAY, PAIRS = 'dispatch/frame.hpp', 'kernels/doubles/frame_ray.hpp', 'kernels/doubles/pairs.hpp'
NUMBERS, SEARCH = 'kernels/doubles/double_numbers.hpp', 'kernels/doubles/double_search.hpp'
ONE_HIT = 'kernels/doubles/hit_in_pairs.hpp'
RAYS, LISTS = 'kernels/doubles/double_rays.hpp', 'kernels/doubles/double_lists.hpp'
BUILD, CALLS = 'accel/doubles/build.cpp', 'accel/doubles/bvh_of_doubles.cpp'
PLACES, LINES = 'accel/doubles/lists_of_doubles.cpp', 'accel/queries/lines_of_points.hpp'
SOURCE = 'accel/batch/ray_source.hpp'

MUTANTS = [
    M('doubles: distant origins are not moved', RAY, 'skipped_ = by;', 'skipped_ = 0.0;', D),
    M('doubles: moved too far', RAY, '- 8.0 / length', '+ 8.0 / length', D),
    M('doubles: the end of the segment rounded down', RAY, 'rounded_up(t_in_frame(number_above(t)))',
      'rounded_down(t_in_frame(number_above(t)))', D),
    M('doubles: the end of usual rays rounded down', RAY, 'rounded_up(t * scale_)', 'rounded_down(t * scale_)', D),
    M('doubles: usual rays of any size', RAY, '(largest >= V(0x1p-400))', '(largest >= V(0.0))', D),
    M('doubles: usual rays from any distance', RAY, ' & (farthest <= V(reach_of_frame))', '', D),
    M('doubles: usual rays that begin before their origin', RAY, '!(world.tmin >= 0.0) || ', '', D),
    M('doubles: flushed components of the direction', RAY, 'return x < 0.0 ? -least : least;', 'return 0.0f;', D),
    M('doubles: subnormal numbers as they are', FRAME, 'power -= 1074;', 'power -= 1070;', D),
    M('doubles: a product without its rest', PAIRS, 'return {product, fused(a, b, -product)};',
      'return {product, V(0.0)};', D),
    M('doubles: a sum without its rest', PAIRS, 'return {sum, (a - (sum - of_b)) + (b - of_b)};',
      'return {sum, V(0.0)};', D),
    M('doubles: pairs without a bound', PAIRS, 'V(0x1p-98), V(0x1p-599)', 'V(0.0), V(0.0)', D),
    M('doubles: unclear numbers count', PAIRS, 'is_clear = is_bounded & (low == high);', 'is_clear = is_bounded;', D),
    M('doubles: large numbers in pairs', NUMBERS, 'auto is_safe = largest <= V(PrecisionOfDoubles::max_reach);',
      'auto is_safe = largest <= V(0x1p1023);', D),
    M('doubles: ends do not count', ONE_HIT,
      '(quotient_.low > V(finite_tmin(tmin))) & (quotient_.low < V(finite_tmax(tmax)))',
      '(quotient_.low >= V(finite_tmin(tmin))) & (quotient_.low <= V(finite_tmax(tmax)))', D),
    M('doubles: one hit by unclear numbers', ONE_HIT, '(bits(quotient_.is_clear) & 7u) == 7u',
      '(bits(quotient_.is_clear) & 3u) == 3u', D),
    M('doubles: one hit of large numbers', ONE_HIT, 'all(largest <= V(PrecisionOfDoubles::max_reach))', 'true', D),
    M('doubles: one hit without the third weight', ONE_HIT, 'blend<4>(scaled.value.high, w), within',
      'scaled.value.high, within', D),
    M('doubles: one hit has no bounds', ONE_HIT,
      'four_sums(of_e2 * of_c, of_e1 * of_c, of_n * of_s, of_n * of_d)', 'V(0.0)', D),
    M('doubles: one hit without the low parts', ONE_HIT, 'three_columns(a.low, b.low, c.low, d.low, low)',
      'low[0] = low[1] = low[2] = V(0.0)', D),
    M('doubles: edges flushed', 'kernels/exact/edge_bounds.hpp', 'min_error = 0x1p-500', 'min_error = 0.0', D),
    M('doubles: edges by the bound of half the errors', 'kernels/exact/edge_bounds.hpp',
      'unit_roundoff = 0x1p-53, min_error = 0x1p-500', 'unit_roundoff = 0x1p-56, min_error = 0x1p-500', D),
    M('doubles: corners of half leaves as of whole ones', RAYS,
      'return (leaf_triangle & half_leaf) != 0 ? tree_width / 2 : tree_width;', 'return tree_width;', D),
    M('doubles: sides of certain lanes do not count', SEARCH, 'filtered.certain = lanes_that_count(rule.facing, '
      'filtered.certain, fronts_of(filtered));', '', D),
    M('doubles: any side occludes', SEARCH,
      'found = lanes_that_count(facing, filtered.certain, fronts_of(filtered)) != 0',
      'found = filtered.certain != 0', D),
    M('doubles: behind a miss', SEARCH, 'if (!(last.t < infinity)) return no_leaf_triangle;', '', D),
    M('doubles: lists of both sides', LISTS,
      'filtered.undecided | lanes_that_count(batch.facing, filtered.certain, fronts)',
      'filtered.undecided | filtered.certain', D),
    M('doubles: sides of lists swapped', LISTS, '(fronts >> lane & 1u) != 0 ? -1 : 1',
      '(fronts >> lane & 1u) != 0 ? 1 : -1', D),
    M('doubles: points on the surface are crossings', LISTS, 'batch.kind == ListKind::places && crossing.holds_origin',
      'false', D),
    M('doubles: boxes rounded inwards', BUILD, 'extend(box, Float3{rounded_down(p[0]), rounded_down(p[1]), '
      'rounded_down(p[2])});', '', D),
    M('doubles: a refit keeps its frame', BUILD,
      'tree.mesh_bounds = bounds, tree.frame = frame;', 'tree.mesh_bounds = bounds;', D),
    M('doubles: bounds of the first part', BUILD, 'i < std::min((part + 1) * grain',
      'i < std::min((first + 1) * grain', D),
    M('doubles: leaves of the first part', BUILD, 'fill_leaf(tree, {first_half[i], ranges[i].count}, ',
      'if (begin == 0) fill_leaf(tree, {first_half[i], ranges[i].count}, ', D),
    M('doubles: no word of the choice', BUILD, 'report.choice = take_choice(', 'take_choice(', D),
    M('doubles: triangles stay left out', CALLS, 'if (comes_back(tree_->left_out, vertices, triangles))',
      'if (false)', D),
    M('doubles: lists of a few hits go on', LISTS, 'tmax = nearest.keep(t_hi, primitive, tmax);',
      'nearest.keep(t_hi, primitive, tmax);', D),
    M('doubles: lists of a few hits end before equal ones', LISTS, 'shorten(number_above(hit.t), hit.primitive);',
      'shorten(hit.t - hit.t * 0x1p-40, hit.primitive);', D),
    M('doubles: touched triangles of rows as others', LISTS, 'side == 0 && batch.kind == ListKind::lines', 'false', D),
    M('doubles: t of rows without an error', LINES, 'of_t = 0x1p-51', 'of_t = 0.0', D, source=PLACES),
    M('doubles: rays as records where they are arrays', SOURCE, 'arrays->direction[1][i]', 'arrays->direction[0][i]', D,
      source=PLACES),
]
