"""A tree keeps the vertices that it is given: float64 gets results for its own mesh, or an error, or as dtype says."""

import copy
import io
import pickle
import threading
import warnings

import numpy as np
import pytest

import rational
import raylanes
from meshes import (copies, cube, cube_faces, cube_vertices, lattice, random_rays, same, saved, sphere, supported,
                    warnings_of)

wide = np.float64
cube_doubles = cube_vertices.astype(wide)
builders = ["median", "equal_partition", "binned_sah", "sweep_sah", "morton", "auto"]


def far_lattice(seed, offset):
    """Triangles and rays of lattice(), moved to where floats are far apart; some rays aim at corners and edges."""
    vertices, faces, rays = lattice(seed)
    at = np.array(offset)
    vertices = vertices.astype(wide) + np.random.default_rng(seed).uniform(-1e-9, 1e-9, vertices.shape) + at
    origins = rays["origin"] + at
    directions = rays["direction"].astype(wide)
    corners = vertices[np.random.default_rng(seed + 9).integers(0, len(vertices), len(rays))]
    directions[::2] = (corners - origins)[::2]
    directions[np.all(directions == 0, axis=1)] = 1
    return vertices, faces, raylanes.rays(origins, directions, rays["tmin"], rays["tmax"])


@pytest.mark.parametrize("given, wanted, expected", [
    *((dtype, None, np.float32) for dtype in ("f2", "f4", ">f4")),
    *((dtype, None, wide) for dtype in ("f8", ">f8", "i1", "i4", "i8", list)),
    *((dtype, "float32", np.float32) for dtype in ("f4", "f8", "i4", list)),
    *((dtype, wide, wide) for dtype in ("f2", "f4", "f8", "i8"))])
def test_types_of_vertices(given, wanted, expected):
    vertices = cube_vertices.tolist() if given is list else cube_vertices.astype(given)
    tree = raylanes.Bvh(vertices, cube_faces, dtype=wanted)
    assert tree.dtype == expected and tree.bounds.dtype == expected and f"of {np.dtype(expected)}," in repr(tree)
    assert (tree.bounds == [[-1] * 3, [1] * 3]).all()
    for rays in (random_rays(1, 40), random_rays(1, 40, dtype=wide), random_rays(1, 40).view("f4").reshape(-1, 8)):
        hits, crossings = tree.closest(rays), tree.crossings(rays)
        assert {hits.t.dtype, hits.u.dtype, hits.v.dtype, crossings.items.t.dtype} == {np.dtype(expected)}
        assert hits.positions(rays).dtype == crossings.positions(rays).dtype == expected
        assert isinstance(hits[0], raylanes.Hit) and hits[0].positions(rays[0]).dtype == expected
        assert tree.occluded(rays).tolist() == hits.hit.tolist()


def test_types_that_are_none():
    for wrong in (int, np.float16, "float128", "text", 3, object(), [np.float32]):
        for call in (lambda wrong=wrong: cube(dtype=wrong), lambda wrong=wrong: cube(raylanes.KdTree, dtype=wrong),
                     lambda wrong=wrong: raylanes.rays([0, 0, 0], [1, 0, 0], dtype=wrong)):
            with pytest.raises(TypeError, match="^dtype: numpy.float32 or numpy.float64 is needed, not "):
                call()


def test_types_of_rays():
    three = np.zeros(3), np.ones((4, 3))
    for origins, directions in ((three[0].astype("f4"), three[1].astype("f2")), (three[0].astype("f2"),) * 2):
        assert raylanes.rays(origins, directions, 0.1, [0.2]).dtype == raylanes.ray_dtype
    for origins, directions in (three, (three[0].astype("f4"), three[1]), ([0, 0, 0], [1, 2, 3])):
        assert raylanes.rays(origins, directions).dtype == raylanes.double_ray_dtype
        assert raylanes.rays(origins, directions, dtype=np.float32).dtype == raylanes.ray_dtype
    tenth = raylanes.rays([0.1, 0, 0], [1, 0, 0], 0.1, 0.3)
    assert [tenth[name].reshape(-1)[0] for name in ("origin", "tmin", "tmax")] == [0.1, 0.1, 0.3]


def test_rays_of_the_other_type_are_converted():
    narrow, tree = cube(), cube(dtype=wide)
    rays = random_rays(3, 300, dtype=wide)
    for other in (rays, rays.reshape(30, 10), rays.view(wide).reshape(-1, 8), rays[::-1][::-1]):
        expected = narrow.closest(raylanes.rays(rays["origin"], rays["direction"], dtype=np.float32))
        assert narrow.closest(other).tobytes() == expected.tobytes()
    floats = random_rays(3, 300)
    expected = tree.closest(raylanes.rays(floats["origin"].astype(wide), floats["direction"])).tobytes()
    for other in (floats, floats.view("f4").reshape(-1, 8), floats[::-1].copy()[::-1]):
        assert tree.closest(other).tobytes() == expected
    six = np.concatenate([rays["origin"], rays["direction"]], axis=1)
    assert tree.closest(six).tobytes() == tree.closest(rays).tobytes() == tree.closest(rays.copy()).tobytes()
    with pytest.warns(RuntimeWarning, match="overflow"):
        assert not narrow.closest(raylanes.rays([[1e39, 0, 0]], [[-1, 0, 0]])).hit.any()


@pytest.mark.parametrize("builder", builders)
@pytest.mark.parametrize("offset", [(0, 0, 0), (5e5, 4e6, 0), (1e12, -1e12, 1)])
def test_hits_are_those_of_exact_arithmetic(builder, offset):
    vertices, faces, rays = far_lattice(1, offset)
    expected = [rational.all_hits(ray, vertices, faces, wide) for ray in rays]
    assert sum(map(len, expected)) > (50 if offset[0] < 1e9 else 5)
    warnings.simplefilter("ignore", raylanes.MeshWarning)
    tree = raylanes.Bvh(vertices, faces, builder=builder)
    first = [hits[0] if hits else (np.inf, 0, 0, raylanes.no_primitive) for hits in expected]
    for path in supported:
        with raylanes.use_path(path):
            assert [[hit.item() for hit in hits] for hits in tree.all_hits(rays)] == expected
            assert [hit.item() for hit in tree.closest(rays)] == first
            assert tree.occluded(rays).tolist() == [bool(hits) for hits in expected]
            assert [len(hits) for hits in tree.all_hits(rays, max_count=1)] == [min(1, len(h)) for h in expected]
    before = tree.closest(rays)
    for depth in range(max(map(len, expected))):
        assert [hit.item() if hit.hit else None for hit in before] == [
            hits[depth] if depth < len(hits) else None for hits in expected]
        assert tree.closest(rays, after=before, out=before) is before


@pytest.mark.parametrize("offset", [1e5, 1e6, 4e6])
def test_a_mesh_of_two_metres_far_away(offset):
    """Floats lose triangles of the ball there; as doubles all are kept."""
    vertices, faces = sphere(triangles=40000)
    at = vertices.astype(wide) + offset
    points = np.random.default_rng(4).uniform(-1.2, 1.2, (3000, 3)) + offset
    assert warnings_of(lambda: raylanes.Bvh(at, faces)) == []
    tree = raylanes.Bvh(at, faces)
    report = tree.report()
    assert report["triangles"] == len(faces) and report["left_out"] == report["rounded_away"] == 0
    near = raylanes.Bvh(at - offset, faces)  # exact differences
    expected = near.locate(points - offset)
    assert same(tree.locate(points), expected) and 0.2 < (expected == raylanes.INSIDE).mean() < 0.8
    assert same(tree.locate(at[:300]), np.full(300, raylanes.ON))
    rays = raylanes.rays(points, np.random.default_rng(5).normal(size=points.shape))
    moved = raylanes.rays(points - offset, rays["direction"])
    assert same(tree.closest(rays).primitive.copy(), near.closest(moved).primitive.copy())
    counts = tree.count_crossings(rays)
    assert same(counts, near.count_crossings(moved)) and (counts["crossings"] % 2 == expected).all()
    corners = cube_doubles + offset
    solid = raylanes.Bvh(corners, cube_faces)
    inside = np.array([[0.999999, 0, 0], [1, 0, 0], [1.000001, 0, 0]]) + offset
    assert solid.locate(inside).tolist() == [raylanes.INSIDE, raylanes.ON, raylanes.OUTSIDE]


def test_a_tetrahedron_of_a_millimetre():
    at = np.array([5e5, 4e6, 0])
    vertices = at + 1e-3 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    tree = raylanes.Bvh(vertices, faces)
    assert tree.report()["triangles"] == 4
    assert tree.inside(at + 1e-3 * np.array([[0.2, 0.2, 0.2], [0.4, 0.4, 0.4]])).tolist() == [True, False]
    hit = tree.closest(raylanes.rays(at + [2e-4, 2e-4, 2], [0, 0, -1]))
    assert hit.primitive == 3 and abs(hit.t - (2 - 6e-4)) < 1e-8
    assert np.abs(hit.positions(raylanes.rays(at + [2e-4, 2e-4, 2], [0, 0, -1])) - at - [2e-4, 2e-4, 6e-4]).max() < 1e-8
    assert tree.occluded_from(at + [2e-4, 2e-4, 2], at + [2e-4, 2e-4, -1])
    assert not tree.occluded_from(at + [2e-3, 2e-4, 2], at + [2e-3, 2e-4, -1])
    text, = warnings_of(lambda: raylanes.Bvh(vertices, faces, dtype=np.float32))
    assert text.startswith("4 of 4 triangles have two equal corners, 4 of them by rounding to float32,")


def test_triangles_that_rounding_loses_are_counted():
    offset, faces = 1e6, np.concatenate([sphere(triangles=40000)[1], [[0, 0, 1], [2, 3, 3]]])
    vertices = sphere(triangles=40000)[0].astype(wide) + offset
    rounded = vertices.astype(np.float32)[faces]
    lost = sum((rounded[:, a] == rounded[:, b]).all(axis=1) for a, b in ((0, 1), (1, 2), (2, 0))) > 0
    count = int(np.count_nonzero(lost)) - 2
    text, = warnings_of(lambda: raylanes.Bvh(vertices, faces, dtype=np.float32))
    assert count > 100 and f"{count} of them by rounding" in text and text.startswith(f"{count + 2} of {len(faces)} ")
    assert "dtype=numpy.float64" in text and "\n" not in text
    warnings.simplefilter("ignore", raylanes.MeshWarning)
    tree = raylanes.Bvh(vertices, faces, dtype=np.float32)
    for each in (tree, copy.copy(tree), pickle.loads(pickle.dumps(tree))):
        report = each.report()
        assert (report["left_out"], report["rounded_away"]) == (count + 2, count)
        assert f"{count + 2} left out for two equal corners" in repr(each)
        assert f"{count} lost by rounding to float32" in repr(each)
    kept = raylanes.Bvh(vertices, faces)
    assert (kept.report()["left_out"], kept.report()["rounded_away"]) == (2, 0) and "lost" not in repr(kept)
    assert len(warnings_of(lambda: raylanes.KdTree(vertices, faces, dtype=np.float32))) == 1
    tree.refit(vertices - offset, faces)
    assert tree.report()["rounded_away"] == 0


def test_float32_is_never_taken_for_float64_without_a_word():
    vertices = cube_doubles + 1e-9
    for wrong in (vertices, vertices.tolist(), (cube_vertices * 2**25).astype(int) + 1):
        with pytest.raises(ValueError, match="^vertices: float32 does not hold these .* numbers; a KdTree has"):
            raylanes.KdTree(wrong, cube_faces)
        with pytest.raises(ValueError, match="^vertices: float32 does not hold .*: give it vertices of float32$"):
            cube().refit(wrong, cube_faces)
        raylanes.KdTree(wrong, cube_faces, dtype=np.float32)
        cube(dtype=np.float32).refit(wrong, cube_faces)
    for exact in (cube_vertices.tolist(), cube_vertices.astype(int), cube_vertices.astype(wide) / 8):
        assert raylanes.KdTree(exact, cube_faces).dtype == np.float32
        cube().refit(exact, cube_faces)
    unused = np.concatenate([cube_vertices, [[np.nan, 1, 1], [np.inf, 1, 1]]])
    assert raylanes.KdTree(unused, cube_faces).report()["triangles"] == 12
    with pytest.raises(ValueError, match="float32; a Bvh may have float64"):
        raylanes.KdTree(cube_vertices, cube_faces, dtype=wide)


def test_refits_keep_the_type():
    vertices, faces, rays = far_lattice(2, (5e5, 4e6, 0))
    warnings.simplefilter("ignore", raylanes.MeshWarning)
    tree = raylanes.Bvh(vertices - 1, faces)
    shared = copy.copy(tree)
    stop = threading.Event()
    other = threading.Thread(target=stop.wait)
    other.start()  # so that the refit makes a new state
    shared.refit(vertices, faces)
    stop.set(), other.join()
    before = tree.closest(rays).tobytes()
    expected = raylanes.Bvh(vertices, faces).closest(rays).tobytes()
    assert shared.dtype == wide and shared.closest(rays).tobytes() == expected != before
    assert tree.closest(rays).tobytes() == before
    tree.refit(vertices, faces)
    assert tree.closest(rays).tobytes() == expected and 0 < tree.decay() < 10 and tree.sah_cost() > 0
    tree.refit(cube_vertices[:, None].repeat(3, axis=1).reshape(-1, 3), faces % 24)  # float32 is kept, too
    assert tree.dtype == wide
    with pytest.raises(ValueError, match="refit"):
        tree.refit(vertices, faces[1:])


@pytest.mark.parametrize("copied", [*copies, lambda tree: raylanes.Bvh.load(io.BytesIO(saved(tree)))])
def test_copies_and_files(copied):
    vertices, faces, rays = far_lattice(3, (5e5, 4e6, 0))
    warnings.simplefilter("ignore", raylanes.MeshWarning)
    tree = raylanes.Bvh(vertices, faces, builder="morton", optimize=True)
    other = copied(tree)
    assert type(other) is raylanes.Bvh and other.dtype == wide and saved(other) == saved(tree)
    assert other.closest(rays).tobytes() == tree.closest(rays).tobytes()
    assert other.report()["builder"] == "morton" and other.report()["optimized"]
    assert other.report()["left_out"] == tree.report()["left_out"] > 0
    other.refit(vertices + 1, faces)
    assert other.closest(rays).tobytes() != tree.closest(rays).tobytes()


def test_load_knows_the_kind_of_a_file(tmp_path):
    trees = [cube(dtype=wide), cube(), cube(dtype=wide)]
    data = b"".join(map(saved, trees)) + b"behind"

    class Dripping(io.BytesIO):
        def read(self, size=-1):
            return super().read(min(size, 7))

    (tmp_path / "file").write_bytes(data)
    with open(tmp_path / "file", "rb", buffering=0) as raw:
        for file in (io.BytesIO(data), Dripping(data), raw):
            assert [raylanes.Bvh.load(file).dtype for _ in trees] == [wide, np.float32, wide]
            assert file.read(6) == b"behind"
    (tmp_path / "one").write_bytes(saved(trees[0]))
    assert raylanes.Bvh.load(tmp_path / "one").dtype == wide
    for wrong, kind, other in ((trees[0], raylanes.KdTree, "BvhD"), (cube(raylanes.KdTree), raylanes.Bvh, "KdTree")):
        with pytest.raises(ValueError, match=f"^tree file: it begins as that of a {other} does, not as that of a "):
            kind.load(io.BytesIO(saved(wrong)))
    whole = saved(trees[0])
    for n in (*range(40), *range(40, len(whole), 61)):
        damaged = bytearray(whole)
        damaged[n] ^= 0x10
        for bad in (whole[:n], damaged):
            with pytest.raises(ValueError, match="^tree file: "):
                raylanes.Bvh.load(io.BytesIO(bad))


def test_what_trees_of_doubles_do_not_have():
    tree = cube(dtype=wide)
    for call in (lambda: tree.closest(random_rays(1, 2), test="watertight"),
                 lambda: tree.occluded(random_rays(1, 2), test="moller_trumbore")):
        with pytest.raises(ValueError, match='^test: float64 has "exact" alone; .*numpy.float32'):
            call()
    with pytest.raises(ValueError, match='^builder: "spatial_splits" is for trees of dtype=numpy.float32'):
        cube(builder="spatial_splits", dtype=wide)
    for mode, hint, grade in (("packet", "coherent", "fast"), ("stream", "incoherent", "reproducible")):
        rays = random_rays(1, 200, dtype=wide)
        assert same(tree.closest(rays, mode=mode, hint=hint, grade=grade), tree.closest(rays))
    for name in ("mode", "hint", "grade", "test", "facing"):
        with pytest.raises(ValueError, match=f'^{name}: there is no "no such"'):
            tree.closest(random_rays(1, 2), **{name: "no such"})


@pytest.mark.parametrize("offset", [0, 1e6])
def test_points_near_a_cube(offset):
    axis = np.arange(-8, 9) / 4
    points = np.stack(np.meshgrid(axis, axis, axis), axis=-1)
    tree, holed = (raylanes.Bvh(cube_doubles + offset, faces) for faces in (cube_faces, cube_faces[1:]))
    far = np.max(np.abs(points), axis=-1)
    outside = np.sqrt(np.sum(np.maximum(np.abs(points) - 1, 0) ** 2, axis=-1))
    expected = np.where(far > 1, outside, far - 1)
    at = points + offset
    distance, close = tree.signed_distances(at), tree.closest_points(at)
    assert distance.dtype == close.point.dtype == close.u.dtype == wide
    assert close.dtype == raylanes.double_closest_point_dtype
    assert np.abs(distance - expected).max() < 1e-15 and same(np.sign(distance), np.sign(far - 1))
    assert np.abs(close.distance - np.abs(expected)).max() < 1e-15 and close.primitive.max() < 12
    assert np.abs(close.distance**2 - close.distance_squared).max() < 1e-14
    assert np.abs(np.linalg.norm(close.point - at, axis=-1) - close.distance).max() < 1e-9
    assert isinstance(close[0, 0, 0], raylanes.ClosestPoint) and close[0, 0, 0].distance == close.distance[0, 0, 0]
    band = tree.signed_distances(at, max_distance=0.25)
    near = np.abs(expected) <= 0.25
    assert same(band[near], distance[near]) and np.isinf(band[~near]).all()
    assert np.isinf(tree.closest_points(at, max_distance=0.5).distance[np.abs(expected) > 0.5]).all()
    nowhere = tree.closest_points(at[0], active=np.zeros((17, 17), bool))
    assert np.isinf(nowhere.distance).all() and (nowhere.primitive == raylanes.no_primitive).all()
    whole = tree.winding_numbers(at)
    assert whole.dtype == wide and same(whole[far != 1], (far[far != 1] < 1).astype(wide))
    numbers, of_floats = holed.winding_numbers(at, accuracy=0), cube(dtype=np.float32)
    of_floats.refit(cube_vertices, cube_faces)
    of_floats = raylanes.Bvh(cube_vertices, cube_faces[1:]).winding_numbers(points)
    assert np.abs(numbers - of_floats)[far != 1].max() < 1e-5
    assert same(holed.inside(at[far != 1], rule="winding"), numbers[far != 1] >= 0.5)
    with pytest.warns(raylanes.MeshWarning):
        holed.signed_distances(at)


def test_distances_that_floats_lose():
    """A point 1 nm above a face that is 4000 km away from the origin, and sizes whose squares overflow or vanish."""
    corners = [[4e6, 5e5, 0], [4e6 + 1, 5e5, 0], [4e6, 5e5 + 1, 0]]
    tree = raylanes.Bvh(corners, [[0, 1, 2]])
    near = tree.closest_points([[4e6 + 0.25, 5e5 + 0.25, 1e-9], [4e6 - 3, 5e5 - 4, 0]])
    assert near.distance.tolist() == [1e-9, 5] and near.point[0].tolist() == [4e6 + 0.25, 5e5 + 0.25, 0]
    for scale in (2.0**-600, 2.0**600):
        scaled = raylanes.Bvh(cube_doubles * scale, cube_faces)
        assert scaled.closest_points([[3 * scale, 0, 0]]).distance == 2 * scale
        assert scaled.signed_distances([[0.5 * scale, 0, 0]]) == -0.5 * scale


def test_the_end_of_a_segment():
    """By default trees of both types have the point that a segment ends at."""
    for dtype in (np.float32, wide):
        tree = cube(dtype=dtype)
        assert tree.occluded_from([0.25, 0.5, 3], [[0.25, 0.5, 1]]).tolist() == [True]
        assert tree.occluded_from([0.25, 0.5, 3], [[0.25, 0.5, 1]], end=1).tolist() == [True]
        assert not tree.occluded_from([0.25, 0.5, 3], [[0.25, 0.5, 1]], end=1 - 2.0**-12).any()
        assert not tree.occluded_from([0.25, 0.5, 1], [[0.25, 0.5, 3]], start=1e-9).any()
    end = 1 - 2.0**-40
    assert not cube(dtype=wide).occluded_from([0.25, 0.5, 3], [[0.25, 0.5, 1]], end=end).any()


def test_arrays_for_results():
    tree, rays = raylanes.Bvh(sphere()[0].astype(wide), sphere()[1]), random_rays(5, 300, dtype=None)
    points, mask = rays["origin"], np.arange(300) % 3 == 0
    for call, of, dtype in ((tree.closest, rays, raylanes.double_hit_dtype), (tree.occluded, rays, np.dtype(bool)),
                            (tree.count_crossings, rays, raylanes.count_dtype), (tree.locate, points, np.dtype("u1")),
                            (tree.closest_points, points, raylanes.double_closest_point_dtype),
                            (tree.winding_numbers, points, np.dtype(wide)),
                            (tree.signed_distances, points, np.dtype(wide))):
        expected = call(of)
        for out in (np.zeros(300, dtype), np.zeros(900, dtype)[::3], np.zeros(300, dtype)[::-1]):
            assert call(of, out=out) is out and (out == expected).all()
        out = np.ones(300, dtype)
        call(of, out=out, active=mask)
        assert (out[mask] == expected[mask]).all() and (out[~mask] == np.ones(1, dtype)).all()
        assert (call(of, active=mask)[mask] == expected[mask]).all()
        assert call(of[::2], active=mask[::2]).tobytes() == call(of[::2].copy(), active=mask[::2]).tobytes()
    assert not tree.closest(rays, active=np.zeros(300, bool)).hit.any()
    for call, of, dtype in ((tree.closest, rays, raylanes.hit_dtype), (tree.winding_numbers, points, np.float32),
                            (tree.closest_points, points, raylanes.closest_point_dtype)):
        with pytest.raises(TypeError, match="^out: "):
            call(of, out=np.zeros(300, dtype))
    with pytest.raises(TypeError, match="^after: hits of this tree"):
        tree.closest(rays, after=cube().closest(rays))
    with pytest.raises(TypeError, match="^after: hits of this tree"):
        cube().closest(rays, after=tree.closest(rays))
    front, back = (tree.closest(rays, facing=side) for side in ("front", "back"))
    nearest, inside = tree.closest(rays), tree.inside(points)
    assert same(np.minimum(front.t, back.t), nearest.t.copy()) and 0 < inside.sum() < nearest.hit.sum()
    assert ((front.t > back.t) == inside)[nearest.hit].all()  # a ray leaves a solid before it enters it again
    assert same(tree.occluded(rays, facing="front"), front.hit) and (front.hit != back.hit).any()


@pytest.mark.parametrize("made", [lambda tree: tree, lambda tree: pickle.loads(pickle.dumps(tree)),
                                  lambda tree: raylanes.Bvh.load(io.BytesIO(saved(tree)))])
def test_holes_of_doubles(made):
    """Two edges that floats cannot tell apart are open edges of float64."""
    at = cube_doubles + 1e6
    apart = np.concatenate([at, [at[0] + [1e-9, 0, 0]]])
    torn = cube_faces.copy()
    torn[0, 0] = 8
    for vertices, faces, is_open in ((at, cube_faces, False), (at, cube_faces[1:], True), (apart, torn, True),
                                     (sphere()[0].astype(wide), sphere()[1], False),
                                     (sphere()[0].astype(wide), sphere()[1][:-1], True),
                                     (at, cube_faces[:1], True), (at, np.tile(cube_faces[:1], (2, 1)), False)):
        tree = made(raylanes.Bvh(vertices, faces))
        assert raylanes.closed_report(vertices, faces)["has_parity"] != is_open
        found = warnings_of(lambda tree=tree: [tree.inside([at[0]]), tree.locate([at[0]])])
        assert len(found) == is_open and all('rule="winding" is for' in text for text in found)


def test_reports_of_doubles_are_those_of_floats():
    for mesh in (sphere(), (cube_vertices, cube_faces[1:]), (cube_vertices, np.concatenate([cube_faces] * 2)),
                 lattice(1)[:2]):
        expected = raylanes.closed_report(*mesh)
        moved = mesh[0].astype(wide) * 3 + 1e-7
        for doubles, scale in ((moved, 27), (mesh[0].astype(wide), 1)):
            report = raylanes.closed_report(doubles, mesh[1])
            assert report["volume"] == pytest.approx(scale * expected["volume"])
            assert {**report, "volume": expected["volume"]} == expected
    with pytest.raises(ValueError, match="vertex 3: coordinate y is nan"):
        raylanes.closed_report(np.where(np.arange(24).reshape(8, 3) == 10, np.nan, cube_doubles + 1e-9), cube_faces)
