"""Scenes in scenes: hits are as in one scene with the same parts; names and ways go through all levels."""

import copy
import pickle

import numpy as np
import pytest

import raylanes
from meshes import cube, cube_faces, cube_vertices, random_rays
from parts import number_types

rays = random_rays(3, 600, reach=6)
typed = pytest.mark.parametrize("dtype", number_types)


def moved_by(x, y=0, z=0):
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z]]


def wheel(dtype):
    """A sphere, or where there is none a box."""
    return raylanes.SphereTree([[0, 0, 0]], 0.5) if dtype == np.float32 else raylanes.Bvh(
        cube_vertices * np.float32(0.5), cube_faces, dtype=dtype)


def carriage(dtype=np.float32):
    scene = raylanes.Scene()
    scene.place(scene.add(cube(dtype=dtype)), name="body")
    scene.place(scene.add(wheel(dtype)), [moved_by(-1, 0, -1), moved_by(1, 0, -1)],
                mask=[0b01, 0b10], name=["left", "right"])
    return scene


def train(dtype):
    scene = raylanes.Scene()
    part = scene.add(carriage(dtype))
    return scene, part, scene.place(part, [moved_by(0), moved_by(3)], mask=[0b11, 0b01], name=["first", ""])


@typed
def test_placed_scenes_are_numbered_named_and_found(dtype):
    scene, part, placed = train(dtype)
    assert part == 0 and placed.tolist() == [0, 4] and (scene.geometry_count, scene.instance_count) == (3, 8)
    assert scene.geometry_of(range(8)).tolist() == [0, 1, 2, 2] * 2
    assert scene.mask_of(range(8)).tolist() == [3, 3, 1, 2, 1, 1, 1, 0]
    assert scene.transform_of([6, 7])[:, 0, 3].tolist() == [2, 4]
    assert scene.name_of(range(8)).tolist() == ["first", "body", "left", "right", "", "body", "left", "right"]
    assert scene.instances_named("left").tolist() == [2, 6]
    assert scene.levels_of(6).tolist() == [[4, 0], [1, 1]]
    none = raylanes.no_part
    assert scene.levels_of([[4, 5, none]]).tolist() == [[[[4, 0], [none, none]], [[4, 0], [0, 0]], [[none, none]] * 2]]
    assert scene.levels_of([]).shape == (0, 1, 2)
    assert scene.place(part, np.zeros((0, 3, 4))).shape == (0,) and scene.place(part) == 8
    with pytest.raises(IndexError, match="^scene: there is no instance 12, it has 12$"):
        scene.levels_of([0, 12])


@typed
def test_hits_are_those_of_the_same_parts_in_one_scene(dtype):
    scene, _, _ = train(dtype)
    outer = raylanes.Scene()
    assert outer.place(outer.add(scene), np.diag([1, -1, 2, 1])) == 0
    flat = raylanes.Scene()
    parts = {1: flat.add(cube(dtype=dtype)), 2: flat.add(wheel(dtype))}
    number = [1 + i for i in range(8) if i % 4 != 0]
    for i in number:
        flat.place(parts[scene.geometry_of(i - 1)], outer.transform_of(i), mask=scene.mask_of(i - 1))
    outer.update()
    flat.update()
    for mask in (0xFFFFFFFF, 0b01, 0b10):
        hits, expected = outer.closest(rays, mask=mask), flat.closest(rays, mask=mask)
        assert (hits.t == expected.t).all() and (hits.primitive == expected.primitive).all() and hits.hit.any()
        assert (hits.instance[hits.hit] == np.array(number)[expected.instance[hits.hit]]).all()
        assert (outer.levels_of(hits.instance)[hits.hit, 0] == [0, 0]).all()
    assert set(outer.name_of(hits.instance)) == {"", "body", "right"}  # of the first carriage


@typed
def test_scenes_change_and_are_copied_as_a_whole(dtype):
    scene, part, (first, second) = train(dtype)
    scene.update()
    before = scene.closest(rays).tobytes()
    for change in (lambda: scene.move([0, 1], moved_by(9)), lambda: scene.set_mask([4, 6], 0),
                   lambda: scene.set_moving([0, 3])):
        with pytest.raises(ValueError, match="instance [136] is part of the scene that instance [04] places"):
            change()
    with pytest.raises(TypeError, match="not Scene$"):
        scene.replace(part, carriage())
    with pytest.raises(ValueError, match="geometry 0 is a scene"):
        scene.replace(part, cube(dtype=dtype))
    assert scene.closest(rays).tobytes() == before
    for again in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        again.update()
        assert again.closest(rays).tobytes() == before
        assert again.place(part) == 8 and again.name_of(9) == "body"
    scene.move(second, moved_by(0, 3))
    scene.set_mask([first, second], [0, 0b10])
    scene.update()
    assert scene.transform_of(5)[1, 3] == 3 and scene.mask_of(range(8)).tolist() == [0, 0, 0, 0, 2, 2, 0, 2]
    assert set(scene.closest(rays).instance) <= {5, 7, raylanes.no_part}


@typed
def test_a_scene_may_be_added_to_itself(dtype):
    scene = carriage(dtype)
    assert scene.add(scene) == 2 and scene.place(2, moved_by(0, 4)) == 3
    assert scene.name_of(range(7)).tolist() == ["body", "left", "right", "", "body", "left", "right"]
    assert scene.levels_of(5).tolist() == [[3, 2], [1, 1]]
    scene.update()
    assert scene.closest(raylanes.rays([0.1, 4.1, 9], [0, 0, -1])).instance == 4
