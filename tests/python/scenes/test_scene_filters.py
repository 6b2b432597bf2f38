"""Filters of hits in scenes, which are functions in Python."""

import threading

import numpy as np
import pytest

import raylanes
from meshes import cube, random_rays
from parts import Parts, nearest


@pytest.fixture(scope="module")
def parts():
    return Parts(0)


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
    assert indices.tolist() == np.flatnonzero(before.hit).tolist() and hits.tobytes() == before[before.hit].tobytes()
    out = np.ones(70, raylanes.scene_hit_dtype)
    scene.closest(parts.rays, filter=lambda indices, hits: np.ones(len(hits), bool), active=active, out=out)
    assert (out[~active] == np.ones(1, out.dtype)).all() and (out["instance"][active] == raylanes.no_part).all()


def test_filters_may_use_the_scene():
    """A query within a query; a change is that of later queries."""
    scene, rays = raylanes.Scene(), random_rays(1, 500)
    scene.place(scene.add(cube()))
    scene.update()
    first = scene.closest(rays)
    behind = scene.next(rays, first)

    def changes(indices, hits):
        assert scene.closest(rays).tobytes() == first.tobytes()
        scene.set_mask(0, 0)
        assert not scene.closest(rays).hit.any()
        scene.set_mask(0, 1)
        return hits.t == first.t[indices]

    found = scene.closest(rays, filter=changes)
    later = np.where(behind.t > first.t, behind, scene.next(rays, behind))
    assert found.tobytes() == later.view(found.dtype).tobytes() and found.hit.any()


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
    with pytest.raises(ValueError, match="next hits and filters take the test exact alone"):
        ask(parts.rays, filter=by_parity, test="watertight")
    scene.add(raylanes.SphereTree([[0, 0, 0]], 1))
    with pytest.raises(ValueError, match="geometry 3 has other primitives"):
        ask(parts.rays, filter=by_parity)
    assert parts.scene().closest(parts.rays).hit.any()
