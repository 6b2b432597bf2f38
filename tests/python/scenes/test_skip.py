"""Primitives that rays skip: the hits and crossings that are left without those of one primitive."""

import numpy as np
import pytest

import raylanes
from meshes import cube, lattice
from parts import number_types

kinds = [(raylanes.Bvh, np.float32), (raylanes.Bvh, np.float64), (raylanes.KdTree, np.float32)]


def left_over(tree, rays, skip):
    """For each ray its first hit that is not of the skipped primitive."""
    expected = np.zeros(len(rays), tree.closest(rays).dtype)
    expected["t"], expected["primitive"] = np.inf, raylanes.no_primitive
    for i, layers in enumerate(tree.all_hits(rays)):
        others = layers[layers.primitive != skip[i]]
        if len(others):
            expected[i] = others[0]
    return expected


@pytest.mark.parametrize("kind, dtype", kinds)
def test_skip_leaves_out_one_triangle_in_every_query(kind, dtype):
    vertices, faces, rays = lattice(7)
    tree = kind(vertices.astype(dtype), faces, dtype=dtype)
    hits = tree.closest(rays)
    expected = left_over(tree, rays, hits.primitive)
    assert (expected["t"] != hits.t).any()
    for skip in (hits, hits.primitive, hits.primitive.astype(np.int64), tree.closest(rays, after=None)):
        found = tree.closest(rays, skip=skip)
        assert (np.asarray(found) == expected).all()
        assert (tree.occluded(rays, skip=skip) == (expected["primitive"] != raylanes.no_primitive)).all()
    for of_ray, without in ((tree.all_hits(rays), tree.all_hits(rays, skip=hits)),
                            (tree.crossings(rays), tree.crossings(rays, skip=hits))):
        for i, (layers, left) in enumerate(zip(of_ray, without)):
            assert (np.asarray(layers[layers.primitive != hits.primitive[i]]) == np.asarray(left)).all()
    counts = tree.count_crossings(rays, skip=hits)
    assert [len(left) for left in tree.crossings(rays, skip=hits)] == counts["crossings"].tolist()
    behind = tree.closest(rays, after=tree.closest(rays, skip=hits), skip=hits)
    assert not (behind.primitive == hits.primitive)[behind.hit].any()


def test_a_point_does_not_shadow_itself():
    tree = cube()
    below, beside = [0.1, 0.2, -1], [0.1, 0.2, -1.5]
    assert tree.occluded_from([0.1, 0.2, 0], [below, beside]).tolist() == [True, True]
    own = tree.closest_points(np.array([below, below])).primitive
    assert tree.occluded_from([0.1, 0.2, 0], [below, below], skip=own).tolist() == [False, False]
    assert tree.occluded_from([0.1, 0.2, 0], [below], end=0.999).tolist() == [False]


@pytest.mark.parametrize("dtype", number_types)
def test_skip_in_scenes_names_an_instance(dtype):
    scene = raylanes.Scene()
    part = scene.add(cube(dtype=dtype))
    scene.place(part)
    away = np.eye(4)
    away[2, 3] = -5
    scene.place(part, away)
    scene.update()
    rays = raylanes.rays([[0.1, 0.2, 5]], [0, 0, -1])
    hits = scene.closest(rays)
    second = scene.closest(rays, skip=hits)
    assert (hits.instance[0], hits.t[0], second.instance[0], second.t[0]) == (0, 4, 0, 6)
    other = hits.copy()
    other["instance"] = 1
    assert scene.closest(rays, skip=other).t[0] == 4
    for named in (hits.astype(raylanes.scene_hit_dtype), scene.crossings(rays, max_count=1).items):
        assert scene.closest(rays, skip=named).t[0] == 6
    for wrong in (hits.primitive, cube(dtype=dtype).closest(rays)):
        with pytest.raises(TypeError, match="^skip: records that name a primitive and an instance are needed, not "):
            scene.closest(rays, skip=wrong)
    if dtype == np.float64:
        return
    scene.place(scene.add(raylanes.SphereTree([[0, 0, -20]], 1)))
    scene.update()
    below = raylanes.rays([[0, 0, -19]], [0, 0, -1])
    on_ball = scene.closest(below)
    # A skipped sphere keeps the hit at which the ray leaves it.
    assert on_ball.instance[0] == 2 and on_ball.t[0] == 0 and scene.closest(below, skip=on_ball).t[0] == 2
    above = raylanes.rays([[0, 0, -19]], [0, 0, 1], tmax=1)
    assert scene.occluded(above).tolist() == [True] and scene.occluded(above, skip=on_ball).tolist() == [False]


def test_skip_of_spheres():
    spheres = raylanes.SphereTree([[0, 0, 0], [0, 0, -5]], 1)
    rays = raylanes.rays([[0, 0, 1]], [0, 0, -1])
    assert spheres.closest(rays).t[0] == 0 and spheres.closest(rays, skip=[0]).t[0] == 2
    assert spheres.occluded(rays, skip=[1]).tolist() == [True]


@pytest.mark.parametrize("dtype", (np.float32, np.float64))
def test_skip_is_refused(dtype):
    tree = cube(dtype=dtype)
    rays = raylanes.rays(np.zeros((3, 3)), [0, 0, -1])
    with pytest.raises(ValueError, match="skip"):
        tree.closest(rays, skip=[0, 1])
    with pytest.raises(ValueError, match="skip"):
        tree.crossings(rays, skip=[0, 1])
    with pytest.raises(ValueError, match="skip"):
        tree.closest(rays, skip=[-1, 0, 0])
    with pytest.raises(TypeError, match="skip"):
        tree.closest(rays, skip=[0.5, 1, 2])
    if dtype is np.float32:
        with pytest.raises(ValueError, match="skip"):
            tree.closest(rays, skip=[0, 0, 0], test="watertight")
