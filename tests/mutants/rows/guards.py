"""Masks, rests of arrays, invalid values and overflow in kernels, not looked at."""
from mutant import rows_of

MUTANTS = [
    *rows_of('kernels/box/box_kernels.cpp', 'test_boxes', rows=[
        ('box: invalid rays let through', '& under.valid & loaded.are_valid()', '& under.valid'),
        ('box: a NaN plane ignored on the last axis', 'entry = max(entry, ray.near(2, near_plane[2]));',
         'entry = max(ray.near(2, near_plane[2]), entry);'),
        ('box: a NaN plane ignored on the first', 'return (entry <= exit) & is_box;', 'return (entry <= exit);'),
        ('mask: ignored where nothing is hit', 'store_no_hits(n, active, out)', 'store_no_hits(n, nullptr, out)'),
    ]),
    *rows_of('kernels/box/directional.hpp', 'test_boxes', rows=[
        ('directional box: no zero repair', 'select(tiny, repaired, direction[axis])', 'direction[axis]'),
    ]),
    *rows_of('kernels/doubles/double_points.hpp', 'test_doubles', rows=[
        ('doubles: units of points that overflow', 'return 400 - exponent < 1022 ? 400 - exponent : 1022;',
         'return exponent - exponent;'),
    ]),
    *rows_of('kernels/winding/seen_loop.hpp', 'test_doubles', unit='winding',
             source='kernels/winding/boundary_loop.cpp', rows=[
        ('loop: sights of doubles overflow', 'if (overflows)', 'if (false)'),
    ]),
    *rows_of('kernels/point/box_distance.hpp', 'test_points', rows=[
        ('point: units that overflow', '255u - (exponent == 0 ? 1u : exponent)', '127u'),
    ]),
    *rows_of('kernels/ray/ranges.hpp', 'test_triangle_meshes', unit='triangles', rows=[
        ('range: an infinite t is a hit', 'return tmax > largest_t ? largest_t : tmax;', 'return tmax;'),
        ('range: an infinite t of a lane is a hit', 'return min(Lanes<T, N>(largest_t), tmax);', 'return tmax;'),
        ('range: NaN for tmin forgotten', 'max(Lanes<T, N>(-largest_t), tmin)', 'max(tmin, tmin)'),
    ]),
    *rows_of('kernels/ray/ray_columns.hpp', 'test_boxes', unit='boxes', rows=[
        ('box: an invalid single ray let through', 'if (is_valid(ray)) return', 'return'),
    ]),
    *rows_of('kernels/ray/ray_columns.hpp', 'test_spheres', unit='spheres', rows=[
        ('sphere: an invalid single ray let through', 'if (is_valid(ray)) return', 'return'),
    ]),
    *rows_of('kernels/ray/valid_ray.hpp', 'test_boxes', unit='boxes', rows=[
        ('valid ray: an infinite origin', 'for (const V& x : origin) nothing = nothing * x;', ''),
        ('valid ray: an infinite direction', 'for (const V& x : direction) nothing = nothing * x;', ''),
    ]),
    *rows_of('kernels/roots/array_loop.hpp', 'test_root_answers', rows=[
        ('blocks with zeros: stored as if all were served',
         'while (i < last && store_block<M, T, mix, EstimatesOrOne>(x + i, y + i)) i += block;',
         'for (; i < last; i += block) store_block<M, T, mix, EstimatesOrOne>(x + i, y + i);'),
    ]),
    *rows_of('kernels/roots/domain_check.hpp', 'test_roots', path='avx', rows=[
        ('extremes: NaN forgets the largest before it', 'largest_ = max(size, largest_);',
         'largest_ = max(largest_, size);'),
    ]),
    *rows_of('kernels/roots/method.hpp', 'test_roots', rows=[
        ('sentinel: NaN and negative numbers for numbers', 'return max_estimate(least) - 0x00800000u;',
         'return 0x7f000000u;'),
    ]),
    *rows_of('kernels/roots/sqrt_methods.hpp', 'test_roots', path='sse2', rows=[
        ('residual: no guard against overflow', 'max() / 2;', 'max();'),
        ('residual of doubles: no guard against overflow', 'struct ScaledResidualBase : ResidualBase',
         'struct ScaledResidualBase : RootMethodBase'),
    ]),
    *rows_of('kernels/simd/backend_xsimd.hpp', 'test_root_answers', unit='roots', path='avx512', rows=[
        ('a mask register: one lane more', '(1u << count) - 1u', '(2u << count) - 1u'),
    ]),
    *rows_of('kernels/simd/backend_xsimd_registers.hpp', 'test_root_answers', unit='roots', rows=[
        ('partial store of doubles: all lanes', '_mm256_maskstore_pd(p, _mm256_castpd_si256(m), a)',
         '_mm256_storeu_pd(p, a)'),
        ('partial load of floats: all lanes',
         '_mm256_blendv_ps(filler, _mm256_maskload_ps(p, _mm256_castps_si256(m)), m)',
         '_mm256_loadu_ps(p)'),
    ]),
    *rows_of('kernels/simd/slices.hpp', 'test_boxes', unit='boxes', rows=[
        ('rest: the last element left out', '(1u << left) - 1u', '(1u << (left - 1)) - 1u'),
        ('rest: one element too many', 'return bits & ((1u << left) - 1u);', 'return bits & ((2u << left) - 1u);'),
        ('rest: all lanes loaded',
         'return Floats<W>::load(p + i, lanes, Floats<W>(std::numeric_limits<float>::quiet_NaN()));',
         'return Floats<W>::load(p + i);'),
        ('rest: all lanes stored', 'x.store(p + i, lanes);', 'x.store(p + i);'),
        ('rest: bits behind the last cleared', 'const std::uint32_t others = mine == 0xffu ? 0u : out[b] & ~mine;',
         'const std::uint32_t others = 0u;'),
        ('mask: ignored', 'if (active != nullptr) {', 'if (active != nullptr && end == 0) {'),
    ]),
    *rows_of('kernels/simd/slices.hpp', 'test_triangles', unit='triangles', rows=[
        ('rest: a lane too many', '((1u << left) - 1u)', '((2u << left) - 1u)'),
        ('mask: not looked at', 'if (active != nullptr) {', 'if (false) {'),
        ('mask: bits of others cleared', 'out[b] & ~mine', '0u'),
    ]),
    *rows_of('kernels/simd/slices.hpp', 'test_triangles', unit='triangles', path='sse2', rows=[
        ('mask: the byte of a neighbour', 'active[i / 8]) >> (i % 8)', 'active[i / 8])'),
    ]),
    *rows_of('kernels/sphere/perpendicular.hpp', 'test_spheres', rows=[
        ('sphere: beyond tmax', 'min(max(d.middle, ray.tmin), ray.tmax)', 'max(d.middle, ray.tmin)'),
    ]),
    *rows_of('kernels/sphere/sphere_kernels.cpp', 'test_spheres', rows=[
        ('sphere: invalid rays let through', 'Test::hits(ray, one) & loaded.are_valid()', 'Test::hits(ray, one)'),
        ('sphere: invalid rays let through, distances', 'd.hit & loaded.are_valid()', 'd.hit'),
        ('line: mask ignored where nothing is hit', 'store_no_hits(n, active, out)', 'store_no_hits(n, nullptr, out)'),
        ('closest: an infinite tmin', 'finite_tmin(ray.tmin)', 'ray.tmin'),
    ]),
    *rows_of('kernels/traverse/node_test.hpp', 'test_bvh', rows=[
        ('an infinite reciprocal culls', 'x != 0.0f && (inverse', 'false && (inverse'),
    ]),
    *rows_of('kernels/traverse/one_by_one.hpp', 'test_bvh', path='avx', rows=[
        ('single: invalid rays traced', 'tree.root != empty_reference && is_valid(ray)',
         'tree.root != empty_reference'),
    ]),
    *rows_of('kernels/traverse/query.hpp', 'test_bvh', rows=[
        ('an infinite t is a hit', 'explicit Closest(const Ray& ray) : tmax(finite_tmax(ray.tmax)) {}',
         'explicit Closest(const Ray& ray) : tmax(ray.tmax) {}'),
        ('any: an infinite t is a hit', 'explicit AnyHit(const Ray& ray) : AnyHit(finite_tmax(ray.tmax)) {}',
         'explicit AnyHit(const Ray& ray) : AnyHit(ray.tmax) {}'),
    ]),
    *rows_of('kernels/triangle/triangle_kernels.cpp', 'test_triangles', rows=[
        ('rays: invalid ones let through', '(loaded, slice).hit & loaded.are_valid();', '(loaded, slice).hit;'),
        ('one ray: an invalid one let through', 'if (!is_valid(ray)) return store_no_hits',
         'if (false) return store_no_hits'),
    ]),
]
