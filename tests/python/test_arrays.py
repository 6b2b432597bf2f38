"""Layouts and types of arrays, and where answers go."""

import numpy as np
import pytest

import raylanes
from meshes import cube, cube_faces, cube_vertices, random_rays, sphere
from raylanes.arrays import faces_of, ray_rows, rows


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
        assert np.shares_memory(rows("vertices", laid, 3)[0], laid) == in_place
        assert raylanes.Bvh(laid, faces).closest(rays).tobytes() == expected.tobytes()
    for laid, in_place in layouts(faces):
        assert np.shares_memory(faces_of(laid), laid) == in_place
        assert raylanes.KdTree(vertices, laid).closest(rays).tobytes() == expected.tobytes()
    for dtype in (np.uint8, np.uint32, np.int16, np.int64, np.uint64):
        few = np.array(cube_faces, dtype)
        assert raylanes.Bvh(cube_vertices, few).report()["triangles"] == 12
    assert raylanes.Bvh(vertices.tolist(), faces.tolist()).closest(rays).tobytes() == expected.tobytes()


def test_layouts_of_rays(tree):
    rays = random_rays(2, 200)
    expected = tree.closest(rays).tobytes()
    for laid, in_place in layouts(rays.view(np.float32).reshape(-1, 8)):
        assert np.shares_memory(ray_rows(laid)[0], laid) == in_place
        assert tree.closest(laid).tobytes() == expected
    six = np.concatenate([rays["origin"], rays["direction"]], axis=1)
    assert tree.closest(six).tobytes() == tree.closest(six.astype(np.float64)).tobytes() == expected
    apart = np.zeros(200, [("name", "i2"), ("ray", raylanes.ray_dtype), ("more", "f8")])
    apart["ray"] = rays  # neither aligned nor side by side
    assert np.shares_memory(ray_rows(apart["ray"])[0], apart) and tree.closest(apart["ray"]).tobytes() == expected
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
    assert tree.closest_points(points[0]).shape == () and tree.signed_distance(points[0]).shape == ()
    assert tree.locate(np.zeros((0, 4, 3))).shape == (0, 4)


def test_doubles_are_rounded_and_overflow_is_infinite(tree):
    doubles = np.random.default_rng(4).uniform(-2, 2, (100, 6))
    with np.errstate(over="raise"):
        assert tree.closest(doubles).tobytes() == tree.closest(doubles.astype(np.float32)).tobytes()
    doubles[0] = 1e39
    with pytest.warns(RuntimeWarning, match="overflow"):
        assert not tree.closest(doubles).hit[0]
    with pytest.warns(RuntimeWarning), pytest.raises(ValueError, match="vertex 0: coordinate x is -inf"):
        raylanes.Bvh(cube_vertices.astype(np.float64) * 1e39, cube_faces)


def test_rays_are_broadcast():
    made = raylanes.rays(np.zeros(3), np.ones((4, 5, 3)), tmax=np.arange(5))
    assert made.shape == (4, 5) and (made["tmax"] == np.arange(5)).all() and (made["tmin"] == 0).all()
    assert raylanes.rays([0, 0, 0], [1, 2, 3]).shape == ()


def test_answers_go_where_they_are_wanted(tree):
    rays, points = random_rays(5, 300), random_rays(6, 300)["origin"]
    for ask, of, dtype in [(tree.closest, rays, raylanes.hit_dtype), (tree.occluded, rays, bool),
                           (tree.count_crossings, rays, raylanes.count_dtype), (tree.locate, points, np.uint8),
                           (tree.closest_points, points, raylanes.closest_point_dtype),
                           (tree.signed_distance, points, np.float32)]:
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
        wrong = [frozen, np.zeros(299, dtype), np.zeros((300, 1), dtype), np.zeros(300, "f2"), [0] * 300]
        for out in wrong:
            with pytest.raises(ValueError, match="^out: "):
                ask(of, out=out)
        with pytest.raises(ValueError, match="active"):
            ask(of, active=mask[1:])
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
