"""Masks of triangles: what a call sees, and about which triangles its filter is asked."""

import numpy as np
import pytest

import raylanes
from meshes import lattice, same

NO_PRIMITIVE = 0xFFFFFFFF
kinds = [(raylanes.Bvh, np.float32), (raylanes.KdTree, np.float32), (raylanes.Bvh, np.float64)]
words = np.arange(36, dtype=np.uint32) % 4  # the last four triangles have none
seen = np.append((words & 2) != 0, [True] * 4)
asked = np.append((words & 1) != 0, [True] * 4)


@pytest.fixture(params=kinds, ids=lambda kind: f"{kind[0].__name__} of {kind[1].__name__}")
def world(request):
    vertices, faces, rays = lattice(5)
    kind, dtype = request.param
    tree = kind(vertices, faces, dtype=dtype)
    return tree, raylanes.rays(rays["origin"].astype(dtype), rays["direction"].astype(dtype))


def firsts(lists):
    return np.array([part.primitive[0] if len(part) else NO_PRIMITIVE for part in lists])


def test_calls_see_some_triangles(world):
    tree, rays = world
    by = {"mask": 2, "masks": words}
    every, some = tree.all_hits(rays), tree.all_hits(rays, **by)
    assert any(len(part) for part in some)
    for all_of_ray, of_ray in zip(every, some):
        assert np.array_equal(of_ray, all_of_ray[seen[all_of_ray.primitive]])
    hits = tree.closest(rays, **by)
    assert np.array_equal(hits.primitive, firsts(some))
    assert np.array_equal(tree.occluded(rays, **by), hits.hit)
    assert not np.array_equal(hits.primitive, tree.closest(rays).primitive)
    crossings = tree.crossings(rays, **by)
    assert all(seen[part.primitive].all() for part in crossings)
    assert np.array_equal(tree.count_crossings(rays, **by)["crossings"], crossings.counts)
    entered = tree.closest_crossing(rays, **by)
    assert seen[entered.primitive[entered.hit]].all() and entered.hit.any()
    assert tree.stretches(rays, **by).counts.shape == rays.shape
    light = np.array([0.1, 3.0, 0.2])
    back = np.subtract(light, rays["origin"])
    assert np.array_equal(tree.occluded_from(light, rays["origin"], **by),
                          tree.occluded(origins=rays["origin"], directions=back, tmax=1, **by))
    assert np.array_equal(tree.occluded_towards([0, 1, 0], rays["origin"], **by),
                          tree.occluded(origins=rays["origin"], directions=[0, 1, 0], **by))
    assert same(tree.closest(rays, mask=2), tree.closest(rays))  # goes with masks


def test_filters_are_asked_about_some_triangles(world):
    tree, rays = world
    of_calls = []

    def reject(indices, hits):
        of_calls.append(hits.primitive)
        return np.ones(len(hits), bool)

    by = {"masks": words, "mask": 3, "filter_mask": 1, "filter": reject}
    hits = tree.closest(rays, **by)
    assert asked[np.concatenate(of_calls)].all()
    there = np.append(words != 0, [True] * 4)
    wanted = firsts([part[(there & ~asked)[part.primitive]] for part in tree.all_hits(rays)])
    assert np.array_equal(hits.primitive, wanted) and hits.hit.any()
    assert np.array_equal(tree.occluded(rays, **by), hits.hit)


@pytest.mark.parametrize("wrong, word", [
    ({"masks": words.astype(float)}, "masks"), ({"masks": [[1, 2]]}, "shape"), ({"masks": [-1]}, "range"),
    ({"masks": words, "mask": -1}, "mask"), ({"masks": words, "filter_mask": 1 << 32}, "filter_mask")])
def test_wrong_masks(wrong, word):
    vertices, faces, rays = lattice(5)
    with pytest.raises((TypeError, ValueError), match=word):
        raylanes.Bvh(vertices, faces).closest(rays, **wrong)
