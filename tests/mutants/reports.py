"""Mutations of calls that tell how far they are, and of the sizes of their parts."""
from mutant import Mutant as M

TREES, SCENES, PYTHON = 'test_trees', 'test_scenes', 'python_interruption'
PARTS, PLAN, STEPS = 'accel/batch/reported_parts.cpp', 'accel/batch/batch.hpp', 'accel/batch/in_parallel.hpp'
POINTS, LISTS, NEXT = 'accel/queries/closest_points.hpp', 'accel/queries/lists.hpp', 'accel/queries/next.hpp'
OF_POINTS, OF_NEXT = 'accel/queries/closest_points.cpp', 'accel/queries/next.cpp'
LISTENER, TREES_IN_PYTHON = 'python/native/listener.hpp', 'python/native/tree_classes.cpp'

MUTANTS = [
    M('reports: none at the start', PARTS, 'progress(0.0);', '', TREES),
    M('reports: none at the end', PARTS, 'progress(1.0);', '', TREES),
    M('reports: on any thread', PARTS, 'if (std::this_thread::get_id() == caller_) report();', 'report();', TREES),
    M('reports: none between', PARTS, 'if (std::this_thread::get_id() == caller_) report();', '', TREES),
    M('reports: within reports', PARTS, 'isolated([&] { progress_(static_cast<double>(done_) / '
      'static_cast<double>(n_)); });', 'progress_(static_cast<double>(done_) / static_cast<double>(n_));', TREES),
    M('parts: others go on after an exception', PARTS, 'next_ = n_;', '', TREES),
    M('parts: of any time', PARTS, 'std::min(seconds_of_part / each,', 'std::max(seconds_of_part / each,', TREES),
    M('parts: grow at once', PARTS, 'max_growth = 16', 'max_growth = 1000', TREES),
    M('parts: the first one is skipped', PARTS, 'next_{0}', 'next_{1}', TREES),
    M('parts: of other sizes for rounded tests', PLAN, 'return plan.fixed_parts ?', 'return false ?', TREES, '',
      'accel/batch/routing.cpp'),
    M('parts: rounded tests have any', 'accel/queries/nearest.cpp',
      'options.test != TriangleTest::exact && options.mode', 'false && options.mode', TREES),
    M('steps: end too early', STEPS, ': end);', ': begin);', TREES, '', 'accel/queries/signed_distances.cpp'),
    M('steps: begin anew', STEPS, '(before + from * step) / all,', '0.0 * before,', TREES, '',
      'accel/queries/signed_distances.cpp'),
    M('points: masks of the first piece', POINTS, 'batch.active += base / of_mask;', '', TREES, '', OF_POINTS),
    M('points: pieces begin within bytes of masks', POINTS, '+ of_mask - points.count / threads % of_mask', '+ 1',
      TREES, '', OF_POINTS),
    M('points: results at the first piece', POINTS, 'batch.closest += base', 'batch.closest += first', TREES, '',
      OF_POINTS),
    M('points: parts beyond their piece', POINTS, 'count = std::min(piece - within, end - begin);',
      'count = end - begin;', TREES, '', OF_POINTS),
    M('lists: parts of one thread are lost', LISTS, 'if (goes_on) parts.pop_back();',
      'if (goes_on) part.items.clear(), parts.pop_back();', TREES, '', 'accel/queries/lists.cpp'),
    M('pulse: never', 'accel/mesh/pulse.hpp', 'left_ = steps_of_a_look;\n  }', ';\n  }', TREES, '',
      'accel/mesh/closed_mesh.cpp'),
    M('boundary: found without a word', 'accel/queries/windings_of_points.hpp',
      'before_points(options.progress)', 'before_points(nullptr)', TREES, '', 'accel/queries/winding_numbers.cpp'),
    M('filters: every search is reported', 'accel/scene/scene_next.cpp', ', again.progress = nullptr', '', SCENES),
    M('python: signals are not looked at', LISTENER, 'if (PyErr_CheckSignals() != 0) throw', 'if (false) throw', PYTHON,
      '', TREES_IN_PYTHON),
    M('python: only calls with a function listen', LISTENER, '(elements <= few || !is_main_thread())', 'true', PYTHON,
      '', TREES_IN_PYTHON),
]
