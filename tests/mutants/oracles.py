"""Mutations of the exact oracles, which have tests of their own."""
from mutant import Mutant as M

T = 'test_exact_oracle'
TRIANGLE = 'bench/support/oracles/exact_triangle.cpp'
CROSSINGS = 'bench/support/oracles/exact_crossings.cpp'
SUM = 'bench/support/oracles/winding_sum.cpp'
DOUBLE_ROOTS, TOOL = 'bench/support/roots/double_survey.cpp', 'test_contenders'

MUTANTS = [
    M('oracle: edges are outside', TRIANGLE, 'return sgn(w) * sgn(test.det) >= 0;',
      'return sgn(w) * sgn(test.det) > 0;', T),
    M('oracle: the end of the segment is outside', TRIANGLE, 'bound > 0 : t <= mpq_class(bound)',
      'bound > 0 : t < mpq_class(bound)', T),
    M('oracle: edges are faces', CROSSINGS, 'least == 0 ? Touch::edge', 'least == 0 ? Touch::face', T),
    M('oracle: what is in the plane is on the face', CROSSINGS, 'least < 0 ? Touch::none',
      'least < 0 ? Touch::face', T),
    M('oracle: the line of a triangle without an area goes on', CROSSINGS, 'side == 0 && in_box ?', 'side == 0 ?', T),
    M('oracle: triangles with two equal corners have edges', CROSSINGS, 'if (a == b || b == c || c == a) return',
      'if (a == b && b == c) return', T),
    M('sum: faces have the number of one side', SUM, 'if (exact.side == 0) continue;', '', T),
    M('sum: edges are judged', SUM, 'if (exact.touch == Touch::edge) return {0, 0, true};', '', T),
    M('sum: doubles decide the side', SUM, 'z.det = std::copysign(z.det, exact.side);', '', T),
    M('sum: doubles are trusted too soon', SUM, 'det_error = 12 * u', 'det_error = 0.01 * u', T),
    M('sum: angles have no error', SUM, 'z_error = 56 * u', 'z_error = 0.1 * u', T),
    M('roots of doubles: the rest is counted twice', DOUBLE_ROOTS, 'std::fma(-a, y, 1.0L) * y', 'y', TOOL),
    M('roots of doubles: ULP of the next binade', DOUBLE_ROOTS, 'digits - 1)', 'digits)', TOOL),
    M('roots of doubles: special values of none', DOUBLE_ROOTS, 'in.fill(3), in[place] = x;', 'in.fill(3);', TOOL),
]
