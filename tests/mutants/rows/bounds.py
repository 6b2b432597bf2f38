"""Error bounds, margins and limits of kernels, made too small or left out."""
from mutant import rows_of

MUTANTS = [
    *rows_of('kernels/box/directional.hpp', 'test_boxes', rows=[
        ('directional box: no padding', 'V(8 * 0x1p-24f) * abs(product)', 'V(0.0f) * abs(product)'),
        ('directional box: no slack', 'select(tiny, slack, zero)', 'zero'),
    ]),
    *rows_of('kernels/box/slabs.hpp', 'test_boxes', rows=[
        ('box: the far side not widened', '1.0f + 3.0f * std::numeric_limits<float>::epsilon()', '1.0f'),
    ]),
    *rows_of('kernels/doubles/double_points.hpp', 'test_doubles', rows=[
        ('doubles: far points as near ones', 'x <= 0x1p60 && x >= -0x1p60', 'x <= 0x1p1000'),
        ('doubles: floats decide for points that go together', 'error_of_floats + 0x1p-14f', '-0.01f'),
    ]),
    *rows_of('kernels/doubles/double_streams.hpp', 'test_doubles', rows=[
        ('doubles: hits of streams stay unscaled', 'best.tmax * scale + 0x1p-500', 'best.tmax'),
    ]),
    *rows_of('kernels/doubles/doubles_together.hpp', 'test_doubles', rows=[
        ('doubles: packets end early', 'V(1.0 + 0x1p-22), V(0x1p-120)', 'V(0.99), V(0.0)'),
    ]),
    *rows_of('kernels/doubles/frame_ray.hpp', 'test_doubles', rows=[
        ('doubles: usual rays of any size', '(largest >= V(0x1p-400))', '(largest >= V(0.0))'),
    ]),
    *rows_of('kernels/doubles/hit_in_pairs.hpp', 'test_doubles', rows=[
        ('doubles: one hit without the third weight', 'blend<4>(scaled.value.high, w), within',
         'scaled.value.high, within'),
        ('doubles: one hit has no bounds', 'four_sums(of_e2 * of_c, of_e1 * of_c, of_n * of_s, of_n * of_d)', 'V(0.0)'),
    ]),
    *rows_of('kernels/doubles/pairs.hpp', 'test_doubles', rows=[
        ('doubles: pairs without a bound', 'V(0x1p-98), V(0x1p-599)', 'V(0.0), V(0.0)'),
    ]),
    *rows_of('kernels/exact/edge_bounds.hpp', 'test_doubles', unit='doubles', rows=[
        ('doubles: edges flushed', 'min_error = 0x1p-500', 'min_error = 0.0'),
        ('doubles: edges by the bound of half the errors', 'unit_roundoff = 0x1p-53, min_error = 0x1p-500',
         'unit_roundoff = 0x1p-56, min_error = 0x1p-500'),
    ]),
    *rows_of('kernels/exact/edge_bounds.hpp', 'test_exact', rows=[
        ('exact: too small a bound for all triangles', 'V(T{18.125} * unit)', 'V(T{0} * unit)'),
        ('exact: a t sure without a bound', 'V t = depth * inverse;', 'V t = depth * inverse; of_weights = V(0.0f);'),
        ('exact: a t without roundings', 'V(24 * unit), abs(det), V(min_error)', 'V(0 * unit), abs(det), V(0.0f)'),
    ]),
    *rows_of('kernels/exact/edge_bounds.hpp', 'test_exact', unit='triangles', rows=[
        ('exact: floats sure without a bound', 'return min(largest, -least) > within;',
         'return min(largest, -least) > V(T{0});'),
        ('exact: a bound for the sheared corners alone', 'V(T{18} * unit)', 'V(T{0} * unit)'),
        ('exact: quotients of flushed directions', 'min_direction = 0x1p-100f', 'min_direction = 0.0f'),
        ('exact: inside without a bound', 'return max(least, -largest) > bound;',
         'return max(least, -largest) > V(T{0});'),
    ]),
    *rows_of('kernels/exact/edge_bounds.hpp', 'test_exact', unit='triangles', path='sse2', rows=[
        ('exact: no bound for underflow', 'min_error = 0x1p-120f', 'min_error = 0.0f'),
    ]),
    *rows_of('kernels/exact/exact_numbers.hpp', 'test_exact', rows=[
        ('numbers: far weights without a bound', 'V(3.1)', 'V(0.0)'),
        ('numbers: any length of a direction', 'length > V(0x1p-64)', 'length > V(-1.0)'),
        ('packet: numbers without bounds', 'return h.t - h.t_bound; }', 'return h.t + h.t_bound; }'),
    ]),
    *rows_of('kernels/exact/exact_test.hpp', 'test_exact', path='avx', rows=[
        ('exact: sure though bounds overlap', '(t.t_hi < range.accept_below())', '(t.t_lo < range.accept_below())'),
    ]),
    *rows_of('kernels/exact/leaf_filter.hpp', 'test_doubles', unit='doubles', rows=[
        ('doubles: streams without a unit', 'unit = std::numeric_limits<T>::epsilon() / 2',
         'unit = sizeof(T) == 8 ? 0 : 0x1p-24f'),
    ]),
    *rows_of('kernels/exact/leaf_filter.hpp', 'test_exact', rows=[
        ('filter: sure though bounds overlap', '(t_hi < range.accept_below());', '(t_lo < range.accept_below());'),
        ('filter: far weights without a bound', 'V(far_factor * unit)', 'V(0.0f)'),
        ('filter: near weights without a bound', 'V(31.0f * unit)', 'V(0.0f)'),
        ('filter: far volumes without a bound', 'V(10.3f * unit)', 'V(0.0f)'),
        ('filter: products of normals without a bound', 'V(4.3f * unit)', 'V(0.0f)'),
        ('filter: near volumes without a bound', '+ of_normal);', '+ V(0.0f) * of_normal);'),
    ]),
    *rows_of('kernels/exact/predicate.cpp', 'test_exact', rows=[
        ('misses in doubles: without a bound', 'negative || weight < -0x1p-48 * sum', 'negative || weight <= 0'),
        ('misses in doubles: subnormals as zeros', 'static_cast<double>(magnitude) * 0x1p-149', '0.0'),
    ]),
    *rows_of('kernels/exact/sides.hpp', 'test_queries', unit='queries', rows=[
        ('sides: a share of one side is outside', '-edges.least : edges.largest) > within',
         '-edges.least : edges.largest) > -within'),
    ]),
    *rows_of('kernels/exact/wide_ratio.hpp', 'test_exact', unit='triangles', source='kernels/exact/predicate.cpp',
             rows=[
        ('exact: a quotient taken for exact', 'slack = 4', 'slack = 0'),
    ]),
    *rows_of('kernels/point/box_distance.hpp', 'test_points', rows=[
        ('point: boxes smaller than they are', 'magnitude_of(x) * 0x1p-22f + 0x1p-44f', '-0.01f'),
    ]),
    *rows_of('kernels/point/closest_in_tree.hpp', 'test_points', rows=[
        ('point: the bound by neighbours without room', '(1.0 + 0x1p-8) + room * room * 257.0', '0.5'),
        ('packet: the bound by neighbours without room', 'V(1.0f + 0x1p-7f), V(512.0f * room * room)',
         'V(0.5f), V(0.0f)'),
    ]),
    *rows_of('kernels/point/far_point.hpp', 'test_points', rows=[
        ('far: numbers are exact', '0x1p-18 + 0x1p-42 * most', '0.0'),
    ]),
    *rows_of('kernels/point/float_points.hpp', 'test_points', rows=[
        ('point: floats decide', 'error_of_floats = 0x1.2p-16f', 'error_of_floats = 0.0f'),
        ('point: what is flushed from points that were found', 'flushed_from_found = 0x1p-125f',
         'flushed_from_found = 0.0f'),
    ]),
    *rows_of('kernels/point/near_triangles.hpp', 'test_points', rows=[
        ('point: those without edges bound others', ' & (shortest_squared > V(0.0f))', ''),
    ]),
    *rows_of('kernels/roots/method.hpp', 'test_roots', rows=[
        ('Newton: shifted too far', '0.75 * estimate_error', '7.5 * estimate_error'),
    ]),
    *rows_of('kernels/roots/reciprocal_methods.hpp', 'test_roots', rows=[
        ('corrected: the rounding error of a y forgotten',
         'multiply_add<Grade::fast>(error_of_product(p, a, y), y, residual)',
         'residual'),
    ]),
    *rows_of('kernels/roots/sqrt_methods.hpp', 'test_roots', rows=[
        ('Goldschmidt: no guard against underflow', 'T(0x1p-78)', 'T(0x1p-110)'),
    ]),
    *rows_of('kernels/simd/derived.hpp', 'test_triangles', unit='triangles', rows=[
        ('Kahan without its error term', 'return fused(a, b, -cd) + error;', 'return fused(a, b, -cd);'),
    ]),
    *rows_of('kernels/sphere/scaled_ray.hpp', 'test_spheres', rows=[
        ('sphere: direction taken for a unit vector', 'Floats<W> back = -s.inverse_square;',
         'const Floats<W> back(-1.0f);'),
    ]),
    *rows_of('kernels/traverse/fused/fused_leaves.hpp', 'test_exact', rows=[
        ('fused: sure though bounds overlap', 'to < query.t_lo)', 'from < query.t_lo)'),
    ]),
    *rows_of('kernels/traverse/fused/fused_ray.hpp', 'test_bvh', rows=[
        ('fused: zeros of directions divide', 'min_component = 0x1p-60f', 'min_component = 0.0f'),
        ('fused: any origin', 'max_coordinate = 0x1p60f', 'max_coordinate = 0x1p127f'),
    ]),
    *rows_of('kernels/traverse/fused/fused_ray.hpp', 'test_exact', rows=[
        ('fused: boxes not padded', 'pad = 0x1p-21f', 'pad = 0.0f'),
    ]),
    *rows_of('kernels/traverse/fused/hit_numbers.hpp', 'test_exact', rows=[
        ('fused: doubles without bounds behind', 'four_floats(1.0f, 1.0f, tmax, 0.0f)',
         'four_floats(0.5f, 1.0f, tmax, 0.0f)'),
        ('fused: numbers without bounds', 'to_four_floats(number - bound)', 'to_four_floats(number + bound)'),
    ]),
    *rows_of('kernels/traverse/packet/apex_triangles.hpp', 'test_exact', rows=[
        ('packet: no bound of edge planes', 'V(edge_units * unit)', 'V(0 * unit)'),
    ]),
    *rows_of('kernels/traverse/packet/frusta.hpp', 'test_bvh', rows=[
        ('packet: boxes not widened', 'padding((frustum_pad + rounding) * reach + 0x1p-90f)', 'padding(0.0f)'),
    ]),
    *rows_of('kernels/traverse/stream_boxes.hpp', 'test_exact', rows=[
        ('stream: boxes widened on one side', 'V::load(node.hi[axis] + first) + V(padding)',
         'V::load(node.hi[axis] + first)'),
    ]),
    *rows_of('kernels/traverse/stream_rays.hpp', 'test_exact', rows=[
        ('stream: boxes not widened',
         'const float of_roundings = (0x1p-21f + tree.origin_share) * (largest + farthest) + 0x1p-90f + '
         'tree.padding;',
         'const float of_roundings = 0.0f;'),
        ('stream: any size of a direction', '(largest >= V(0x1p-30f)) &', ''),
    ]),
    *rows_of('kernels/triangle/watertight.hpp', 'test_triangles', rows=[
        ('watertight: an epsilon on the edges', '(least >= V(0.0f))', '(least >= V(-1e-7f))'),
    ]),
    *rows_of('kernels/winding/winding_kernels.cpp', 'test_doubles', rows=[
        ('loops: doubles are flushed', 'doubtful = doubtful | ~(square >= V(0x1p-900));', ''),
        ('loops: doubles without a scale before', 'coordinate = coordinate * V(boundary.scale.before)',
         'coordinate = coordinate * V(1.0)'),
    ]),
    *rows_of('kernels/winding/winding_kernels.cpp', 'test_queries', rows=[
        ('expand: whatever the error', '(V(node.full_error) <= allowed * over_full)', '(radius >= V(0.0))'),
        ('expand: errors do not add up', 'spent_ = spent_ + select(accepted, error, V(0.0));', ''),
    ]),
]
