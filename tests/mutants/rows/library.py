"""Bounds and guards of the library, its C interface, its Python module and the oracles."""
from mutant import rows_of

MUTANTS = [
    *rows_of('accel/batch/ray_source.hpp', 'test_bvh', source='accel/queries/nearest.cpp', rows=[
        ('queries: overlapping hits', 'if (hits.stride < sizeof(Record) && hits.count > 1)', 'if (false)'),
    ]),
    *rows_of('accel/batch/ray_source.hpp', 'test_doubles', source='accel/trees/bvh_d.cpp', rows=[
        ('doubles: segments that overflow are none', 'halve(ray, to);', '{}'),
    ]),
    *rows_of('accel/builders/sah/triangle_clipper.cpp', 'test_builders', rows=[
        ('clipper: crossings not pushed out', '0x1p-23 * std::fabs(x)', '0.0 * std::fabs(x)'),
    ]),
    *rows_of('accel/c/call.cpp', 'test_c_calls', rows=[
        ('c: null pointers', 'if (pointer == nullptr) refuse', 'if (false) refuse'),
        ('c: null arrays', 'if (first == nullptr) refuse', 'if (false) refuse'),
        ('c: strides of any size', 'if (stride < size)', 'if (stride < 1)'),
        ('c: sizes that overflow', 'count - 1 > (most - size) / stride', 'false'),
    ]),
    *rows_of('accel/c/call.hpp', 'test_c_calls', source='accel/c/trees.cpp', rows=[
        ('c: failed calls leave pointers', '*made = nullptr;', ''),
    ]),
    *rows_of('accel/c/call.hpp', 'test_c_calls', source='accel/c/options.cpp', rows=[
        ('c: enumerators wrap', 'if (index >= count)', 'if (index % 256 >= count)'),
    ]),
    *rows_of('accel/c/options.hpp', 'test_c_calls', source='accel/c/trees.cpp', rows=[
        ('c: earlier options are read beyond their end', 'std::memcpy(static_cast<void*>(&options), given, size);',
         'std::memcpy(static_cast<void*>(&options), given, sizeof options);'),
        ('c: max_count wraps', 'std::min<std::size_t>(c.max_count, std::numeric_limits<std::uint32_t>::max())',
         'c.max_count'),
    ]),
    *rows_of('accel/c/stream.cpp', 'test_c_calls', rows=[
        ('c: loaded bytes have no end', 'to < 0 || to > size', 'true'),
    ]),
    *rows_of('accel/trees/bvh_d_build.cpp', 'test_doubles', rows=[
        ('doubles: frames of thin meshes overflow', 'std::min(-1 - exponent_of_largest(half), 900)',
         '-1 - exponent_of_largest(half)'),
    ]),
    *rows_of('accel/file/bvh_file.cpp', 'test_bvh', rows=[
        ('valid: blocks out of range', 'if (end > is_leaf_.size())', 'if (end > leaf_block_mask)'),
    ]),
    *rows_of('accel/file/tree_file.hpp', 'test_bvh', source='accel/file/bvh_file.cpp', rows=[
        ('valid: corners may be infinite', '[](Bits bits) { return bits < 0; }', '[](Bits bits) { return bits <= 0; }'),
        ('valid: boxes with NaN', 'return std::isfinite(lo) && std::isfinite(hi) && lo <= hi;',
         'return !(lo > hi) && !std::isinf(lo) && !std::isinf(hi);'),
    ]),
    *rows_of('accel/mesh/boundary_tree.cpp', 'test_queries', rows=[
        ('tree: small balls', 'node.radius = spread.radius * (1.0 + 0x1p-30)', 'node.radius = 0.5 * spread.radius'),
        ('tree: small errors', '(full_degree + 1) * over_four_pi * spread.full', '1e-6 * spread.full'),
        ('tree: small errors at low degree', '(low_degree + 1) * over_four_pi * spread.low', '1e-6 * spread.low'),
    ]),
    *rows_of('accel/mesh/mesh.cpp', 'test_bvh', rows=[
        ('mesh: infinite vertices taken', '0x7f7fffffu', '0x7f800000u'),
    ]),
    *rows_of('accel/queries/closest_points.hpp', 'test_trees', source='accel/queries/closest_points.cpp', rows=[
        ('points: pieces begin within bytes of masks', '+ of_mask - points.count / threads % of_mask', '+ 1'),
        ('points: parts beyond their piece', 'count = std::min(piece - within, end - begin);', 'count = end - begin;'),
    ]),
    *rows_of('accel/queries/point_places.cpp', 'test_doubles', rows=[
        ('doubles: t of rows without an error', 'of_t = 0x1p-51', 'of_t = 0.0'),
    ]),
    *rows_of('accel/queries/point_places.cpp', 'test_queries', rows=[
        ('lines: points at crossings too', 'of_t = 0x1p-22', 'of_t = 0.0'),
    ]),
    *rows_of('accel/scene/bounded_tree_arrays.cpp', 'test_scenes', rows=[
        ('boxes: infinite ones are visited', '!std::isfinite(box.lo[axis]) || ', ''),
    ]),
    *rows_of('accel/scene/instance.cpp', 'test_scenes', rows=[
        ('instance: bounds without padding', 'float_below(float_or_infinity(lo - pad))',
         'float_below(float_or_infinity(lo + 0 * pad))'),
        ('instance: singular transforms have inverses', '0x1p-48 * size', '0x1p-99 * size'),
    ]),
    *rows_of('accel/scene/scene_parts.hpp', 'test_scenes', source='accel/scene/triangle_geometry.cpp', rows=[
        ('scene: null pointers to trees', 'if (tree == nullptr) throw', 'if (false) throw'),
    ]),
    *rows_of('accel/scene/sphere_tree.cpp', 'test_scenes', rows=[
        ('spheres: boxes without what tests round', 'sphere_slack = 0x1p-17f', 'sphere_slack = 0.0f'),
    ]),
    *rows_of('bench/support/oracles/winding_sum.cpp', 'test_exact_oracle', rows=[
        ('sum: doubles are trusted too soon', 'det_error = 12 * u', 'det_error = 0.01 * u'),
        ('sum: angles have no error', 'z_error = 56 * u', 'z_error = 0.1 * u'),
    ]),
    *rows_of('dispatch/table/traversal.hpp', 'test_doubles', source='accel/doubles/double_batches.cpp', rows=[
        ('doubles: later runs write where the first does', 'if (hits != nullptr) some.hits += first;', ''),
    ]),
    *rows_of('python/native/filters.hpp', 'python_scene_filters', source='python/native/scene_classes.cpp', rows=[
        ('native: filters without the GIL', 'listener.with_gil([&] {', '([&](auto&& work) { work(); })([&] {'),
    ]),
    *rows_of('python/native/listener.hpp', 'python_sharing', source='python/native/tree_classes.cpp', rows=[
        ('native: queries keep the GIL', 'WithoutGil released;\n    released_ = &released;', ''),
    ]),
    *rows_of('python/native/numpy_arrays.hpp', 'python_arrays', source='python/native/tree_classes.cpp', rows=[
        ('native: strides are ignored', 'count > 1 ? array.strides(0) : at_least', 'at_least'),
    ]),
    *rows_of('python/native/owned.hpp', 'python_memory', source='python/native/module.cpp', rows=[
        ('native: an error of pybind11 for a lack of memory', 'return;\n  std::rethrow', '{}\n  std::rethrow'),
    ]),
    *rows_of('python/native/owned.hpp', 'python_memory', source='python/native/tree_classes.cpp', rows=[
        ('native: two owners of an object that is not registered', 'self.value_ptr() = nullptr;', ''),
    ]),
    *rows_of('python/native/scene_states.hpp', 'python_scene_threads', source='python/native/scene_classes.cpp', rows=[
        ('native scenes: long changes keep the GIL', 'return instances <= 1000 || is_only_thread();', 'return true;'),
    ]),
    *rows_of('python/native/tree_binding.hpp', 'python_processes', source='python/native/tree_classes.cpp', rows=[
        ('native: queries of a tree that is freed', 'const auto state = shared.state;',
         'const auto& state = shared.state;'),
    ]),
    *rows_of('python/native/tree_states.hpp', 'python_copies', source='python/native/tree_classes.cpp', rows=[
        ('native: errors of file objects are lost', "file.exceptions(std::ios_base::badbit);  // Python's errors pass",
         ''),
    ]),
    *rows_of('python/native/tree_states.hpp', 'python_sharing', source='python/native/tree_classes.cpp', rows=[
        ('native: builders keep the GIL', 'listener.without_gil([&]', '[](auto work) { return work(); }([&]'),
    ]),
    *rows_of('python/raylanes/_answer.py', 'python_arrays', rows=[
        ('python: overlap not looked at', 'not any(overlap(out, array) for array in read)', 'True'),
    ]),
    *rows_of('python/raylanes/_answer.py', 'python_out', rows=[
        ('python: elements of out that overlap', 'if step < reach:', 'if step < 0:'),
    ]),
    *rows_of('python/raylanes/_arrays.py', 'python_arrays', rows=[
        ('python: rows that overlap', 'step >= array.shape[1] * array.itemsize', 'True'),
    ]),
    *rows_of('python/raylanes/_scalars.py', 'python_arrays', rows=[
        ('python: integers beyond 32 bits', 'if not -most - 1 <= number <= most:', 'if False:'),
    ]),
    *rows_of('python/raylanes/trimesh/proximity.py', 'python_trimesh', rows=[
        ('python: ties of no width', 'TIE = 2.0**-24', 'TIE = 2.0**-30'),
        ('python: edges taken for insides', 'of_foot * (1 + 2.0**-40)', 'of_foot * 0'),
    ]),
    *rows_of('python/raylanes/trimesh/ties.py', 'python_trimesh', rows=[
        ('python: coplanar triangles by rounding', 'COSINE_SLACK = 2.0**-40', 'COSINE_SLACK = 0'),
    ]),
]
