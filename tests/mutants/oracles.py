"""Mutations of the exact oracles, which have tests of their own."""
from mutant import Mutant as M

T = 'test_exact_oracle'
TRIANGLE = 'bench/support/oracles/exact_triangle.cpp'

MUTANTS = [
    M('oracle: edges are outside', TRIANGLE, 'return sgn(w) * sgn(test.det) >= 0;',
      'return sgn(w) * sgn(test.det) > 0;', T),
    M('oracle: the end of the segment is outside', TRIANGLE, 'bound > 0 : t <= mpq_class(bound)',
      'bound > 0 : t < mpq_class(bound)', T),
]
