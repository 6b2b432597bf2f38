"""Mutations of the triangle kernels."""
from mutant import Mutant as M

T, E = 'test_triangles', 'test_triangle_meshes'
FOLDER = 'kernels/triangle/'
WATERTIGHT, CORNERS, PLANES = FOLDER + 'watertight.hpp', FOLDER + 'moller_trumbore.hpp', FOLDER + 'plane_edges.hpp'
PRECOMPUTED, LOOPS = FOLDER + 'precomputed.hpp', FOLDER + 'triangle_kernels.cpp'
TEST = 'kernels/ray/triangle_test.hpp'
AXES, RANGES, RAYS = 'kernels/ray/axes.hpp', 'kernels/ray/ranges.hpp', 'kernels/ray/ray_columns.hpp'
NEAREST = 'kernels/ray/nearest.hpp'
VALID, SLICES = 'kernels/ray/valid_ray.hpp', 'kernels/simd/slices.hpp'
DOOR = 'dispatch/triangles.cpp'
EXACT = 'kernels/exact/'
EDGES, NUMBERS, PREDICATE = EXACT + 'edge_bounds.hpp', EXACT + 'exact_numbers.hpp', EXACT + 'predicate.cpp'
WIDE, RATIO = EXACT + 'wide_integer.hpp', EXACT + 'wide_ratio.hpp'
X = 'test_exact'
DERIVED, VEC3 = 'kernels/simd/derived.hpp', 'kernels/simd/vec3.hpp'

SAME_SIGN = '(least >= V(0.0f)) | (largest <= V(0.0f))'
DIVIDE = 'V t() const { return scaled_t / det + V(0.0f); }'
SEGMENT = 'MaskOf<V> holds(V t) const { return (t >= tmin) & (t <= tmax); }'

MUTANTS = [
    M('exact: floats sure without a bound', EDGES, 'return min(largest, -least) > within;',
      'return min(largest, -least) > V(T{0});', X),
    M('exact: a bound for the sheared corners alone', EDGES, 'V(T{18} * unit)', 'V(T{0} * unit)', X),
    # A fused operation hides it.
    M('exact: no bound for underflow', EDGES, 'min_error = 0x1p-120f', 'min_error = 0.0f', X, 'sse2'),
    M('exact: quotients of flushed directions', EDGES, 'min_direction = 0x1p-100f', 'min_direction = 0.0f', X),
    M('exact: inside without a bound', EDGES, 'return max(least, -largest) > bound;',
      'return max(least, -largest) > V(T{0});', X),
    M('exact: the depth of the wrong side', EDGES, 'depth = -e.depth(', 'depth = e.depth(', X),
    M('exact: numbers in doubles always clear', NUMBERS, 'is_clear(low_ == high)', 'is_clear(low_ == low_)', X),
    M('exact: ends of the segment by the rounded t', NUMBERS, '& ~at_an_end)', ')', X),
    M('exact: numbers that miss the segment are hits', NUMBERS, '(t.low > tmin) & (t.value < tmax)',
      '(t.low > tmin)', X),
    M('exact: open edges', PREDICATE, 'if (x.u.is_negative() || x.v.is_negative() || x.w.is_negative()) return {};',
      'if (x.u.sign() <= 0 || x.v.sign() <= 0 || x.w.sign() <= 0) return {};', X),
    M('exact: tmin open', PREDICATE, 't.compared_with(Dyadic(tmin)) >= 0', 't.compared_with(Dyadic(tmin)) > 0', X),
    M('exact: one winding only', PREDICATE, 'if (sign == 0) return {};', 'if (sign <= 0) return {};', X),
    M('exact: a quotient rounded twice', RATIO, 'rounds_up = side > 0 ||', 'rounds_up = side < 0 ||', X,
      source=PREDICATE),
    M('exact: one word for all exponents', PREDICATE, 'bits.coordinates <= 61', 'bits.coordinates <= 290', X),
    M('exact: minors in one word', PREDICATE, 'bits.coordinates <= 30', 'bits.coordinates <= 40', X),
    M('exact: a quotient taken for exact', RATIO, 'slack = 4', 'slack = 0', X, source=PREDICATE),
    M('exact: a factor taken without its sign', WIDE, 'correct(a.is_negative(), m, b.word, n);', '', X,
      source=PREDICATE),
    M('exact: a carry lost', WIDE, 'carry = static_cast<std::uint64_t>(sum >> 64);', 'carry = 0;', X,
      source=PREDICATE),
    M('watertight: an epsilon on the edges', WATERTIGHT, '(least >= V(0.0f))', '(least >= V(-1e-7f))', T),
    M('watertight: strict edges', WATERTIGHT, SAME_SIGN, '(least > V(0.0f)) | (largest < V(0.0f))', T),
    M('watertight: one winding only', WATERTIGHT, SAME_SIGN, '(least >= V(0.0f)) & (least >= V(0.0f))', T),
    M('watertight: an edge left out', WATERTIGHT, 'least(min(min(e.u, e.v), e.w))', 'least(min(e.u, e.v))', T),
    M('watertight: y twice in an edge', WATERTIGHT, '(a.x, c.y, a.y, c.x)', '(a.x, c.y, a.y, c.y)', T),
    M('watertight: no fallback in double', WATERTIGHT, 'if (any(undecided)) [[unlikely]] {',
      'if (any(undecided & ~undecided)) [[unlikely]] {', T),
    M('watertight: z of the wrong corner', WATERTIGHT, 'multiply_add<grade>(e.u, a.z, e.v * b.z)',
      'multiply_add<grade>(e.u, b.z, e.v * b.z)', T),
    M('watertight: Kahan determinants mirrored', WATERTIGHT, 'keeps_winding = grade == Grade::fast && has_fma',
      'keeps_winding = false', T),
    M('fused where none belongs', DERIVED, '    return a * b - c * d;',
      '    return multiply_add<Grade::fast>(a, b, -(c * d));', T),
    M('Kahan without its error term', DERIVED, 'return fused(a, b, -cd) + error;', 'return fused(a, b, -cd);', T),
    M('reproducible grade fuses', DERIVED, 'if constexpr (grade == Grade::fast && requires { fused(a, b, c); })',
      'if constexpr (requires { fused(a, b, c); })', T),
    M('cross product: z twice', VEC3, '-(a.z * b.y)', '-(a.z * b.z)', T),
    M('moller_trumbore: u + v <= det dropped', CORNERS, ' & (u + v <= det)', '', T),
    M('moller_trumbore: v not tested', CORNERS, '(min(u, v) >= V(0.0f)) & (u + v <= det)',
      '(u >= V(0.0f)) & (u + v <= det)', T),
    M('moller_trumbore: one winding only', CORNERS, 'det = abs(signed_det);\n'
      '    auto sign = sign_of(signed_det);\n    V u = flip(dot(to_o',
      'det = signed_det;\n    auto sign = sign_of(signed_det);\n    V u = flip(dot(to_o', T),
    M('edges: of the wrong corner', CORNERS, 'corners[k] - corners[k % 3]', 'corners[k] - corners[3 + k % 3]', T),
    M('directional: e1 without the sign', CORNERS, 'out[3] = flip(e1.x, sign)', 'out[3] = e1.x', T),
    M('directional: p without the sign', CORNERS, 'out[9] = flip(p.x, sign)', 'out[9] = p.x', T),
    M('directional: u + v <= det dropped', CORNERS, ' & (u + v <= c[12])', '', T),
    M('precomputed: u + v <= 1 dropped', PRECOMPUTED, ' & (u + v <= V(1.0f))', '', T),
    M('precomputed: rows exchanged', PRECOMPUTED, 'out[3 + axis] = static_cast<float>(a[axis]',
      'out[3 + axis] = static_cast<float>(b[axis]', T),
    M('plane_edges: an edge compared with the wrong corner', PLANES, 'n2 = Steps::edge_normal(point, c + 6, c);\n'
      '    MaskOf<V> inside = (dot(n0, n)',
      'n2 = Steps::edge_normal(point, c + 6, c + 3);\n    MaskOf<V> inside = (dot(n0, n)', T),
    M('plane_edges: u and v swapped', PLANES, 'sqrt(dot(n2, n2)) / size, sqrt(dot(n0, n0)) / size',
      'sqrt(dot(n0, n0)) / size, sqrt(dot(n2, n2)) / size', T),
    M('plane_edges: no test of the segment', PLANES, 'range.holds(h.distance)', '(h.distance == h.distance)', T),
    M('t may lose its sign of zero', TEST, DIVIDE, 'V t() const { return scaled_t / det; }', T),
    M('tmin open', RANGES, SEGMENT, SEGMENT.replace('t >= tmin', 't > tmin'), T),
    M('tmax open', RANGES, SEGMENT, SEGMENT.replace('t <= tmax', 't < tmax'), T),
    M('range: an infinite t is a hit', RANGES, 'return tmax > largest_t ? largest_t : tmax;', 'return tmax;', E),
    M('range: an infinite t of a lane is a hit', RANGES, 'return min(Lanes<T, N>(largest_t), tmax);',
      'return tmax;', E),
    M('range: t of minus infinity is a hit', RANGES, 'return tmin < -largest_t ? -largest_t : tmin;',
      'return tmin;', E),
    M('range: NaN for tmin forgotten', RANGES, 'max(Lanes<T, N>(-largest_t), tmin)', 'max(tmin, tmin)', E),
    M('closest: the last of equals wins', RANGES, '(t >= tmin) & (t < best)', '(t >= tmin) & (t <= best)', T),
    M('closest: behind the origin', RANGES, '(t >= tmin) & (t < best)', '(t < best)', T),
    M('closest: tmax open', NEAREST, 'above(next_above(tmax))', 'above(tmax)', T),
    M('closest: equals by lane', NEAREST, '(t == best.t && primitive < best.primitive)', 'false', T),
    M('closest: index without its lane', NEAREST, 'lanes + FloatBits<W>(static_cast<std::uint32_t>(first))',
      'FloatBits<W>(static_cast<std::uint32_t>(first))', T),
    M('closest: u of all lanes', LOOPS, 'best.u = select(h.hit, h.u(), best.u);', 'best.u = h.u();', T),
    M('rays: an axis kept where it should move', AXES, 'V last = select(z_is_x, v.z, select(z_is_y, v.x, v.y));',
      'V last = v.y;', T),
    M('rays: mirrored by one axis alone', AXES, 'select(swapped, next, last), major', 'last, major', T),
    M('one ray: axes not turned', AXES, 'int z = magnitude(1) > magnitude(0) ? 1 : 0;', 'int z = 0;', T),
    M('one ray: Kahan determinants mirrored', AXES, 'ShearAxes{axes.y, axes.x, z} :',
      'ShearAxes{axes.x, axes.y, z} :', T),
    M('rays: invalid ones let through', LOOPS, '(loaded, slice).hit & loaded.are_valid();', '(loaded, slice).hit;', T),
    M('one ray: an invalid one let through', LOOPS, 'if (!is_valid(ray)) return store_no_hits',
      'if (false) return store_no_hits', T),
    M('prepare: the direction forgotten', LOOPS, 'if (direction != nullptr) d =', 'if (direction == nullptr) d =', T),
    M('prepare: the rest forgotten', LOOPS, 'for_each_slice(0, n, active, [&](const auto& slice) {\n    F corner',
      'for_each_slice(0, n / W * W, active, [&](const auto& slice) {\n    F corner', T),
    M('rest: a lane too many', SLICES, '((1u << left) - 1u)', '((2u << left) - 1u)', T),
    M('mask: not looked at', SLICES, 'if (active != nullptr) {', 'if (false) {', T),
    M('mask: the byte of a neighbour', SLICES, 'active[i / 8]) >> (i % 8)', 'active[i / 8])', T, 'sse2'),
    M('door: the size of t not asked', DOOR, 'require_size("closest_hits", "t", hits.t.size(), "rays", rays.size);',
      '', T),
    M('door: the size of u not asked', DOOR, 'if (!hits.u.empty()) require_size', 'if (false) require_size', T),
    M('door: an absent v written', DOOR, 'hits.v.empty() ? nullptr', 'hits.u.empty() ? nullptr', T),
    M('door: the mask forgotten', DOOR, 'arrays, triangles.size, options.active, nearest',
      'arrays, triangles.size, nullptr, nearest', T),
    M('door: numbers of inactive triangles', DOOR, 'options.active, direction.data(), out',
      'nullptr, direction.data(), out', T),
    M('door: moved from, as many as before', DOOR, 'size_(std::exchange(other.size_, 0))', 'size_(other.size_)', T),
    M('door: more than a hit can name', DOOR, 'require_nameable("closest_hit", triangles.size, "triangles");', '', T),
    M('door: the direction of the first ray, active or not', DOOR,
      'if (takes_part(options.active, i)) {', 'if (true) {', T),
    M('door: another direction forgotten', DOOR, 'if (options_.test != TriangleTest::directional) return;',
      'return;', T),
    M('mask: bits of others cleared', SLICES, 'out[b] & ~mine', '0u', T),
]
