"""Mutations of single rays on paths with FMA: one fused operation for each plane, and children sorted in a register."""
from mutant import Mutant as M

TESTS, X = 'test_bvh', 'test_exact'
RAY, WALK = 'kernels/traverse/fused/fused_ray.hpp', 'kernels/traverse/fused/fused_walk.hpp'
LEAVES, NUMBERS = 'kernels/traverse/fused/fused_leaves.hpp', 'kernels/traverse/fused/hit_numbers.hpp'
CALLS = 'accel/queries/nearest.cpp'

MUTANTS = [
    M('fused: boxes not padded', RAY, 'pad = 0x1p-21f', 'pad = 0.0f', X),
    M('fused: boxes padded inwards', RAY, 'put(minus_near, fused(-padding,',
      'put(minus_near, fused(padding,', TESTS),
    M('fused: boxes of rounded tests not padded', RAY, 'Floats<4>(slab_pad), padding)', 'Floats<4>(0.0f), padding)',
      TESTS),
    M('fused: zeros of directions divide', RAY, 'min_component = 0x1p-60f', 'min_component = 0.0f', TESTS),
    M('fused: any tmin', RAY, 'checked = blend<8>(size, o)', 'checked = blend<8>(size, abs(o))', TESTS),
    M('fused: any tmax', RAY, 'limit = blend<8>(Floats<4>(max_coordinate), d)', 'limit(max_coordinate)', TESTS),
    M('fused: any origin', RAY, 'max_coordinate = 0x1p60f', 'max_coordinate = 0x1p127f', TESTS),
    M('fused: any size of a direction', RAY, '|| greatest - least > most - least', '', TESTS),
    M('fused: entries of -0', RAY, 'max(NodeFloats(ray.tmin), NodeFloats(0.0f))',
      'NodeFloats(ray.tmin)', TESTS),
    M('fused: an octant for its mirror', RAY, 'bits(divisor < zero)', 'bits(zero < divisor)', TESTS),
    M('fused: open boxes', WALK, 'mask(in <= out)', 'mask(in < out)', TESTS),
    M('fused: of two children the second is lost', WALK, '      ++size;\n', '', TESTS),
    M('fused: of many children one is lost', WALK, 'size += static_cast<std::size_t>(std::popcount(hit.but_first()));',
      'size += static_cast<std::size_t>(std::popcount(hit.but_first())) - 1;', TESTS),
    M('fused: of many children the wrong one goes on', WALK, 'return node.child[nearest];',
      'return node.child[std::countr_zero(hit.lanes)];', TESTS),
    M('fused: subtrees at equal distance dropped', WALK, 'while (t_[size] > tmax)', 'while (t_[size] >= tmax)', TESTS),
    M('fused, any: children lost', WALK, 'reference_[size++] = node.child[last];',
      'reference_[size] = node.child[last];', TESTS),
    M('fused: sure before tmin', LEAVES, 'from > ray_.tmin && to', 'to > ray_.tmin && to', X),
    M('fused: sure though bounds overlap', LEAVES, 'to < query.t_lo)', 'from < query.t_lo)', X),
    M('fused: all behind tmin dropped', LEAVES, 'if (from > query.tmax ||', 'if (from > ray_.tmin ||', X),
    M('fused: undecided triangles are hit', LEAVES, '(inside >> lane & 1u) != 0 && ', '', X),
    M('fused: unclear triangles are missed', LEAVES, 'unclear |= 1u << lane;', 'unclear |= 0u;', X),
    M('fused: doubles leave out what is hit', NUMBERS, '(low_ > largest)', '(low_ < largest)', X),
    M('fused: doubles without bounds behind', NUMBERS, 'four_floats(1.0f, 1.0f, tmax, 0.0f)',
      'four_floats(0.5f, 1.0f, tmax, 0.0f)', X),
    M('fused, any: sure before tmin', LEAVES, '& (t.t_lo > tmin) &', '& (t.t_hi > tmin) &', X),
    M('fused: numbers without bounds', NUMBERS, 'to_four_floats(number - bound)', 'to_four_floats(number + bound)', X),
    M('fused: numbers that are not clear', NUMBERS, '== high_) & 7u) == 7u', '== high_) & 7u) != 8u', TESTS),
    M('fused: zeros of other weights', NUMBERS, 'from_bits(weights >> 1)', 'from_bits(weights)', X),
    M('fused: weights of any sign', NUMBERS, '(on_positive == 7u || on_negative == 7u)', 'true', X),
    M('fused: of equal t the last one', NUMBERS, '(!is_first && is_lower && t', '(!is_first && t', X),
    M('fused: later hits of a lower primitive dropped', NUMBERS, '!is_lower && numbers.is_behind',
      'numbers.is_behind', X),
    M('calls: counters forgotten', CALLS, 'options.counters == nullptr &&', '', TESTS),
    M('calls: another path forgotten', CALLS, 'checked_path(options.path));\n  const CallRow',
      'path_in_use());\n  const CallRow', TESTS),
    M('calls: hits to go on behind forgotten', CALLS, 'options.after.first == nullptr &&', '', 'test_queries'),
    M('calls: wrong modes taken', CALLS, 'options.mode == TraversalMode::automatic &&', '', TESTS),
    M('calls: a tree of before its refit', 'accel/bvh_refit.cpp', '    make_ready();\n', '', TESTS),
]
