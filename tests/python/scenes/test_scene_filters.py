"""Filters of hits in trees and scenes, which are functions in Python."""

import threading

import numpy as np
import pytest

import raylanes
from meshes import cube, lattice, random_rays
from parts import Parts, nearest, number_types


@pytest.fixture(scope="module", params=number_types)
def parts(request):
    return Parts(0, dtype=request.param)


def is_rejected(index, hit):
    return (hit[3] + index) % 3 != 0


def by_parity(indices, hits):
    return (hits.primitive + indices) % 3 != 0


@pytest.mark.parametrize("threads", [1, 2])
def test_hits_are_the_first_ones_that_are_not_rejected(parts, threads):
    scene = parts.scene()
    for mask in (0xFFFFFFFF, 0b101):
        kept = [[hit for hit in of_ray if not is_rejected(i, hit)] for i, of_ray in enumerate(parts.hits(mask))]
        assert 10 < sum(map(bool, kept)) < sum(map(bool, parts.hits(mask)))
        found = scene.closest(parts.rays, filter=by_parity, mask=mask, threads=threads)
        assert [hit.item() for hit in found] == nearest(kept)
        dark = scene.occluded(parts.rays, filter=by_parity, mask=mask, threads=threads)
        assert dark.tolist() == [bool(hits) for hits in kept]
    back = [[hit for hit in of_ray if not is_rejected(i, hit)] for i, of_ray in enumerate(parts.hits(facing="back"))]
    assert [hit.item() for hit in scene.closest(parts.rays, filter=by_parity, facing="back")] == nearest(back)
    grid = scene.closest(parts.rays.reshape(7, 10), filter=by_parity)
    assert grid.shape == (7, 10) and grid.tobytes() == scene.closest(parts.rays, filter=by_parity).tobytes()


def test_filters_get_indices_and_hits_on_the_calling_thread(parts):
    scene, calls = parts.scene(), []

    def keep_all(indices, hits):
        calls.append((indices, hits, threading.get_ident()))
        return np.zeros(len(indices), bool)

    active = np.arange(70) % 2 == 0
    before = scene.closest(parts.rays, active=active)
    found = scene.closest(parts.rays, filter=keep_all, active=active, threads=2)
    assert found.tobytes() == before.tobytes() and len(calls) == 1
    indices, hits, thread = calls[0]
    assert thread == threading.get_ident() and isinstance(hits, raylanes.SceneHits)
    assert indices.tolist() == np.flatnonzero(before.hit).tolist() and np.array_equal(hits, before[before.hit])
    out = np.ones(70, before.dtype)
    scene.closest(parts.rays, filter=lambda indices, hits: np.ones(len(hits), bool), active=active, out=out)
    assert (out[~active] == np.ones(1, out.dtype)).all() and (out["instance"][active] == raylanes.no_part).all()


@pytest.mark.parametrize("dtype", number_types)
def test_filters_may_use_the_scene(dtype):
    """A query within a query; a change is that of later queries."""
    scene, rays = raylanes.Scene(), random_rays(1, 500)
    scene.place(scene.add(cube(dtype=dtype)))
    scene.update()
    first = scene.closest(rays)
    behind = scene.closest(rays, after=first)

    def changes(indices, hits):
        assert scene.closest(rays).tobytes() == first.tobytes()
        scene.set_mask(0, 0), scene.update()
        assert not scene.closest(rays).hit.any()
        scene.set_mask(0, 1), scene.update()
        return hits.t == first.t[indices]

    found = scene.closest(rays, filter=changes)
    later = np.where(behind.t > first.t, behind, scene.closest(rays, after=behind))
    assert np.array_equal(found, later.astype(found.dtype)) and found.hit.any()


@pytest.mark.parametrize("query", ["closest", "occluded"])
def test_errors_of_filters_pass(parts, query):
    scene = parts.scene()
    ask = getattr(scene, query)

    def fails(indices, hits):
        raise ZeroDivisionError("of the filter")

    with pytest.raises(ZeroDivisionError, match="^of the filter$"):
        ask(parts.rays, filter=fails)
    wrong = [(TypeError, "^filter: a function is needed, not int$", 3),
             (TypeError, "^filter: it must return booleans, not float64$", lambda indices, hits: np.zeros(len(hits))),
             (TypeError, "^filter: it must return booleans, not object$", lambda indices, hits: None),
             (ValueError, r"^filter: it must return the shape \(\d+,\), not \(1,\)$", lambda indices, hits: [True])]
    for error, sentence, function in wrong:
        with pytest.raises(error, match=sentence):
            ask(parts.rays, filter=function)
    with pytest.raises(ValueError, match="(take the test exact|has .exact.) alone"):
        ask(parts.rays, filter=by_parity, test="watertight")
    assert parts.scene().closest(parts.rays).hit.any()


def kept_of(layers, index):
    """The first hit of a ray that by_parity() keeps, or a miss."""
    return next((hit.item() for hit in layers if not is_rejected(index, hit)), None)


@pytest.mark.parametrize("kind, dtype", [(raylanes.Bvh, np.float32), (raylanes.Bvh, np.float64),
                                         (raylanes.KdTree, np.float32)])
def test_trees_take_filters_in_every_query(kind, dtype):
    vertices, faces, rays = lattice(7)
    tree = kind(vertices.astype(dtype), faces, dtype=dtype)
    kept = [kept_of(layers, i) for i, layers in enumerate(tree.all_hits(rays))]
    nearest_hits = tree.closest(rays)
    assert any(hit is not None and hit != first.item() for hit, first in zip(kept, nearest_hits))
    for threads in (1, 2):
        found = tree.closest(rays, filter=by_parity, threads=threads)
        assert [hit.item() if hit.hit else None for hit in found] == kept
        assert tree.occluded(rays, filter=by_parity, threads=threads).tolist() == [hit is not None for hit in kept]
    later = tree.closest(rays, after=nearest_hits, filter=by_parity)
    assert [hit.item() if hit.hit else None for hit in later] == [
        kept_of(layers[1:], i) for i, layers in enumerate(tree.all_hits(rays))]
    points = rays["origin"] + 2 * rays["direction"]
    segments = raylanes.rays(points, points[0] - points, tmax=1, dtype=dtype)
    dark = tree.occluded_from(points[0], points, filter=by_parity)
    assert dark.tolist() == tree.occluded(segments, filter=by_parity).tolist() and dark.any()
    sun = tree.occluded_towards(points[1], points, filter=by_parity)
    assert sun.tolist() == tree.occluded(raylanes.rays(points, points[1], dtype=dtype), filter=by_parity).tolist()
    with pytest.raises(TypeError, match="^filter: a function is needed, not str$"):
        tree.closest(rays, filter="all")


def test_spheres_have_two_hits_and_take_filters():
    spheres = raylanes.SphereTree([[0, 0, 0], [0, 0, 0], [0, 0, -5]], [1, 2, 1])
    ray = raylanes.rays(np.float32([[0, 0, 5]]), np.float32([[0, 0, -1]]))
    peeled, hits = [], spheres.closest(ray)
    while hits.hit[0]:
        peeled.append((float(hits.t[0]), int(hits.primitive[0])))
        assert spheres.closest(ray, after=hits, out=hits) is hits
    assert peeled == [(3, 1), (4, 0), (6, 0), (7, 1), (9, 2), (11, 2)]
    scene = raylanes.Scene()
    scene.place(scene.add(spheres))
    scene.update()
    for traced in (spheres, scene):
        assert traced.closest(ray, filter=lambda indices, hits: hits.t < 7).t.tolist() == [7]
        assert traced.occluded(ray, filter=lambda indices, hits: hits.primitive < 2).tolist() == [True]
        assert traced.occluded_from([0, 0, 5], [[0, 0, 0], [0, 0, 2.5]]).tolist() == [True, False]
        assert traced.occluded_from([0, 0, 5], [[0, 0, 0], [0, 0, -9]],
                                    filter=lambda indices, hits: hits.primitive < 2).tolist() == [False, True]
        assert traced.occluded_towards([0, 0, 5], [[0, 0, 0], [0, 0, 2.5]]).tolist() == [True, False]
        assert traced.closest(ray, after=traced.closest(ray)).t.tolist() == [4]
