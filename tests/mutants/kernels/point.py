"""Mutations of closest points, and of what says whether a mesh is closed."""
from mutant import Mutant as M

TESTS = 'test_points'
TRIANGLE = 'kernels/point/point_triangle.hpp'
BOX = 'kernels/point/box_distance.hpp'
NEAREST = 'kernels/point/nearest_triangle.hpp'
TREE = 'kernels/point/closest_in_tree.hpp'
POINTS = 'kernels/point/point_kernels.cpp'
CLOSED = 'accel/mesh/closed_mesh.cpp'
BATCHES = 'accel/point/closest_points.cpp'

MUTANTS = [
    M('point: beyond the end of an edge', TRIANGLE, 'max(min(t, V(1)), V(0))', 'max(t, V(0))', TESTS),
    M('point: before the begin of an edge', TRIANGLE, 'max(min(t, V(1)), V(0))', 'min(t, V(1))', TESTS),
    M('point: one edge left out', TRIANGLE, 'take(of_bc < best, of_bc, one - r, r);', '', TESTS),
    M('point: the foot beyond an edge', TRIANGLE, '(to_u + to_v <= one) & ', '', TESTS),
    M('point: no foot', TRIANGLE, '(to_u >= zero) & (to_v >= zero)', '(to_u < zero) & (to_v >= zero)', TESTS),
    M('point: weights of the third edge swapped', TRIANGLE, 'of_bc, one - r, r', 'of_bc, r, one - r', TESTS),
    M('point: boxes smaller than they are', BOX, 'magnitude_of(x) * 0x1p-22f + 0x1p-44f',
      '-0.01f', TESTS),
    M('point: units that overflow', BOX, '255u - (exponent == 0 ? 1u : exponent)', '127u', TESTS),
    M('point: a later one of equal distance', NEAREST, 'primitive >= primitive_', 'primitive <= primitive_', TESTS),
    M('point: triangles with equal corners', NEAREST, ' & (h.shortest_squared > V(0.0))', '', TESTS),
    M('point: corners that are not finite', NEAREST, 'h.edges_squared < V(std::numeric_limits<double>::infinity())',
      'h.shortest_squared > V(0.0)', TESTS),
    M('point: floats decide', TREE, 'error_of_floats = 0x1.2p-16f', 'error_of_floats = 0.0f', TESTS),
    M('point: fewer wait than there are', TREE, 'if (count_ > most_waiting - node_lanes) decide(corners);',
      'if (count_ > most_waiting - node_lanes) count_ = 0;', TESTS),
    M('point: those without edges bound others', TREE, ' & (h.shortest_squared > V(0.0f))', '', TESTS),
    M('point: who waits is another one', TREE, 'Words(triangle) + Words::load(numbers)',
      'Words(triangle) + Words::load(numbers) + Words(1u)', TESTS),
    M('point: the bound by neighbours without room', TREE, '(1.0 + 0x1p-8) + room * room * 257.0', '0.5', TESTS),
    M('point: numbers of what is no number', POINTS, '(h.edges_squared < infinity) & ', '', TESTS),
    M('point: answers in the order of cells', TREE, 'batch.closest[i] = points', 'batch.closest[k] = points', TESTS),
    M('closed: -0 apart from 0', CLOSED, "bits == 0x80000000u ? 0u : bits", 'bits', TESTS),
    M('closed: the same x and y will do', CLOSED, ' || keys[i].lo >> 32 != keys[first].lo >> 32', '', TESTS),
    M('closed: directions no matter', CLOSED, 'count == 2 && forward == 1', 'count == 2', TESTS),
    M('closed: an open edge called inconsistent', CLOSED, 'count % 2 != 0 ', 'count % 2 > 1 ', TESTS),
    M('closed: triangles with equal corners have edges', CLOSED, '++report_.degenerate;\n        continue;',
      '++report_.degenerate;', TESTS),
]
