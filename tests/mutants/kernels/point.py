"""Mutations of closest points, and of what says whether a mesh is closed."""
from mutant import Mutant as M

TESTS = 'test_points'
TRIANGLE = 'kernels/point/point_triangle.hpp'
BOX = 'kernels/point/box_distance.hpp'
NEAREST = 'kernels/point/nearest_triangle.hpp'
NEAR = 'kernels/point/near_triangles.hpp'
FLOATS = 'kernels/point/float_points.hpp'
PACKET = 'kernels/point/packet_in_tree.hpp'
TREE = 'kernels/point/closest_in_tree.hpp'
POINTS = 'kernels/point/point_kernels.cpp'
CLOSED, EDGES = 'accel/mesh/closed_mesh.cpp', 'accel/mesh/shared_edges.hpp'
BATCHES = 'accel/queries/closest_points.cpp'

FAR = 'kernels/point/far_point.hpp'

MUTANTS = [
    M('far: triangles are not below their corners', FAR, 'V(0.25f * half_inverse_)', 'V(0.0f * half_inverse_)', TESTS),
    M('far: seen from the other side', FAR, 'V(half_inverse_), -share_[axis])',
      'V(half_inverse_), share_[axis])', TESTS),
    M('far: numbers are exact', FAR, '0x1p-18 + 0x1p-42 * most', '0.0', TESTS),
    M('far: boxes by their first planes', FAR, 'term(min(max(point_[axis], lo), hi), axis)', 'term(lo, axis)', TESTS),
    M('far: any distance is too far', FAR, '(max_squared * squared_scale - square)',
      '(max_squared * squared_scale)', TESTS),
    M('point: beyond the end of an edge', TRIANGLE, 'max(min(t, V(1)), V(0))', 'max(t, V(0))', TESTS),
    M('point: before the begin of an edge', TRIANGLE, 'max(min(t, V(1)), V(0))', 'min(t, V(1))', TESTS),
    M('point: one edge left out', TRIANGLE, 'best = min(of_bc, best);', '', TESTS),
    M('point: the foot beyond an edge', TRIANGLE, ' & (to_u + to_v <= one)', '', TESTS),
    M('point: no foot', TRIANGLE, '(to_u >= zero) & (to_v >= zero)', '(to_u < zero) & (to_v >= zero)', TESTS),
    M('point: weights of the third edge swapped', TRIANGLE, 'best, one - r, r', 'best, r, one - r', TESTS),
    M('point: boxes smaller than they are', BOX, 'magnitude_of(x) * 0x1p-22f + 0x1p-44f',
      '-0.01f', TESTS),
    M('point: units that overflow', BOX, '255u - (exponent == 0 ? 1u : exponent)', '127u', TESTS),
    M('point: a later one of equal distance', NEAREST, 'primitive >= primitive_', 'primitive <= primitive_', TESTS),
    M('point: triangles with equal corners', NEAREST, '(edges.shortest_squared > V(0.0)) &',
      '(edges.shortest_squared >= V(0.0)) &', TESTS),
    M('point: corners that are not finite', NEAREST, 'edges.edges_squared < V(std::numeric_limits<double>::infinity())',
      'edges.shortest_squared > V(0.0)', TESTS),
    M('point: floats decide', FLOATS, 'error_of_floats = 0x1.2p-16f', 'error_of_floats = 0.0f', TESTS),
    M('point: fewer wait than there are', NEAR, 'if (count_ > max_waiting - node_lanes) decide(corners);',
      'if (count_ > max_waiting - node_lanes) count_ = 0;', TESTS),
    M('point: those without edges bound others', NEAR, ' & (shortest_squared > V(0.0f))', '', TESTS),
    M('point: who waits is another one', NEAR, 'Words(triangle) + Words::load(numbers)',
      'Words(triangle) + Words::load(numbers) + Words(1u)', TESTS),
    M('point: the bound by neighbours without room', TREE, '(1.0 + 0x1p-8) + room * room * 257.0', '0.5', TESTS),
    M('point: numbers of what is no number', POINTS, '(edges.edges_squared < infinity) & ', '', TESTS),
    M('point: answers in the order of cells', TREE, 'points.take(point, i, packet, batch)',
      'points.take(point, k, packet, batch)', TESTS),
    M('point: pairs are of the first point', NEAREST, 'nearest[point[lane]]', 'nearest[point[0]]', TESTS),
    M('point: the second of those that are decided together is the first', NEAR,
      'Decided(corners.number(k, triangle[lane]))', 'Decided(corners.number(k, triangle[0]))', TESTS),
    M('point, calls: the most distance forgotten', BATCHES, 'double{options.max_distance}, closest);\n  return',
      'double{3e38f}, closest);\n  return', TESTS),
    M('point, calls: counters forgotten', BATCHES, ' && options.counters == nullptr;', ';', TESTS),
    M('point, calls: another path forgotten', BATCHES, 'options.path == nullptr && ', '', TESTS),
    M('point, calls: any number of threads', BATCHES, 'options.threads == 1 && ', '', TESTS),
    M('packet: the box is not around all points', FLOATS, 'x > box.hi[axis] ?', 'x > box.hi[axis] + 1 ?', TESTS),
    M('packet: boxes farther from its points', PACKET, 'square <= limit_[r]', 'square <= V(0.5f) * limit_[r]', TESTS),
    M('packet: boxes smaller than they are', PACKET,
      'V pad = multiply_add<Grade::reproducible>(abs(x), V(0x1p-22f), V(0x1p-44f));', 'V pad(-0.01f);', TESTS),
    M('packet: how far it reaches is one register', PACKET, 'most = max(most, limit_[r])', 'most = most', TESTS),
    M('packet: those without edges bound others', PACKET, 'counts & (edges.shortest_squared > T(0.0f))', 'counts',
      TESTS),
    M('packet: fewer wait than there are', PACKET, ') make_room(corners);', ') count_ = 0;', TESTS),
    M('packet: who waits is dropped', PACKET, '<= limit[point_[i]] ? 1 : 0', '< 0.999f * limit[point_[i]] ? 1 : 0',
      TESTS),
    M('packet: who waits is another one', PACKET, 'Words names = Words(triangle)',
      'Words names = Words(triangle + 1)',
      TESTS),
    M('packet: the bound by neighbours without room', TREE, 'V(1.0f + 0x1p-7f), V(512.0f * room * room)',
      'V(0.5f), V(0.0f)', TESTS),
    M('point: what is flushed from points that were found', FLOATS, 'flushed_from_found = 0x1p-125f',
      'flushed_from_found = 0.0f', TESTS),
    M('packet: the last one is forgotten', TREE, 'if (packet.size > 0) points.answer(packet, batch.closest);', '',
      TESTS),
    M('packet: alone, always', TREE, '!is_first_ && packet.size', 'false && packet.size', TESTS),
    M('closed: -0 apart from 0', EDGES, 'bits == minus_zero ? 0 : bits', 'bits', TESTS, source=CLOSED),
    M('closed: the same x and y will do', EDGES, 'return position(before) == at;',
      'return position(before)[0] == at[0] && position(before)[1] == at[1];', TESTS, source=CLOSED),
    M('closed: doubled triangles counted at each edge', CLOSED, 'if (third > static_cast<std::uint32_t>(side.hi))', '',
      TESTS),
    M('closed: copies in another order unseen', CLOSED, 'std::sort(thirds_.begin(), thirds_.end());', '', TESTS),
    M('closed: directions no matter', CLOSED, 'count == 2 && forward == 1', 'count == 2', TESTS),
    M('closed: an open edge called inconsistent', CLOSED, 'count % 2 != 0 ', 'count % 2 > 1 ', TESTS),
    M('closed: triangles with equal corners have edges', EDGES, '++degenerate;\n      continue;', '++degenerate;',
      TESTS, source=CLOSED),
]
