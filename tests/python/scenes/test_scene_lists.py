"""All hits, crossings and stretches in scenes, beside the lists of each instance's own tree."""

import numpy as np
import pytest

import raylanes
from meshes import cube, lattice
from parts import number_types

away = np.float32([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0]])


def scene_and_parts(dtype=np.float32):
    """A scene, and (instance, mask, tree, shift of its rays): cubes in the common tree and out of it, and a lattice."""
    vertices, faces, rays = lattice(3)
    faces = faces[[len(set(face)) == 3 for face in faces.tolist()]]
    cubes, grid = cube(dtype=dtype), raylanes.Bvh(vertices, faces, dtype=dtype)
    scene = raylanes.Scene()
    parts = []
    for tree, transform, mask in ((cubes, None, 1), (grid, None, 2), (cubes, away, 3), (cubes, None, 4)):
        number = scene.place(scene.add(tree), transform, mask=mask)
        parts.append((number, mask, tree, 0 if transform is None else 3))
    scene.set_moving(parts[3][0])
    scene.update()
    random = np.random.default_rng(5)
    origins = random.integers(-3, 6, (200, 3))
    directions = random.integers(-2, 3, (200, 3)) * 0.5 + [0, 0, 0.25]
    rays = np.concatenate([rays, raylanes.rays(origins, directions, dtype=np.float32)])
    return scene, parts, raylanes.rays(rays["origin"], rays["direction"], rays["tmin"], rays["tmax"], dtype=dtype)


def expected(parts, rays, mask, list_of, place):
    """Of each ray (place, instance, primitive, …) of all parts' lists, in order."""
    rows = [[] for _ in rays]
    for instance, bits, tree, shift in parts:
        if not bits & mask:
            continue
        moved = rays.copy()
        moved["origin"][:, 0] -= shift
        for row, items in zip(rows, list_of(tree, moved)):
            row += [(item[place], instance, *item.tolist()[1:]) for item in items]
    return [sorted(row) for row in rows]


def found(lists, place):
    return [[(item[place], item["instance"], *item.tolist()[1:-2]) for item in items] for items in lists]


@pytest.mark.parametrize("mask", [0xFFFFFFFF, 2, 5])
@pytest.mark.parametrize("facing", ["any", "front", "back"])
@pytest.mark.parametrize("dtype", number_types)
def test_lists_are_those_of_all_instances(mask, facing, dtype):
    scene, parts, rays = scene_and_parts(dtype)
    hits = scene.all_hits(rays, mask=mask, facing=facing)
    assert isinstance(hits.items, raylanes.SceneHits) and len(hits.items) > 100
    # In the order of t, instance, primitive.
    wanted = expected(parts, rays, mask, lambda tree, moved: tree.all_hits(moved, facing=facing), "t")
    order = [sorted(row, key=lambda item: (item[0], item[1], item[4])) for row in wanted]
    assert found(hits, "t") == order
    crossings = scene.crossings(rays, mask=mask, facing=facing)
    assert isinstance(crossings.items, raylanes.SceneCrossings)
    wanted = expected(parts, rays, mask, lambda tree, moved: tree.crossings(moved, facing=facing), "t")
    assert found(crossings, "t") == wanted
    counts = scene.count_crossings(rays, mask=mask, facing=facing)
    assert counts["crossings"].tolist() == crossings.counts.tolist()
    assert counts["winding"].tolist() == [items.side.sum() for items in crossings]
    few = scene.all_hits(rays, mask=mask, facing=facing, max_count=2)
    assert [items.tolist() for items in few] == [items[:2].tolist() for items in hits]
    assert hits.positions(rays).shape == (len(hits.items), 3)
    geometry = scene.geometry_of(crossings.items.instance)
    assert geometry.tolist() == crossings.items.geometry.tolist()


@pytest.mark.parametrize("dtype", number_types)
def test_stretches_name_their_instance(dtype):
    scene, parts, rays = scene_and_parts(dtype)
    within = scene.stretches(rays, mask=5)
    assert isinstance(within.items, raylanes.SceneStretches) and len(within.items) > 50
    wanted = expected(parts, rays, 5, lambda tree, moved: tree.stretches(moved), "entry")
    assert [sorted(row) for row in found(within, "entry")] == wanted
    for call in (scene.stretches, scene.crossings, scene.all_hits):
        heard = []
        call(rays, progress=heard.append)
        assert heard[-1] == 1
    first = within.items[0]
    assert isinstance(first, raylanes.SceneStretch) and first.instance == within.items["instance"][0]


@pytest.mark.parametrize("dtype", number_types)
def test_active_and_skipped_rays(dtype):
    scene, _, rays = scene_and_parts(dtype)
    hits = scene.all_hits(rays)
    nearest = scene.closest(rays)
    assert [items.tolist() for items in scene.all_hits(rays, skip=nearest)] == [items.tolist()[1:] for items in hits]
    active = np.arange(len(rays)) % 2 == 0
    some = scene.all_hits(rays, active=active)
    assert some.counts.tolist() == np.where(active, hits.counts, 0).tolist()
    out = np.full(len(rays), np.array((7, 7), raylanes.count_dtype))
    assert scene.count_crossings(rays, active=active, out=out) is out
    assert (out[~active]["crossings"] == 7).all() and (out[active] == scene.count_crossings(rays)[active]).all()


def test_refusals():
    scene, _, rays = scene_and_parts()
    with pytest.raises(ValueError, match="one dimension"):
        scene.all_hits(rays.reshape(1, -1))
    with pytest.raises(TypeError, match="skip"):
        scene.crossings(rays, skip=np.zeros(len(rays), np.uint32))
    with pytest.raises(ValueError, match="facing"):
        scene.all_hits(rays, facing="side")
    with pytest.raises((TypeError, ValueError), match="mask"):
        scene.stretches(rays, mask=-1)
    scene.place(scene.add(raylanes.SphereTree([[0, 0, 0]], 1.0)))
    with pytest.raises(RuntimeError, match="update"):
        scene.all_hits(rays)
    scene.update()
    assert len(scene.all_hits(rays).items) > 0
    for call in (scene.crossings, scene.stretches, scene.count_crossings):
        with pytest.raises(ValueError):
            call(rays)
