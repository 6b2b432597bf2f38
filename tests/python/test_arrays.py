"""Layouts and types of arrays, and where answers go."""

import pickle

import numpy as np
import pytest

import raylanes
from meshes import cube, cube_faces, cube_vertices, random_rays, sphere
from raylanes._answer import overlap
from raylanes._arrays import FLOATS, faces_of, ray_rows, rows


@pytest.fixture(scope="module")
def tree():
    return raylanes.Bvh(*sphere(triangles=500))


def layouts(array):
    """The same numbers, otherwise laid out; whether the library reads them where they are."""
    wide = np.full((len(array), array.shape[1] + 2), 7, array.dtype)
    wide[:, 1:-1] = array
    frozen = array.copy()
    frozen.flags.writeable = False
    twice = np.repeat(array, 2, axis=0)
    yield array, True
    yield wide[:, 1:-1], True
    yield twice[::2], True
    yield frozen, True
    yield np.asfortranarray(array), False
    yield array[::-1].copy()[::-1], False
    yield np.repeat(array, 2, axis=1)[:, ::2], False
    yield array.astype(array.dtype.newbyteorder()), False


def test_layouts_of_meshes():
    vertices, faces = sphere(triangles=300)
    rays = random_rays(1, 300)
    expected = raylanes.Bvh(vertices, faces).closest(rays)
    for laid, in_place in layouts(vertices):
        assert np.shares_memory(rows("vertices", laid, 3, np.float32)[0], laid) == in_place
        assert raylanes.Bvh(laid, faces).closest(rays).tobytes() == expected.tobytes()
    for laid, in_place in layouts(faces):
        assert np.shares_memory(faces_of(laid), laid) == in_place
        assert raylanes.KdTree(vertices, laid).closest(rays).tobytes() == expected.tobytes()
    for dtype in (np.uint8, np.uint32, np.int16, np.int64, np.uint64):
        few = np.array(cube_faces, dtype)
        assert raylanes.Bvh(cube_vertices, few).report()["triangles"] == 12
    of_lists = raylanes.Bvh(vertices.tolist(), faces.tolist(), dtype=np.float32)
    assert of_lists.closest(rays).tobytes() == expected.tobytes()


def test_layouts_of_rays(tree):
    rays = random_rays(2, 200)
    expected = tree.closest(rays).tobytes()
    for laid, in_place in layouts(rays.view(np.float32).reshape(-1, 8)):
        assert np.shares_memory(ray_rows(laid, FLOATS)[0], laid) == in_place
        assert tree.closest(laid).tobytes() == expected
    six = np.concatenate([rays["origin"], rays["direction"]], axis=1)
    assert tree.closest(six).tobytes() == tree.closest(six.astype(np.float64)).tobytes() == expected
    apart = np.zeros(200, [("name", "i2"), ("ray", raylanes.ray_dtype), ("more", "f8")])
    apart["ray"] = rays  # neither aligned nor side by side
    assert np.shares_memory(ray_rows(apart["ray"], FLOATS)[0], apart)
    assert tree.closest(apart["ray"]).tobytes() == expected
    table = rays.reshape(10, 20)
    for other in (rays[::-1][::-1], table, np.asfortranarray(table), rays.reshape(2, 5, 20)):
        found = tree.closest(other)
        assert found.shape == other.shape and found.tobytes() == expected
    assert tree.closest(rays[3]).shape == () and tree.closest(rays[3]) == tree.closest(rays)[3]
    assert tree.closest(six[3]).shape == tree.closest(rays[3:3]).shape[1:] == ()
    assert isinstance(tree.occluded(rays[3]), np.bool_) and tree.closest([]).shape == (0,)


def test_shapes_of_points(tree):
    points = random_rays(3, 60)["origin"]
    flat = tree.closest_points(points)
    assert tree.closest_points(points.reshape(3, 20, 3)).tobytes() == flat.tobytes()
    assert tree.closest_points(points.astype(np.float64)[::-1])[::-1].tobytes() == flat.tobytes()
    assert tree.closest_points(points[0]).shape == () and tree.signed_distances(points[0]).shape == ()
    assert tree.locate(np.zeros((0, 4, 3))).shape == (0, 4)


def test_doubles_are_rounded_and_overflow_is_infinite(tree):
    doubles = np.random.default_rng(4).uniform(-2, 2, (100, 6))
    with np.errstate(over="raise"):
        assert tree.closest(doubles).tobytes() == tree.closest(doubles.astype(np.float32)).tobytes()
    doubles[0] = 1e39
    with pytest.warns(RuntimeWarning, match="overflow"):
        assert not tree.closest(doubles).hit[0]
    with pytest.warns(RuntimeWarning), pytest.raises(ValueError, match="vertex 0: coordinate x is -inf"):
        raylanes.Bvh(cube_vertices.astype(np.float64) * 1e39, cube_faces, dtype=np.float32)


def test_rays_are_broadcast():
    made = raylanes.rays(np.zeros(3), np.ones((4, 5, 3)), tmax=np.arange(5))
    assert made.shape == (4, 5) and (made["tmax"] == np.arange(5)).all() and (made["tmin"] == 0).all()
    assert raylanes.rays([0, 0, 0], [1, 2, 3]).shape == ()


def test_answers_go_where_they_are_wanted(tree):
    rays, points = random_rays(5, 300), random_rays(6, 300)["origin"]
    for ask, of, dtype in [(tree.closest, rays, raylanes.hit_dtype), (tree.occluded, rays, bool),
                           (tree.count_crossings, rays, raylanes.count_dtype), (tree.locate, points, np.uint8),
                           (tree.closest_points, points, raylanes.closest_point_dtype),
                           (tree.winding_numbers, points, np.float32),
                           (tree.signed_distances, points, np.float32)]:
        expected = ask(of)
        for out in (np.zeros(300, dtype), np.zeros(900, dtype)[::3], np.zeros(300, dtype)[::-1],
                    np.zeros((300, 2), dtype)[:, 0]):
            assert ask(of, out=out) is out and out.tobytes() == expected.tobytes()
        mask = np.arange(300) % 3 == 0
        out = np.ones(300, dtype)
        ask(of, out=out, active=mask)
        assert out[mask].tobytes() == expected[mask].tobytes() and (out[~mask] == np.ones(1, dtype)).all()
        assert ask(of, active=mask)[mask].tobytes() == expected[mask].tobytes()
        frozen = np.zeros(300, dtype)
        frozen.flags.writeable = False
        for out in (frozen, np.zeros(299, dtype), np.zeros((300, 1), dtype)):
            with pytest.raises(ValueError, match="^out: "):
                ask(of, out=out)
        for out in (np.zeros(300, "f2"), np.zeros(300, np.dtype(dtype).newbyteorder()), [0] * 300):
            if not isinstance(out, np.ndarray) or out.dtype != dtype:  # a byte has no order
                with pytest.raises(TypeError, match="^out: "):
                    ask(of, out=out)
        with pytest.raises(ValueError, match="^active: "):
            ask(of, active=mask[1:])
        with pytest.raises(TypeError, match="^active: "):
            ask(of, active=mask.astype(int))
    assert not tree.closest(rays, active=np.zeros(300, bool)).hit.any()


def test_answers_may_lie_among_what_is_read(tree):
    expected = tree.closest(random_rays(7, 100)).tobytes()
    records = np.zeros(100, [("ray", raylanes.ray_dtype), ("hit", raylanes.hit_dtype)])
    records["ray"] = random_rays(7, 100)
    tree.closest(records["ray"], out=records["hit"])
    assert records["hit"].tobytes() == expected
    memory = np.zeros(3200, np.uint8)
    rays, over = memory.view(raylanes.ray_dtype), memory[1600:].view(raylanes.hit_dtype)
    rays[:] = random_rays(7, 100)  # whose first hits are where the last rays are
    assert tree.closest(rays, out=over, mode="single").tobytes() == expected
    rays = random_rays(7, 50000)
    hits = np.zeros(50001, raylanes.hit_dtype)
    hits[:-1] = tree.closest(rays)
    expected = tree.closest(rays, after=hits[:-1].copy()).tobytes()
    assert tree.closest(rays, after=hits[:-1], out=hits[1:]).tobytes() == expected


@pytest.mark.parametrize("wrong", [[[0, 0]], [0, 0, 0], 1.0, np.zeros((2, 2, 3)), np.zeros((3, 0))])
def test_wrong_shapes_of_meshes(wrong):
    with pytest.raises(ValueError, match="shape"):
        raylanes.Bvh(wrong, cube_faces)
    with pytest.raises(ValueError, match="shape"):
        raylanes.Bvh(cube_vertices, np.array(wrong, int))


@pytest.mark.parametrize("wrong", [[[0, 0]], 1.0, np.zeros((2, 7)), np.zeros((5, 0))])
def test_wrong_shapes_of_rays_and_points(wrong):
    for ask in (cube().closest, cube().occluded, cube().all_hits, cube().locate, cube().closest_points):
        with pytest.raises(ValueError, match="shape|needed"):
            ask(wrong)
    with pytest.raises(ValueError, match="shape"):
        cube().all_hits(np.zeros((2, 2, 8)))


def test_wrong_types():
    for wrong in (np.zeros((2, 3), complex), np.array([["a"] * 3]), np.array([[None] * 3]), np.zeros((2, 3), bool)):
        for ask in (lambda: raylanes.Bvh(wrong, cube_faces), lambda: raylanes.Bvh(cube_vertices, wrong),
                    lambda: cube().locate(wrong), lambda: raylanes.rays(wrong, wrong), lambda: raylanes.sqrt(wrong)):
            with pytest.raises(TypeError, match="needed"):
                ask()
    with pytest.raises(TypeError, match="integers"):
        raylanes.Bvh(cube_vertices, cube_faces.astype(np.float64))
    with pytest.raises(TypeError, match="ray_dtype"):
        cube().closest(np.zeros(2, raylanes.hit_dtype))
    with pytest.raises(TypeError, match="^after: "):
        cube().closest(random_rays(1, 2), after=np.zeros(2))
    with pytest.raises(ValueError, match="^after: "):
        cube().closest(random_rays(1, 2), after=np.zeros(3, raylanes.hit_dtype))
    for wrong in (None, "ray", np.zeros((2, 8), complex), np.zeros((2, 6), object), np.zeros((0, 8), complex)):
        with pytest.raises(TypeError, match="needed"):
            cube().closest(wrong)
    with pytest.raises(ValueError, match="32 bits"):
        raylanes.Bvh(cube_vertices, cube_faces.astype(np.int64) + 2**32)


def test_positions_are_on_the_surface(tree):
    rays = random_rays(8, 1000)
    hits = tree.closest(rays)
    positions = hits.positions(rays)
    assert positions.dtype == np.float32 and np.isnan(positions[~hits.hit]).all()
    assert tree.closest_points(positions[hits.hit]).distance.max() < 1e-6
    lists = tree.all_hits(rays)
    assert tree.closest_points(lists.positions(rays)).distance.max() < 1e-6
    with pytest.raises(IndexError):
        lists[1000]


def test_positions_of_any_layout(tree):
    made = random_rays(9, 240)
    rays = made[::2]
    hits = tree.closest(rays)
    expected = hits.positions(rays.copy())
    table = made.view(np.float32).reshape(-1, 8)
    apart = np.zeros(120, [("name", "i2"), ("ray", raylanes.ray_dtype)])
    apart["ray"] = rays
    for laid in (rays, made[::-1][1::2][::-1], table[::2], np.asfortranarray(table)[::2], apart["ray"],
                 np.concatenate([rays["origin"], rays["direction"]], axis=1)):
        assert hits.positions(laid).tobytes() == expected.tobytes()
    grid = rays.reshape(10, 12)[:, ::3]
    assert tree.closest(grid).positions(grid).tobytes() == expected.reshape(10, 12, 3)[:, ::3].tobytes()
    lists = tree.crossings(rays)
    assert lists.positions(rays).tobytes() == lists.positions(rays.copy()).tobytes()
    for other in (rays[1:], rays[:1], rays[0], rays.reshape(10, 12)):
        with pytest.raises(ValueError, match="^rays: the shape must be"):
            hits.positions(other)
        with pytest.raises(ValueError, match="^rays: "):
            lists.positions(other)


def test_single_records_have_the_properties_of_arrays(tree):
    rays = random_rays(10, 50)
    hits, points = tree.closest(rays), tree.closest_points(rays["origin"])
    crossings = tree.crossings(rays).items
    for records, kind in ((hits, raylanes.Hit), (crossings, raylanes.Crossing), (points, raylanes.ClosestPoint)):
        for records_too in (records, records[::-1], records[:3].copy(), records.reshape(-1, 1)[:, 0]):
            single = records_too[1]
            assert type(single) is kind and single == records_too[1:2][0]
            for name in records.dtype.names:
                assert np.array_equal(getattr(single, name), getattr(records_too, name)[1])
        assert [type(record) for record in records[:2]] == [kind] * 2 and type(records[0:1]) is type(records)
        assert isinstance(records[0].u if kind is not raylanes.Crossing else records[0].t, np.float32)
    i = np.flatnonzero(hits.hit)[0]
    assert hits[i].hit and not hits[np.flatnonzero(~hits.hit)[0]].hit and points[0].distance == points.distance[0]
    assert (hits[i].positions(rays[i]) == hits.positions(rays)[i]).all()
    assert pickle.loads(pickle.dumps(hits[i])).t == hits[i].t
    t, _, _, primitive = hits[i]
    assert t == hits.t[i] and primitive == hits.primitive[i] and "t" in hits[i].dtype.names
    hits[i]["t"] = 7  # a view, as in any array of records
    assert hits.t[i] == 7


def test_arguments_that_are_not_arrays(tree):
    rays, points = random_rays(11, 4), np.zeros((4, 3))
    mesh = cube_vertices, cube_faces
    for wrong, sentence in [(lambda: tree.closest_points(points, max_distance=np.ones(4)), "^max_distance: one"),
                            (lambda: tree.closest_points(points, max_distance="1"), "^max_distance: real"),
                            (lambda: tree.signed_distances(points, max_distance=None), "^max_distance: real"),
                            (lambda: tree.occluded_from(points[0], points, end=np.ones(4)), "^end: one"),
                            (lambda: tree.occluded_from(points[0], points, start=1j), "^start: real"),
                            (lambda: tree.closest(rays, threads=1.0), "^threads: an integer"),
                            (lambda: tree.locate(points, threads="2"), "^threads: an integer"),
                            (lambda: tree.all_hits(rays, max_count=2.0), "^max_count: an integer"),
                            (lambda: tree.closest(rays, test=None), "^test: a string"),
                            (lambda: tree.occluded(rays, mode=1), "^mode: a string"),
                            (lambda: tree.inside(points, rule=1), "^rule: a string"),
                            (lambda: raylanes.Bvh(*mesh, builder=1), "^builder: a string"),
                            (lambda: raylanes.Bvh(*mesh, optimize="no"), "^optimize: True"),
                            (lambda: raylanes.Bvh(*mesh, rays="many"), "^rays: real"),
                            (lambda: raylanes.KdTree(*mesh, threads=None), "^threads: an integer"),
                            (lambda: tree.refit(*mesh, threads=1.5), "^threads: an integer"),
                            (lambda: raylanes.closed_report(*mesh, 1.5), "^max_listed: an integer"),
                            (lambda: raylanes.use_path(2).__enter__(), "^path: a string")]:
        with pytest.raises(TypeError, match=sentence):
            wrong()
    for wrong, sentence in [(lambda: tree.closest(rays, threads=2**31), "^threads: 2147483648 is out of range"),
                            (lambda: tree.crossings(rays, max_count=-1), "^max_count: -1 is negative"),
                            (lambda: tree.all_hits(rays, max_count=2**32), "^max_count: 4294967296 is out of range"),
                            (lambda: raylanes.closed_report(*mesh, -1), "^max_listed: -1 is negative")]:
        with pytest.raises(ValueError, match=sentence):
            wrong()
    for one in (1, np.float64(1), np.float32(1), np.array(1.0), np.int16(1)):
        assert (tree.closest_points(points, max_distance=one).distance <= 1).all()
    with pytest.warns(RuntimeWarning, match="overflow"):
        assert tree.closest_points(points, max_distance=1e39).tobytes() == tree.closest_points(points).tobytes()
    assert len(tree.all_hits(rays, max_count=np.uint8(1), threads=np.int64(1)).items) <= 4


def test_overlaps_that_are_hard_to_find_count(tree, monkeypatch):
    """NumPy 2 has its TooHardError elsewhere: nothing may depend on that name."""
    monkeypatch.delattr(np, "TooHardError", raising=False)
    memory = np.zeros(2**22, np.uint8)
    strange = [np.lib.stride_tricks.as_strided(memory[i:], (23, 19, 17, 13, 11), (7919, 7907, 7901, 7883, 7879))
               for i in (0, 1)]
    assert overlap(*strange) and not overlap(memory[:9], memory[9:]) and not overlap(memory[::2], memory[1::2])
