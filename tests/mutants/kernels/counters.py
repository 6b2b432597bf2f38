"""Mutations of what walks count."""
from mutant import Mutant as M

T = 'test_bvh'
POLICY = 'kernels/traverse/counters.hpp'
SINGLE, EACH = 'kernels/traverse/single.hpp', 'kernels/traverse/one_by_one.hpp'
STREAM, PACKET = 'kernels/traverse/stream.hpp', 'kernels/traverse/packet/packet.hpp'
AT_LEAVES = 'kernels/traverse/packet/packet_leaves.hpp'
GROUPS = 'kernels/traverse/packet/packet_groups.hpp'
HITS = 'kernels/traverse/stream_leaves.hpp'
ROWS, QUERIES, TRACE = 'kernels/traverse/traversal.cpp', 'accel/queries/nearest.cpp', 'accel/batch/routing.cpp'

MUTANTS = [
    M('policy: the highest lane is not counted', POLICY, 'for (; lanes != 0;', 'for (; (lanes & (lanes - 1)) != 0;', T),
    M('policy: full registers alone', POLICY, 'static_cast<std::uint64_t>(registers)', 'lanes == 0xffu ? 1u : 0u', T),
    M('single: empty slots are tests', SINGLE, 'counters.boxes(node.occupied,', 'counters.boxes(0xffu,', T),
    M('single: unused lanes are tests', EACH, 'static_cast<std::size_t>(size - first)', 'std::size_t{node_lanes}', T),
    M('single: nodes are not counted', SINGLE, 'counters.node(), ', '', T),
    M('stream: registers are full', STREAM, 'counters().boxes(first_lanes<stream_lanes>(size))',
      'counters().boxes(first_lanes<stream_lanes>(stream_lanes))', T),
    M('stream: few rays cost nothing', STREAM, 'Counters cost = counters();\n    for (std::uint32_t k',
      'TraceCounters lost;\n    TraceBatch other;\n    other.counters = &lost;\n    Counters cost(other);\n'
      '    for (std::uint32_t k', T),
    M('stream: hits are not counted', HITS, 'counters().hits(bits(certain)), ', '', T),
    M('packet: a group is one ray', GROUPS, 'counters().triangles(groups_.going[g])', 'counters().triangles(1u)', T),
    M('packet: frusta of nodes cost nothing', PACKET, 'counters().frusta(node.occupied, tree_width / node_lanes)',
      'counters().boxes(node.occupied, tree_width / node_lanes)', T),
    M('packet: cones hit nothing', AT_LEAVES, 'counters().hits(filtered.certain);\n    take_certain',
      'take_certain', T),
    M('modes: streams are not counted', ROWS, 'closest_stream<Test, Counters>', 'closest_stream<Test, NoCounters>', T),
    M('queries: nothing is counted', QUERIES, 'modes_ = counts ?', 'modes_ = counts && false ?', T),
    M('queries: a ray alone is not counted', QUERIES, 'batch.hits = &hit, batch.counters = options.counters',
      'batch.hits = &hit, batch.counters = new TraceCounters', T),
    M('threads: the last one is right', 'accel/batch/batch.hpp', '*plan.counters += counters;',
      '*plan.counters = counters;', T,
      source=TRACE),
    M('threads: more than there are', 'accel/batch/threads/by_tbb.cpp', 'return threads > most ? most : threads;',
      'return threads;', 'test_scenes'),
    M('threads: all of the processor inside of an arena', 'accel/batch/threads/by_tbb.cpp',
      'return tbb::this_task_arena::max_concurrency();', 'return most;', 'test_scenes'),
    M('threads: work in an arena of its own when all are asked for', 'accel/batch/threads/by_tbb.cpp',
      'if (threads == 0)\n    all', 'if (threads < 0)\n    all', 'test_scenes'),
    M('threads: parts lose their last element', 'accel/batch/threads/by_tbb.cpp', 'work(part.begin(), part.end());',
      'work(part.begin(), part.end() - 1);', T),
    M('shared end: any miss', 'kernels/traverse/packet/shared_apex.hpp',
      '(apex_offset <= reach * V(largest_offset)) &', '', T),
    M('state: candidates end no segment', 'kernels/ray/ray_state.hpp',
      'this->tmax = select(lanes, t_hi, this->tmax);', '', T),
]
