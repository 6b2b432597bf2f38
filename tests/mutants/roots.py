"""Mutations of the square roots and their relatives."""
from mutant import Mutant as M

# The object they go into: the static library path_PATH of the build, and what it is made of.
LIBRARY, SOURCE = 'path', 'kernels/path.cpp'

VALUES, ARRAYS, GRADES, SURVEY = 'test_sqrt', 'test_root_arrays', 'test_root_grades', 'test_root_survey'
DOUBLES = 'test_root_doubles'
METHODS, RECIPROCALS = 'kernels/square_root.hpp', 'kernels/reciprocal_methods.hpp'
SUPPORT, LOOPS = 'kernels/method_support.hpp', 'kernels/square_root_arrays.hpp'
TABLE, TOGETHER = 'kernels/square_root_table.hpp', 'kernels/lockstep.hpp'

MUTANTS = [
    # Methods.
    M('classic: another constant', METHODS, '(1u << 22) - 0x4C000u>(a);\n    for', '(1u << 22) - 0x4B0D2u>(a);\n    for',
      VALUES),
    M('classic: the last step dropped', METHODS, 'i < Steps; ++i) s = heron_step', 'i + 1 < Steps; ++i) s = heron_step',
      VALUES),
    M('Heron step: a little more than half', METHODS, 'return constant<V>(0.5) * (s + a / s);',
      'return constant<V>(0.50000006) * (s + a / s);', VALUES),
    M('weighted: a digit of a weight', METHODS, '0.514830168f', '0.514830268f', VALUES),
    M('weighted: the plain step dropped', METHODS, 'Steps == 1 ? s : heron_step(s, a)', 's', VALUES),
    M('Halley: guard two binades lower', METHODS, 'least_normal<T> * 4', 'least_normal<T>', VALUES),
    M('Halley: guard three binades higher', METHODS, 'max() / 8', 'max()', VALUES),
    M('polynomial: a digit of a coefficient', METHODS, '0.663271599', '0.663272599', VALUES),
    M('polynomial: fused though reproducible', METHODS, 'p = p * w + constant<V>(c[i])',
      'p = multiply_add<Grade::fast>(p, w, constant<V>(c[i]))', VALUES),
    M('residual: wrong sign', METHODS, 'return multiply_add<Grade::fast>(residual, half_y, s);',
      'return subtract_product<Grade::fast>(s, residual, half_y);', VALUES),
    M('residual: not fused', METHODS, 'const V residual = subtract_product<Grade::fast>(a, s, s);',
      'const V residual = a - s * s;', VALUES),
    M('residual: y instead of its half', METHODS, 's = residual_step(s, half_y, a)', 's = residual_step(s, y, a)', VALUES),
    M('half: the exponent two lower', SUPPORT, '(std::numeric_limits<NumberOf<V>>::digits - 1)',
      'std::numeric_limits<NumberOf<V>>::digits', VALUES),
    M('Goldschmidt: the half not refined', METHODS, '      h = multiply_add<Grade::fast>(h, r, h);\n', '', VALUES),
    M('Goldschmidt: no residual', METHODS, 'return residual_step(s, h, a);', 'return s;', VALUES),
    M('Goldschmidt: no guard against underflow', METHODS, 'T(0x1p-78)', 'T(0x1p-110)', VALUES),
    M('residual: no guard against overflow', METHODS, 'max() / 2;', 'max();', VALUES, 'sse2'),
    M('Newton: 3/2 instead of 1/2', SUPPORT, 'subtract_product<Grade::fast>(constant<V>(0.5), a * y',
      'subtract_product<Grade::fast>(constant<V>(1.5), a * y', VALUES),
    M('Quake: the halved input subnormal', RECIPROCALS, 'least_normal<T> * 2;', 'least_normal<T> / 2;', VALUES),
    M('Quake: another constant', RECIPROCALS, '0x5F3759DFu', '0x5F375A86u', VALUES),
    M('reciprocal: wrong residual', RECIPROCALS, 'constant<V>(1.0), a, y), y)', 'constant<V>(1.0), a, y), a)', VALUES),
    M('reciprocal: estimates of subnormals', RECIPROCALS, 'T(0.5) / least_normal<T>', 'T(2) / least_normal<T>', SURVEY),
    # Doubles.
    M('double: the bias of another exponent', SUPPORT, 'rest * (1LL << 29)', 'rest * (1LL << 28)', DOUBLES),
    M('double: half an exponent off', METHODS, 'Traits::bits(512ULL << 52)', 'Traits::bits(511ULL << 52)', DOUBLES),
    M('double: an odd bit of the exponent kept', METHODS, 'even = ~((1ULL << 53) - 1)', 'even = ~((1ULL << 52) - 1)', DOUBLES),
    # Special values.
    M('zeros and subnormals let through', SUPPORT, '(size >= V(M::template least<T>))', '(size >= V(T(0)))', VALUES),
    M('negative numbers let through', SUPPORT, '(size >= V(M::template least<T>)) & ', '', VALUES),
    M('reciprocal: the sign not set aside', SUPPORT, 'if constexpr (takes_either_sign<M>) size = abs(a);', '', ARRAYS),
    M('method and hardware swapped', SUPPORT, 'select(meant, M::apply(a), M::exact(a))',
      'select(meant, M::exact(a), M::apply(a))', VALUES),
    M('NaN taken for harmless', SUPPORT, 'keeps_nan = false;  // whether', 'keeps_nan = true;  // whether', VALUES),
    M('block: what is too small let through', LOOPS, 'return all((smallest >= least) & (largest < limit));',
      'return all(largest < limit);', VALUES),
    M('block: infinity let through', LOOPS, '(smallest >= least) & (largest < limit)',
      '(smallest >= least) & (largest <= limit)', VALUES),
    M('block: NaN forgets the least before it', LOOPS, 'smallest = min(a, smallest);', 'smallest = min(smallest, a);', VALUES),
    M('block: NaN forgets the largest before it', LOOPS, 'largest = max(a, largest);', 'largest = max(largest, a);', VALUES),
    M('block: the last register not tested', LOOPS, 'for (int k = 0; k < mix.together; ++k) {',
      'for (int k = 0; k + 1 < mix.together; ++k) {', VALUES),
    M('block: the second group not tested', LOOPS, 'for (int r = 0; r < mix.repeats; ++r)\n      for',
      'for (int r = 0; r < 1; ++r)\n      for', VALUES),
    M('bits: the limit a binade up', LOOPS, 'std::bit_cast<std::uint32_t>(limit) - std::bit_cast<std::uint32_t>(least);',
      'std::bit_cast<std::uint32_t>(limit) - std::bit_cast<std::uint32_t>(least) + 0x00800000u;', VALUES),
    M('bits: the sign alone seen', LOOPS, '((greatest + Bits(sign - span)) | greatest)', 'greatest', VALUES),
    M('bits: only below the limit seen', LOOPS, '((greatest + Bits(sign - span)) | greatest)', '(greatest + Bits(sign - span))', VALUES),
    # Arrays.
    M('lockstep: a factor of its neighbour', TOGETHER, 'subtract_product<grade>(c.part[i], a.part[i], b.part[i])',
      'subtract_product<grade>(c.part[i], a.part[i], b.part[0])', VALUES),
    M('divider: roots in the wrong place', LOOPS, 'beside.part[i].store(y + (mix.together + i)',
      'beside.part[i].store(y + (mix.beside + i)', ARRAYS),
    M('divider: roots of the wrong registers', LOOPS, 'return load(mix.together + i)', 'return load(mix.beside + i)', ARRAYS),
    M('in place: a block made twice', LOOPS, 'roots_of_group<M, T, mix>(x + first).store(y + first);',
      'roots_of_group<M, T, mix>(x + first).store(y + first), roots_of_group<M, T, mix>(x + first).store(y + first);',
      ARRAYS),
    M('the last element left out', LOOPS, 'if (i < n)\n    store_partial', 'if (i + 1 < n)\n    store_partial', ARRAYS),
    M('a register too many at the end', LOOPS, 'for (; i + lanes <= n; i += lanes) careful',
      'for (; i < n; i += lanes) careful', ARRAYS),
    M('one element written too many', LOOPS, 'n - i, T(1))), y + i,\n                               n - i);',
      'n - i, T(1))), y + i,\n                               n - i + 1);', ARRAYS),
    M('four a loop: the last twice', LOOPS, 'y[i + 3] = classic_root_of_one<Steps>(kept_single(x[i + 3]))',
      'y[i + 3] = classic_root_of_one<Steps>(kept_single(x[i + 2]))', VALUES),
    M('arrays of four: the rest one short', LOOPS, 'for (; i < n; ++i) y[i] = classic_root_of_one<Steps>(x[i]);',
      'for (; i + 1 < n; ++i) y[i] = classic_root_of_one<Steps>(x[i]);', ARRAYS),
    # Grades.
    M('grade 2^-22 by the estimate alone', TABLE, 'S::estimate_residual_beside_hardware, S::estimate_residual_beside_hardware',
      'S::estimate_beside_hardware, S::estimate_residual_beside_hardware', GRADES),
    M('grade correctly_rounded by one that is not', TABLE, '{S::goldschmidt_beside_hardware,       S',
      '{S::estimate_two_residuals_beside_hardware,       S', GRADES),
    M('grade of doubles by one step less', TABLE, 'D::hardware,          D::hardware', 'D::hardware,          D::classic_3', DOUBLES),
]
