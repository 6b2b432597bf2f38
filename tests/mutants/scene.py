"""Mutations of scenes: transforms, bounds of instances, the order of hits, trees over boxes and spheres."""
from mutant import Mutant as M

S = 'test_scenes'
INSTANCE, TRACE, VISITS = 'accel/scene/instance.cpp', 'accel/scene/scene_trace.cpp', 'accel/scene/visits.cpp'
BOXES, SPHERES, SCENE = 'accel/scene/box_tree.cpp', 'accel/scene/sphere_tree.cpp', 'accel/scene/scene.cpp'

MUTANTS = [
    M('instance: the inverse transposed', INSTANCE, 'cofactor(j, i) / determinant', 'cofactor(i, j) / determinant', S),
    M('instance: no translation', INSTANCE, 'lo = static_cast<double>(row[3])', 'lo = 0.0 * static_cast<double>(row[3])',
      S),
    M('instance: bounds without padding', INSTANCE, 'float_below(static_cast<float>(lo - pad))',
      'float_below(static_cast<float>(lo + 0 * pad))', S),
    M('instance: rays far away are not rounded', INSTANCE, 'largest_row * reach * of_origin * 1.0001', '0.0 * reach', S),
    M('instance: singular transforms have inverses', INSTANCE, '0x1p-48 * size', '0x1p-99 * size', S),
    M('instance: beyond the largest float', INSTANCE, 'return is_visited(bounds.box) ? bounds : none;', 'return bounds;', S),
    M('scene: of equal t any instance', TRACE, 'hit.t == best.t && number < best.instance', 'false', S),
    M('scene: of equal t the last instance', TRACE, 'hit.t == best.t && number < best.instance',
      'hit.t == best.t && number > best.instance', S),
    M('scene: rays end at hits', TRACE, 'std::min(tmax_[rays[k]], tmax_behind(hit.t))', 'hit.t', S),
    M('scene: masks of instances alone', TRACE, '(instance.mask & query_.mask) != 0', 'instance.mask != 0', S),
    M('scene: rays of other instances', TRACE, 'mapped[k] = batch_.rays[rays[k]]', 'mapped[k] = batch_.rays[k]', S),
    M('scene: spheres see shortened rays', TRACE, 'if (std::holds_alternative<Spheres>(geometry)) {',
      'if (false) {', S),
    M('scene: changes go unnoticed', SCENE, 'if (!scene.is_current)', 'if (false)', S),
    M('scene: no share of origins', SCENE, 'share = std::max(share, bounds.share);', '', S),
    M('visits: rays end at hits', VISITS, 'tmax_behind(batch.hits[i].t)', 'batch.hits[i].t * 0.999f', S),
    M('boxes: large leaves lose some', BOXES, 'begin += most_, ++slot', 'begin += most_ + 1, ++slot', S),
    M('boxes: infinite ones are visited', BOXES, '!std::isfinite(box.lo[axis]) || ', '', S),
    M('spheres: no slack', SPHERES, 'sphere_slack = 0x1p-17f', 'sphere_slack = 0.0f', S),
    M('spheres: numbers of leaves', SPHERES, 'hit.primitive = leaf.primitives[hit.primitive];',
      'hit.primitive = leaf.primitives[0];', S),
]
