"""Mutations of the next passage of rays through a surface."""
from mutant import Mutant as M

Q, D, S, PYTHON = 'test_queries', 'test_doubles', 'test_scenes', 'python_passages'
HEADER, SOURCE = 'accel/queries/passages/passages.hpp', 'accel/queries/passages/passages.cpp'
SCENE, FILTERED = 'accel/scene/scene_next.cpp', 'accel/queries/filtered.hpp'
OF_DOUBLES = 'accel/trees/bvh_d.cpp'

MUTANTS = [
    M('passages: only zeros are at edges', HEADER, 'hit.u + hit.v < below_one', 'hit.u + hit.v < 2', Q, '', SOURCE),
    M('passages: hits by u are off edges', HEADER, 'hit.u > 0 && hit.v > 0', 'hit.v > 0', Q, '', SOURCE),
    M('passages: hits that do not cross count', HEADER, 'if (own == sides.end()) return false;',
      'if (own == sides.end()) return true;', Q, '', SOURCE),
    M('passages: glances count', HEADER, 'return is_alone || (sum - before) * own->t > 0;', 'return true;', Q, '',
      SOURCE),
    M('passages: coincident triangles leave each other out', HEADER, 'return is_alone || (sum', 'return (sum', Q, '',
      SOURCE),
    M('passages: all of the side of the sum count', HEADER, '(sum - before) *', 'sum *', Q, '', SOURCE),
    M('passages: of any edge nearby', HEADER, 'if (!(MetEdge<T>(side, others) == edge)) continue;', '', Q, '', SOURCE),
    M('passages: skipped triangles are there', HEADER, 'skips.empty() ? no_primitive : skips[k].primitive',
      'no_primitive', Q, '', SOURCE),
    M('passages: skips are read where hits are', HEADER, 'if (!kept.empty()) rays.skip = options.skip = kept;', '', Q,
      '', SOURCE),
    M('passages: of other tests', SOURCE, '  require_exact(options);\n  return', '  return', Q),
    M('passages: next hits are taken as they are', FILTERED, 'some.hits[k] && may_turn_down(some.hits[k])', 'false', Q,
      '', SOURCE),
    M('passages: doubles take what hits', OF_DOUBLES, 'return closest_passage<double>(*this, ray, options);',
      'return closest(ray, options);', D),
    M('passages: scenes ask rays of the world', SCENE, 'if (!instance.is_identity) {', 'if (false) {', S),
    M('passages: scenes skip in every instance', SCENE, 'skip && skip->instance == hit.instance', 'skip', S),
    M('passages: scenes read skips where hits are', SCENE, 'if (!kept.empty()) by.skip = kept;\n  closest', 'closest',
      S),
    M('passages: python finds what hits', 'python/native/tree_binding.hpp', 'tree.closest_crossing(',
      'tree.closest(', PYTHON, '', 'python/native/tree_classes.cpp'),
]
