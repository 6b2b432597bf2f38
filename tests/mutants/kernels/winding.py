"""Mutations of winding numbers: kernels, loops of the boundary, moments, and what queries make of them."""
from mutant import Mutant as M

Q = 'test_queries'
KERNELS, ANGLE = 'kernels/winding/winding_kernels.cpp', 'kernels/winding/solid_angle.hpp'
ARCTANGENT, EXPANSION = 'kernels/winding/arctangent.hpp', 'kernels/winding/expansion.hpp'
LOOP = 'kernels/exact/boundary_loop.cpp'
BOUNDARY, TREE, MOMENTS = 'accel/mesh/boundary.cpp', 'accel/mesh/boundary_tree.cpp', 'accel/mesh/harmonic_moments.cpp'
NUMBERS, PLACES = 'accel/queries/winding_numbers.cpp', 'accel/queries/point_places.hpp'

MUTANTS = [
    M('expand: caps that the ray may cross', KERNELS, 'active & passed_by & fits', 'active & fits', Q),
    M('expand: whatever the error', KERNELS, '(V(node.full_error) <= allowed * over_full)', '(radius >= V(0.0))', Q),
    M('expand: errors do not add up', KERNELS, 'spent_ = spent_ + select(accepted, error, V(0.0));', '', Q),
    M('expand: too few terms', KERNELS, 'accepted & ~(error <= allowed)', 'accepted & (error < V(0.0))', Q),
    M('expand: lanes go on in their nodes', KERNELS, 'resume_ = select(accepted, V(node.next), resume_);', '', Q),
    M('expand: axes as they lie', KERNELS, 'axis == 0 ? 2 : axis == 1 ? 1 : 0', '0', Q),
    M('loops: doubtful lanes count', KERNELS, 'active & ~doubtful', 'active', Q),
    M('loops: seen along the ray', KERNELS, 'V sign(-batch_.sign)', 'V sign(batch_.sign)', Q),
    M('loops: not closed', KERNELS, 'see(corners[loop.count - 1], a);', 'see(corners[0], a);', Q),
    M('angle: turns upwards do not count', ANGLE, 'was_up & z_is_up & ~is_up', 'was_up & z_is_up & ~z_is_up', Q),
    M('angle: turns downwards do not count', ANGLE, 'is_up & ~was_up & ~z_is_up', 'is_up & ~is_up & ~z_is_up', Q),
    M('angle: turns of loops are forgotten', ANGLE, 'turns_ = turns_ + select(lanes, other.turns_, V(0.0));', '', Q),
    M('arctangent: few terms', ARCTANGENT, 'int n = 19', 'int n = 3', Q),
    M('arctangent: steep angles as flat ones', ARCTANGENT, 'select(y > x, V(0.5 * pi) - angle, angle)', 'angle', Q),
    M('expansion: an order for its square', EXPANSION, '(n - 1) * (n - 1) - m * m', '(n - 1) * (n - 1) - m', Q),
    M('loop: always along the ray', LOOP, 'ray.distance > near', 'ray.distance > near - 2.0', Q),
    M('loop: rounded products', LOOP, 'if (rest != 0.0) parts', 'if (rest != rest) parts', Q),
    M('loop: a line through the point behind it', LOOP, 'const Vector middle = toward_line(loop, a);',
      'const Vector middle = times(toward_line(loop, a), -1.0);', Q),
    M('loop: a line along the ray behind it', LOOP, 'loop.axis == 0 ? 1 : 0, -1.0)', 'loop.axis == 0 ? 1 : 0, 1.0)', Q),
    M('loop: triangles at the point are not crossed', LOOP, 'along_e.holds_origin ? crossing_at_point(triangle, e)',
      'along_e.holds_origin ? 0', Q),
    M('loop: edges at the point decide nothing', LOOP, 'if (is_zero(loop_.normal(q, r)) &&', 'if (false &&', Q),
    M('loop: edges at the point turn the other way', LOOP, 'loop_.corners[r]) != -side',
      'loop_.corners[r]) == -side', Q),
    M('loop: sums of unit vectors', LOOP, 'times(a, one_and_cosine) + Reproducible::cross(normal, a)', 'a + b', Q),
    M('loop: an edge along the ray turns the other way', LOOP, 'return -along *', 'return along *', Q),
    M('boundary: each edge once', BOUNDARY, 'edges.end(), forward - backward,',
      'edges.end(), forward > backward ? 1 : 0,', Q),
    M('boundary: in one direction', BOUNDARY, 'std::swap(low, high), std::swap(forward, backward)',
      'std::swap(forward, backward)', Q),
    M('boundary: parts without their chord', BOUNDARY, 'rest.push_back(loop.front());', '', Q),
    M('tree: small balls', TREE, 'node.radius = spread.radius * (1.0 + 0x1p-30)', 'node.radius = 0.5 * spread.radius',
      Q),
    M('tree: small errors', TREE, '(full_degree + 1) * over_four_pi * spread.full', '1e-6 * spread.full', Q),
    M('tree: small errors at low degree', TREE, '(low_degree + 1) * over_four_pi * spread.low', '1e-6 * spread.low', Q),
    M('moments: of children where they are', TREE, 'moments.add(of_child, shift);', 'moments.add(of_child, {});', Q),
    M('moments: signs of opposite orders', MOMENTS, 'm % 2 == 0 ? std::conj', 'm % 2 != 0 ? std::conj', Q),
    M('moments: shares of points', MOMENTS, '(155.0 - root) / 1200.0', '(155.0 + root) / 1200.0', Q),
    M('numbers: crossings at the point whole', NUMBERS, 'crossing.v != 0.0f ? 0.5 : 1.0', '1.0', Q),
    M('numbers: points that are not finite', NUMBERS, 'if (is_finite(at))', 'if (true)', Q),
    M('numbers: rays to the other side', NUMBERS, 'side % 2 == 0 ? -1.0 : 1.0', 'side % 2 == 0 ? 1.0 : -1.0', Q),
    M('numbers: any accuracy', NUMBERS, 'if (!(options.accuracy >= 0.0))', 'if (false)', Q),
    M('inside: coarse numbers decide', NUMBERS, 'std::fabs(number - 0.5) > accuracy + rounding', 'true', Q),
    M('inside: from a quarter on', NUMBERS, 'number >= 0.5 ? Location::inside', 'number >= 0.25 ? Location::inside', Q),
    M('numbers: the boundary of the mesh before', 'accel/bvh.cpp', 'tree_->boundary.reset();', '', Q),
]
