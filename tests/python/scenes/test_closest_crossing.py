"""The closest crossing of rays and a surface, in trees of both types and in scenes."""

import numpy as np
import pytest

import raylanes
from meshes import cube, lattice
from parts import number_types

kinds = [(raylanes.Bvh, np.float32), (raylanes.Bvh, np.float64), (raylanes.KdTree, np.float32)]

# From the middle by an edge; past the edge at (1, 1) from outside; through a diagonal of two sides.
touching = ([[0, 0, 0], [2, 0, 0], [-3, 0, 0]], [[1, 1, 0], [-1, 1, 0], [1, 0, 0]])


@pytest.mark.parametrize("kind, dtype", kinds)
def test_each_crossing_counts_once(kind, dtype):
    tree, rays = cube(kind, dtype=dtype), raylanes.rays(*touching, dtype=dtype)
    assert tree.closest(rays).t.tolist() == [1, 1, 2]
    entered = tree.closest_crossing(rays)
    assert isinstance(entered, raylanes.Hits) and entered.t.tolist() == [1, np.inf, 2]
    assert tree.closest_crossing(rays, facing="front").t.tolist() == [np.inf, np.inf, 2]
    assert tree.closest_crossing(rays, facing="back").t.tolist() == [1, np.inf, 4]
    for behind in (tree.closest_crossing(rays, after=entered), tree.closest_crossing(rays, skip=entered)):
        assert behind.t.tolist() == [np.inf, np.inf, 4]
    out = np.zeros_like(entered)
    assert tree.closest_crossing(rays, out=out, active=[True, False, True], threads=1) is out
    assert out.t.tolist() == [1, 0, 2]
    assert tree.closest_crossing(rays, after=entered, out=entered) is entered and entered.t[2] == 4
    with pytest.raises(ValueError, match="facing"):
        tree.closest_crossing(rays, facing="side")
    heard = []
    tree.closest_crossing(rays, progress=heard.append)
    assert heard[-1] == 1


@pytest.mark.parametrize("kind, dtype", kinds)
def test_closest_crossings_off_edges_are_the_first_crossings(kind, dtype):
    vertices, faces, rays = lattice(7)
    rays["direction"] += np.random.default_rng(1).uniform(-0.01, 0.01, rays["direction"].shape)
    tree = kind(vertices.astype(dtype), faces, dtype=dtype)
    for facing in ("any", "front", "back"):
        found = tree.closest_crossing(rays, facing=facing)
        for hit, crossings in zip(found, tree.crossings(rays, facing=facing)):
            assert hit["primitive"] == (crossings.primitive[0] if len(crossings) else raylanes.no_primitive)


@pytest.mark.parametrize("dtype", number_types)
def test_closest_crossings_in_scenes(dtype):
    scene, rays = raylanes.Scene(), raylanes.rays(*touching)
    part = scene.add(cube(dtype=dtype))
    scene.place(part, mask=1)
    away = np.eye(4)
    away[0, 3] = 10
    scene.place(part, away, mask=2)
    scene.update()
    entered = scene.closest_crossing(rays)
    assert isinstance(entered, raylanes.SceneHits) and entered.t.tolist() == [1, np.inf, 2]
    assert scene.closest_crossing(rays, facing="back").t.tolist() == [1, np.inf, 4]
    assert scene.closest_crossing(rays, mask=2).t.tolist() == [np.inf, np.inf, 12]
    layers = scene.closest_crossing(rays, after=entered)
    assert layers.t.tolist() == [np.inf, np.inf, 4] and layers.instance[2] == 0
    assert scene.closest_crossing(rays, after=layers).instance[2] == 1
    assert scene.closest_crossing(rays, skip=entered).t.tolist() == [np.inf, np.inf, 4]
    if dtype == np.float64:
        return
    scene.place(scene.add(raylanes.SphereTree([[0, 0, -20]], 1)))
    scene.update()
    with pytest.raises(ValueError, match="triangles alone"):
        scene.closest_crossing(rays)
