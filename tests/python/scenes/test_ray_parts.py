"""Rays as origins, directions and ends apart: the bytes of the same rays as records."""

import concurrent.futures
import itertools
import warnings

import numpy as np
import pytest

import raylanes
from meshes import lattice, random_rays, same, sphere, supported
from raylanes._arrays import FLOATS, RayParts, ray_rows

kinds = ["Bvh", "float64", "KdTree", "Scene", "SphereTree"]
names = "origins", "directions", "tmin", "tmax"


def tree_of(kind, vertices, faces):
    if kind == "SphereTree":
        return raylanes.SphereTree(vertices, 0.25)
    if kind == "KdTree":
        return raylanes.KdTree(vertices, faces)
    if kind == "float64":
        return raylanes.Bvh(vertices, faces, dtype=np.float64)
    tree = raylanes.Bvh(vertices, faces)
    if kind == "Bvh":
        return tree
    scene = raylanes.Scene()
    scene.place(scene.add(tree), [np.eye(4), np.eye(4) * [[2], [2], [2], [1]]])
    scene.place(scene.add(raylanes.Bvh(vertices[:, ::-1], faces)))
    scene.update()
    return scene


def queries_of(tree):
    """Queries that write a result for each ray, and those that return lists."""
    of_each = "closest", "occluded", "closest_crossing", "count_crossings"
    return ([getattr(tree, name) for name in of_each if hasattr(tree, name)],
            [getattr(tree, name) for name in ("all_hits", "crossings", "stretches") if hasattr(tree, name)])


def parts_of(rays):
    return dict(zip(names, (rays["origin"], rays["direction"], rays["tmin"], rays["tmax"])))


def same_lists(a, b):
    return same(a.offsets, b.offsets) and same(np.asarray(a.items), np.asarray(b.items))


@pytest.fixture(scope="module", params=kinds)
def case(request):
    vertices, faces, rays = lattice(3, rays=400)
    return tree_of(request.param, vertices, faces), rays


def test_results_are_those_of_records(case):
    tree, rays = case
    parts = parts_of(rays)
    of_each, of_lists = queries_of(tree)
    active = np.arange(len(rays)) % 3 != 0
    first = tree.closest(rays)
    for query, path, threads in itertools.product(of_each, supported, (1, 2)):
        with raylanes.use_path(path):
            assert same(query(**parts, threads=threads), query(rays, threads=threads))
            for options in ({"active": active}, {"skip": first}, {"active": active, "skip": first}):
                assert same(query(**parts, **options, threads=threads), query(rays, **options, threads=threads))
    for query in of_lists:
        for options in ({}, {"active": active}, {"skip": first}, {"max_count": 1}):
            assert same_lists(query(**parts, **options), query(rays, **options))


def test_options_of_hits(case):
    tree, rays = case
    parts = parts_of(rays)
    first = tree.closest(rays)
    assert first.hit.any()
    assert same(tree.closest(**parts, after=first), tree.closest(rays, after=first))
    for query in (tree.closest, tree.occluded):
        assert same(query(**parts, filter=lambda indices, hits: indices % 2 == 0),
                    query(rays, filter=lambda indices, hits: indices % 2 == 0))
    out = np.zeros(len(rays), first.dtype)
    assert tree.closest(**parts, out=out) is out and out.tobytes() == first.tobytes()
    if not isinstance(tree, raylanes.SphereTree):
        for mode, facing in itertools.product(("single", "packet", "stream"), ("front", "back")):
            assert same(tree.closest(**parts, mode=mode, facing=facing), tree.closest(rays, mode=mode, facing=facing))
    told = []
    tree.closest(**parts, progress=told.append)
    assert told and told[-1] == 1


@pytest.mark.parametrize("shapes", [((3,), (3,), (), ()), ((3,), (7, 3), (), (7,)), ((7, 3), (3,), (7,), ()),
                                    ((3,), (3,), (), (6,)), ((4, 1, 3), (5, 3), (), (4, 1)),
                                    ((1, 3), (4, 5, 3), (5,), ()), ((2, 3, 4, 3), (3, 1, 3), (1,), (2, 1, 1)),
                                    ((0, 3), (3,), (), ()), ((2, 0, 3), (1, 3), (), ()), ((3,), (3,), (), (0,)),
                                    ((3,), (30000, 3), (), ())])
def test_shapes_are_broadcast(case, shapes):
    tree, _ = case
    random = np.random.default_rng(4)
    values = [random.uniform(-1, 1, shape).astype(np.float32) for shape in shapes[:2]]
    values += [np.float32(-0.5) * random.random(shapes[2]).astype(np.float32), random.random(shapes[3]) + 1]
    given = dict(zip(names, values))
    rays = raylanes.rays(**given, dtype=np.float64)  # which keeps tmax
    of_each, of_lists = queries_of(tree)
    for query in of_each:
        expected = query(rays)
        found = query(**given)
        assert same(np.asarray(found), np.asarray(expected)) and np.shape(found) == rays.shape
    for query in of_lists:
        if rays.ndim == 1:
            assert same_lists(query(**given), query(rays))
        else:
            with pytest.raises(ValueError, match="^rays: lists are of rays in one dimension"):
                query(**given)


def test_other_types_are_converted(case):
    tree, _ = case
    doubles = random_rays(5, 50, dtype=np.float64)
    origins, directions = doubles["origin"], doubles["direction"]
    assert same(tree.closest(origins=origins, directions=directions), tree.closest(doubles))
    lists = origins.tolist(), directions.tolist()
    assert same(tree.closest(origins=lists[0], directions=lists[1]), tree.closest(doubles))
    assert same(tree.occluded(origins=[0, 0, 5], directions=np.int8([0, 0, -1]), tmax=np.float16(9)),
                tree.occluded([0, 0, 5, 0, 0, 0, -1, 9]))
    swapped = [part.astype(part.dtype.newbyteorder()) for part in (origins, directions)]
    assert same(tree.closest(origins=swapped[0], directions=swapped[1]), tree.closest(doubles))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        tree.closest(origins=[1e39, 0, 0], directions=[1, 0, 0])
    assert [one.category for one in caught] == [RuntimeWarning] * (getattr(tree, "dtype", np.float32) == np.float32)


def test_rays_that_hit_nothing(case):
    tree, _ = case
    of_each, _ = queries_of(tree)
    ahead, nan, inf = [0, 0, -1], np.nan, np.inf
    for origin, direction, tmin, tmax in [([nan, 0, 5], ahead, 0, inf), ([0, 0, inf], ahead, 0, inf),
                                          ([0, 0, 5], [0, nan, -1], 0, inf), ([0, 0, 5], [0, 0, -inf], 0, inf),
                                          ([0, 0, 5], [0, 0, 0], 0, inf), ([0, 0, 5], ahead, nan, inf),
                                          ([0, 0, 5], ahead, 0, nan), ([0, 0, 5], ahead, 7, 6)]:
        for query in of_each:
            found = query(origins=origin, directions=[direction] * 3, tmin=tmin, tmax=[tmax] * 3)
            assert same(found, query(raylanes.rays([origin] * 3, direction, tmin, tmax)))
        assert not tree.occluded(origins=origin, directions=direction, tmin=tmin, tmax=tmax)


def test_parts_are_read_where_they_lie():
    memory = np.random.default_rng(6).uniform(-1, 1, (60, 8)).astype(np.float32)
    frozen = memory[:, :3].copy()
    frozen.flags.writeable = False
    pose = np.eye(4, dtype=np.float32)
    bytewise = np.zeros(60, [("name", "i1"), ("point", "<f4", 3)])["point"]
    tree = raylanes.Bvh(*sphere(triangles=200))
    grid = memory[:, :3].reshape(6, 10, 3)
    windows = np.lib.stride_tricks.sliding_window_view(memory.reshape(-1), 3)[:60]
    for origins, in_place in [(memory[:, :3], True), (memory[::2, 1:4], True), (frozen, True), (grid, True),
                              (grid[::2], False), (windows, True), (bytewise, True), (pose[0, :3], True),
                              (pose[:3, 3], False), (memory[::-1, :3], False), (memory.T[:3].T, True),
                              (np.asfortranarray(memory[:, :3]), False)]:
        (rows, _, ends, _), shape = ray_rows(RayParts(origins, np.float32([0, 0, -1]), 0.0, np.inf), FLOATS)
        assert np.shares_memory(rows, origins) == in_place and shape == origins.shape[:-1]
        assert rows.shape[1:] == (3,) and ends.strides == (0,) * (ends.size > 1) + (4,) * (ends.size == 1)
        assert same(tree.closest(origins=origins, directions=[0, 0, -1]),
                    tree.closest(raylanes.rays(origins.copy(), np.float32([0, 0, -1]))))
    for origin in (pose[0, :3], pose[:3, 3], pose[:3, 3].astype(np.float64)):  # one for all rays: never repeated
        (rows, directions, _, _), _ = ray_rows(RayParts(origin, grid, 0.0, np.inf), FLOATS)
        assert rows.strides == (0, 4) and rows.shape == (60, 3) and np.shares_memory(directions, grid)


def test_results_may_lie_among_parts():
    tree = raylanes.Bvh(*sphere(triangles=300))
    rays = random_rays(7, 100)
    expected = tree.closest(rays).tobytes()
    records = np.zeros(100, [("origin", "<f4", 3), ("direction", "<f4", 3), ("hit", raylanes.hit_dtype)])
    records["origin"], records["direction"] = rays["origin"], rays["direction"]
    tree.closest(origins=records["origin"], directions=records["direction"], out=records["hit"])
    assert records["hit"].tobytes() == expected
    memory = np.zeros(400, np.float32)
    memory[:300] = rays["origin"].reshape(-1)
    over = memory.view(raylanes.hit_dtype)
    tree.closest(origins=memory[:300].reshape(-1, 3), directions=rays["direction"], out=over)
    assert over.tobytes() == expected
    shared = np.zeros(400, np.float32)
    tree.closest(origins=shared[:3], directions=rays["direction"], out=shared.view(raylanes.hit_dtype))
    assert shared.tobytes() == tree.closest(origins=[0, 0, 0], directions=rays["direction"]).tobytes()


def test_what_is_refused(case):
    tree, rays = case
    point, points = np.zeros(3), np.zeros((4, 3))
    of_each, of_lists = queries_of(tree)
    for query in of_each + of_lists:
        for wrong in ({}, {"origins": point}, {"directions": points}, {"tmin": 0, "tmax": 1}, {"rays": None},
                      {"rays": rays, "origins": point}, {"rays": rays, "origins": points, "directions": points},
                      {"rays": rays, "tmin": 0}, {"rays": rays, "tmax": 1}):
            with pytest.raises(TypeError, match="^rays: either rays alone or origins and directions are needed, not "):
                query(**wrong)
        with pytest.raises(TypeError, match="positional"):
            query(point, points)
        for name, wrong in itertools.product(names, (np.zeros(3, complex), ["a"] * 3, np.zeros(3, bool), object())):
            with pytest.raises(TypeError, match=f"^{name}: real numbers are needed"):
                query(**{"origins": points, "directions": point, name: wrong})
        for name, wrong in itertools.product(names[:2], (1.0, [], [0, 0], np.zeros((3, 4)), np.zeros((4, 0)))):
            with pytest.raises(ValueError, match=f"^{name}: the last of its axes must have 3 numbers"):
                query(**{"origins": points, "directions": point, name: wrong})
        for wrong in ({"origins": np.zeros((5, 3))}, {"tmin": np.zeros(3)}, {"tmax": np.zeros((4, 2))}):
            with pytest.raises(ValueError, match="^origins, directions, tmin, tmax: the shapes .* broadcast$"):
                query(**{"origins": points, "directions": points, **wrong})
        with pytest.raises(ValueError, match="^active: the shape must be"):
            query(origins=point, directions=points, active=np.ones(3, bool))
    with pytest.raises(ValueError, match="^out: the shape must be"):
        tree.occluded(origins=point, directions=points, out=np.zeros((), bool))
    with pytest.raises(ValueError, match="skip"):
        tree.closest(origins=point, directions=points, skip=tree.closest(rays[:3]))
    with pytest.raises(ValueError, match="^after: "):
        tree.closest(origins=point, directions=points, after=tree.closest(rays[:3]))


def test_positions(case):
    tree, _ = case
    rays = random_rays(8, 60)
    rays["origin"] = [0.25, 0.5, 3]
    parts = {"origins": np.float32([0.25, 0.5, 3]), "directions": rays["direction"]}
    hits = tree.closest(**parts)
    assert same(hits.positions(**parts), hits.positions(rays))
    assert same(hits[5].positions(origins=parts["origins"], directions=parts["directions"][5]), hits.positions(rays)[5])
    grid = {**parts, "directions": rays["direction"].reshape(6, 10, 3)}
    assert same(tree.closest(**grid).positions(**grid), hits.positions(rays).reshape(6, 10, 3))
    if hasattr(tree, "all_hits"):
        assert same(tree.all_hits(rays).positions(**parts), tree.all_hits(rays).positions(rays))
        with pytest.raises(ValueError, match="^rays: the shape must be"):
            tree.all_hits(rays).positions(origins=parts["origins"], directions=parts["origins"])
    with pytest.raises(ValueError, match="^rays: the shape must be"):
        hits.positions(origins=parts["origins"], directions=rays["direction"][1:])
    for wrong in ({}, {"origins": parts["origins"]}, {"rays": rays, **parts}):
        with pytest.raises(TypeError, match="^rays: either"):
            hits.positions(**wrong)


def test_normals_of_spheres_in_scenes():
    scene, spheres = raylanes.Scene(), raylanes.SphereTree([[0, 0, 0]], 1)
    scene.place(scene.add(spheres))
    scene.update()
    parts = {"origins": [0, 0.5, 5], "directions": [[0, 0, -1], [0, -0.1, -1], [0, 1, 0]]}
    hits = scene.closest(**parts)
    assert same(hits.normals(scene, [spheres], **parts), hits.normals(scene, [spheres], raylanes.rays(**parts)))
    with pytest.raises(TypeError, match="^rays: either"):
        hits.normals(scene, [spheres], origins=[0, 0, 5])


def test_many_threads_ask_at_once(case):
    tree, _ = case
    rays = random_rays(9, 20000)
    rays["origin"] = [0, 0, 2]
    expected = tree.closest(rays).tobytes()
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        found = [pool.submit(tree.closest, origins=[0, 0, 2], directions=rays["direction"], threads=1 + k % 2)
                 for k in range(12)]
        assert all(one.result().tobytes() == expected for one in found)


def test_the_binding_reads_nothing_beyond_parts():
    tree = raylanes.Bvh(*sphere(triangles=100))._tree
    three, one, hits = np.zeros((5, 3), np.float32), np.zeros(5, np.float32), np.zeros(5, raylanes.hit_dtype)
    asked = "exact", "reproducible", "automatic", "none", None, 1, "any", None, None
    for wrong in ((three, three[:4], one, one), (three, three, one[:4], one), (three, three, one, one[1:]),
                  (three[:, :2], three, one, one), (three, three.astype(np.float64), one, one),
                  (three[::-1], three, one, one), (three, three, one[::-1], one), (three, three, one, three),
                  (np.zeros((3, 5), np.float32).T, three, one, one)):
        with pytest.raises(ValueError, match="array|parts"):
            tree.closest(wrong, hits, asked, None, None, None)
    with pytest.raises(IndexError):
        tree.closest((three, three), hits, asked, None, None, None)
