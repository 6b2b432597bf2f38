"""Mutations of the sphere tests."""
from mutant import Mutant as M

TESTS = 'test_spheres'
SCALED = 'kernels/sphere/scaled_ray.hpp'
PERPENDICULAR = 'kernels/sphere/perpendicular.hpp'
TEXTBOOK = 'kernels/sphere/textbook.hpp'
LINE = 'kernels/sphere/line.hpp'
SPHERES = 'kernels/sphere/sphere_kernels.cpp'
RAYS = 'kernels/ray/ray_columns.hpp'
NEAREST = 'kernels/ray/nearest.hpp'

MUTANTS = [
    M('sphere: open', PERPENDICULAR, 'nearest) <= sphere[3];', 'nearest) < sphere[3];', TESTS),
    M('sphere: behind the origin', PERPENDICULAR, 'min(max(d.middle, ray.tmin), ray.tmax)', 'min(d.middle, ray.tmax)',
      TESTS),
    M('sphere: beyond tmax', PERPENDICULAR, 'min(max(d.middle, ray.tmin), ray.tmax)', 'max(d.middle, ray.tmin)', TESTS),
    M('sphere: the larger root by cancellation', PERPENDICULAR, 'd.middle + flip(half_chord, sign_of(d.middle))',
      'd.middle - flip(half_chord, sign_of(d.middle))', TESTS),
    M('sphere: D² − r² in float only', PERPENDICULAR, 'if (any(cancelled)) [[unlikely]]',
      'if (any(cancelled & ~cancelled)) [[unlikely]]', TESTS),
    M('sphere: 0 / 0 for a tangent at the origin', PERPENDICULAR,
      'select(q == zero, zero, excess * ray.inverse_square / q)', 'excess * ray.inverse_square / q', TESTS),
    M('sphere: direction taken for a unit vector', SCALED, 'Floats<W> back = -s.inverse_square;',
      'const Floats<W> back(-1.0f);', TESTS),
    M('sphere: all rays of a block by the scale of its first', SPHERES, '(scale_of(direction), slice.i - run.first)',
      '(scale_of(direction), 0)', TESTS),
    M('sphere: an invalid single ray let through', RAYS, 'if (is_valid(ray)) return', 'return', TESTS),
    M('sphere: invalid rays let through', SPHERES, 'Test::hits(ray, one) & loaded.are_valid()', 'Test::hits(ray, one)',
      TESTS),
    M('sphere: invalid rays let through, distances', SPHERES, 'd.hit & loaded.are_valid()', 'd.hit', TESTS),
    M('sphere: ends in disorder', 'kernels/ray/valid_ray.hpp', '(tmin <= tmax) & ', '', TESTS),
    M('line: mask ignored where nothing is hit', SPHERES, 'store_no_hits(n, active, out)',
      'store_no_hits(n, nullptr, out)', TESTS),
    M('textbook: far and near swapped', TEXTBOOK, 'near <= ray.tmax) & (far >= ray.tmin)',
      'far <= ray.tmax) & (near >= ray.tmin)', TESTS),
    M('closest: the entry alone', SPHERES, 'select(d.near >= tmin, d.near, d.far)', 'd.near', TESTS),
    M('closest: the exit alone', SPHERES, 'select(d.near >= tmin, d.near, d.far)', 'd.far', TESTS),
    M('closest: tmin open', SPHERES, 'select(d.near >= tmin, d.near, d.far)', 'select(d.near > tmin, d.near, d.far)',
      TESTS),
    M('closest: tmax open', NEAREST, 'above(next_above(tmax))', 'above(tmax)', TESTS),
    M('closest: the segment not looked at', SPHERES, 'd.hit & Nearer<Floats<W>>{tmin, best.t}.holds(t)',
      'd.hit & (t < best.t)', TESTS),
    M('closest: an infinite tmin', SPHERES, 'finite_tmin(ray.tmin)', 'ray.tmin', TESTS),
    M('closest: not nearer than the best', SPHERES, 'Nearer<Floats<W>>{tmin, best.t}.holds(t)',
      '(t >= tmin) & (t <= Floats<W>(ray.tmax))', TESTS),
    M('closest: equals by lane', NEAREST, '(t == best.t && primitive < best.primitive)', 'false', TESTS),
    M('closest: index without its lane', NEAREST, 'lanes + FloatBits<W>(static_cast<std::uint32_t>(first))',
      'FloatBits<W>(static_cast<std::uint32_t>(first))', TESTS),
    M('closest: index without its register', NEAREST, 'lanes + FloatBits<W>(static_cast<std::uint32_t>(first))',
      'lanes', TESTS),
    M('line: an axis of the frame left out', LINE,
      'multiply_add<grade>(second.z, to_origin.z, second.y * to_origin.y)', 'second.y * to_origin.y', TESTS),
    M('line: a frame that is not across', LINE, 'const double s[3] = {0.0, d[2] / across, -d[1] / across};',
      'const double s[3] = {0.0, d[2] / across, d[1] / across};', TESTS),
]
