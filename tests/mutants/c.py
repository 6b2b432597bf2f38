"""Mutations of the C interface."""
from mutant import Mutant as M

TESTS = 'test_c_calls'
CALL, CALLS = 'accel/c/call.cpp', 'accel/c/tree_calls.hpp'
OPTIONS, DEFAULTS = 'accel/c/options.hpp', 'accel/c/options.cpp'
SHARED, STREAM, ARRAYS = 'accel/c/call.hpp', 'accel/c/stream.cpp', 'accel/c/arrays.cpp'
FLOATS, DOUBLES = 'accel/c/bvh.cpp', 'accel/c/bvhd.cpp'

MUTANTS = [
    M('c: memory that runs out is a failure', CALL, 'RAYLANES_OUT_OF_MEMORY,', 'RAYLANES_FAILED,', TESTS),
    M('c: system errors are bad files', CALL, 'const std::system_error& error', 'const std::ios_base::failure& error',
      TESTS),
    M('c: messages of all threads', CALL, 'thread_local char', 'char', TESTS),
    M('c: null pointers', CALL, 'if (pointer == nullptr) refuse', 'if (false) refuse', TESTS),
    M('c: null arrays', CALL, 'if (first == nullptr) refuse', 'if (false) refuse', TESTS),
    M('c: strides of any size', CALL, 'if (stride < size)', 'if (stride < 1)', TESTS),
    M('c: dense arrays have a stride of 0', CALL, 'if (stride == 0) stride = size;', 'if (stride == 0) return 0;',
      TESTS),
    M('c: sizes that overflow', CALL, 'count - 1 > (most - size) / stride', 'false', TESTS),
    M('c: any alignment', CALL, '% alignment != 0', '% 1 != 0', TESTS),
    M('c: enumerators wrap', SHARED, 'if (index >= count)', 'if (index % 256 >= count)', TESTS, source=DEFAULTS),
    M('c: failed calls leave pointers', SHARED, '*made = nullptr;', '', TESTS, source=FLOATS),
    M('c: sizes of options in any bytes', DEFAULTS, 'size % 8 != 0', 'false', TESTS),
    M('c: options of later versions', DEFAULTS, 'size > known', 'false', TESTS),
    M('c: the size of options is not written', DEFAULTS,
      'std::memcpy(static_cast<void*>(options), &size, sizeof size);', '', TESTS),
    M('c: earlier options are read beyond their end', OPTIONS,
      'std::memcpy(static_cast<void*>(&options), given, size);',
      'std::memcpy(static_cast<void*>(&options), given, sizeof options);', TESTS, source=FLOATS),
    M('c: one thread', OPTIONS, 'options.path = path_of(c.path);\n  options.threads = c.threads;\n  options.facing',
      'options.path = path_of(c.path);\n  options.threads = 1;\n  options.facing', TESTS, source=FLOATS),
    M('c: skip without a stride', OPTIONS, 'c.skip_stride, sizeof(std::uint32_t))', '0, sizeof(std::uint32_t))', TESTS,
      source=DOUBLES),
    M('c: max_count wraps', OPTIONS, 'std::min<std::size_t>(c.max_count, std::numeric_limits<std::uint32_t>::max())',
      'c.max_count', TESTS, source=FLOATS),
    M('c: accuracy unread', OPTIONS, 'options.accuracy = c.accuracy;', ';', TESTS, source=DOUBLES),
    M('c: saved trees end a byte early', STREAM, 'std::min(n, capacity_ - size_)', 'std::min(n, capacity_ - size_ - 1)',
      TESTS),
    M('c: saved trees go on behind the buffer', STREAM, 'std::min(n, capacity_ - size_)', 'n', TESTS),
    M('c: loaded bytes have no end', STREAM, 'to < 0 || to > size', 'true', TESTS),
    M('c: buffers that are too small', CALLS, 'if (*size > capacity)', 'if (false)', TESTS, source=FLOATS),
    M('c: options of one ray unread', CALLS, 'found.set(0, tree_of(tree).closest(one, ', 'found.set(0, tree_of(tree).'
      'closest(one)), static_cast<void>((', TESTS, source=DOUBLES),
    M('c: refits by one thread', CALLS, 'triangle_stride), threads);', 'triangle_stride), 1);', TESTS, source=FLOATS),
    M('c: any index of a path', ARRAYS, 'if (index >= paths().size())', 'if (index > paths().size())', TESTS),
    M('c: paths that are not undone', ARRAYS, 'unforce_path();', ';', TESTS),
]
