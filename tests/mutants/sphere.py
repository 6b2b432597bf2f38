"""Mutations of the sphere tests."""
from mutant import Mutant as M

TESTS = 'test_spheres'
SPHERE = 'kernels/sphere/ray_sphere.hpp'
SUPPORT = 'kernels/ray/loop_support.hpp'

MUTANTS = [
    M('sphere: open', SPHERE, 'nearest) <= sphere[3];', 'nearest) < sphere[3];', TESTS),
    M('sphere: behind the origin', SPHERE, 'min(max(d.middle, ray.tmin), ray.tmax)', 'min(d.middle, ray.tmax)',
      TESTS),
    M('sphere: beyond tmax', SPHERE, 'min(max(d.middle, ray.tmin), ray.tmax)', 'max(d.middle, ray.tmin)', TESTS),
    M('sphere: the larger root by cancellation', SPHERE, 'd.middle + flip<W>(half_chord, sign_of<W>(d.middle))',
      'd.middle - flip<W>(half_chord, sign_of<W>(d.middle))', TESTS),
    M('sphere: D² − r² in float only', SPHERE, 'if (any(cancelled)) [[unlikely]]',
      'if (any(cancelled & ~cancelled)) [[unlikely]]', TESTS),
    M('sphere: 0 / 0 for a tangent at the origin', SPHERE, 'select(q == zero, zero, power * ray.inverse_square / q)',
      'power * ray.inverse_square / q', TESTS),
    M('sphere: direction taken for a unit vector', SPHERE, 'ray.direction[axis] * -scale.inverse_square;',
      '-ray.direction[axis];', TESTS),
    M('sphere: all rays of a block by the scale of its first', SUPPORT, 'prepare(i + k);', 'prepare(i);', TESTS),
    M('sphere: an improper single ray let through', SUPPORT, 'const bool proper = is_proper(ray);\n  return {Floats',
      'const bool proper = true;\n  return {Floats', TESTS),
    M('line: an axis of the frame left out', SPHERE,
      'multiply_add<grade>(second[2], to_centre[2], second[1] * to_centre[1])', 'second[1] * to_centre[1]', TESTS),
    M('line: a frame that is not across', SPHERE, 'const double s[3] = {0.0, d[2] / across, -d[1] / across};',
      'const double s[3] = {0.0, d[2] / across, d[1] / across};', TESTS),
]
