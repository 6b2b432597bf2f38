"""Answers of trees, against exact arithmetic and against each other."""

import numpy as np
import pytest

import rational
import raylanes
from meshes import (any_bits, cube, cube_faces, cube_vertices, lattice, random_rays, same, sphere, supported,
                    tree_kinds)


@pytest.fixture(scope="module")
def expected():
    """Of some lattices: vertices, faces, rays and their exact hits."""
    scenes = []
    for seed in range(3):
        vertices, faces, rays = lattice(seed)
        scenes.append((vertices, faces, rays, [rational.all_hits(ray, vertices, faces) for ray in rays]))
    return scenes


@pytest.mark.parametrize("kind, builder", tree_kinds)
def test_all_hits_are_those_of_exact_arithmetic(expected, kind, builder):
    for vertices, faces, rays, hits in expected:
        found = kind(vertices, faces, builder=builder).all_hits(rays)
        assert len(found) == len(rays) and sum(map(len, hits)) == len(found.items) > 50
        for i, of_ray in enumerate(hits):
            assert [hit.item() for hit in found[i]] == of_ray
        assert same(found.ray, np.repeat(np.arange(len(rays)), found.counts))


@pytest.mark.parametrize("path", supported)
@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_the_nearest_hit_is_the_first_of_all(expected, kind, path):
    with raylanes.use_path(path):
        for vertices, faces, rays, hits in expected:
            tree = kind(vertices, faces)
            for mode in ("automatic", "single", "stream"):
                found = tree.closest(rays, mode=mode)
                assert [h.item() for h in found] == [h[0] if h else (np.inf, 0, 0, raylanes.no_primitive) for h in hits]
            assert [bool(x) for x in tree.occluded(rays)] == [bool(h) for h in hits]
            assert [len(x) for x in tree.all_hits(rays, max_count=1)] == [min(1, len(h)) for h in hits]


def test_hits_one_behind_the_other_are_all_hits(expected):
    for vertices, faces, rays, hits in expected:
        tree = raylanes.Bvh(vertices, faces)
        before = tree.closest(rays)
        for depth in range(max(map(len, hits))):
            assert [h.item() if h["primitive"] != raylanes.no_primitive else None for h in before] == [
                h[depth] if depth < len(h) else None for h in hits]
            assert tree.closest(rays, after=before, out=before) is before
        assert not before.hit.any()


def side_of(ray, corners):
    """-1 for a ray that comes to the front of a triangle, 1 for the back."""
    direction, (a, b, c) = rational.fractions(ray[4:7]), map(rational.fractions, corners)
    normal = rational.cross(rational.minus(b, a), rational.minus(c, a))
    return -1 if rational.dot(direction, normal) < 0 else 1


@pytest.mark.parametrize("facing, side", [("front", -1), ("back", 1)])
@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_hits_of_one_side(expected, kind, facing, side):
    for vertices, faces, rays, hits in expected:
        tree = kind(vertices, faces)
        floats = np.ascontiguousarray(rays).view(np.float32).reshape(-1, 8)
        of_side = [[hit for hit in of_ray if side_of(floats[i], vertices[faces[hit[3]]]) == side]
                   for i, of_ray in enumerate(hits)]
        assert 0 < sum(map(len, of_side)) < sum(map(len, hits))
        first = [h[0] if h else (np.inf, 0, 0, raylanes.no_primitive) for h in of_side]
        for mode in ("automatic", "single", "packet", "stream"):
            assert [h.item() for h in tree.closest(rays, facing=facing, mode=mode)] == first
            assert tree.occluded(rays, facing=facing, mode=mode).tolist() == [bool(h) for h in of_side]
        assert [[h.item() for h in lists] for lists in tree.all_hits(rays, facing=facing)] == of_side
        crossed = [lists.side[lists.side == side] for lists in tree.crossings(rays)]
        assert [len(c) for c in crossed] == tree.crossings(rays, facing=facing).counts.tolist()
        counts = tree.count_crossings(rays, facing=facing)
        assert counts["crossings"].tolist() == [len(c) for c in crossed]
        assert (counts["winding"] == side * counts["crossings"].astype(int)).all()
    points = rays.view(np.float32).reshape(-1, 8)[:, :3]
    to_light, other = raylanes.rays(points, np.float32([0, 0, 9]) - points, tmax=1), {"front": "back", "back": "front"}
    assert same(tree.occluded_from([0, 0, 9], points, facing=facing), tree.occluded(to_light, facing=other[facing]))
    assert same(tree.occluded_towards([1, 2, 9], points, facing=facing),
                tree.occluded(raylanes.rays(points, [1, 2, 9]), facing=facing))


def test_a_side_is_a_name_and_of_the_exact_test():
    tree, rays = cube(), raylanes.rays([[0.1, 0.2, 5]], [0, 0, -1])
    for call in (tree.closest, tree.occluded, tree.all_hits, tree.crossings, tree.count_crossings):
        with pytest.raises(ValueError, match="facing"):
            call(rays, facing="side")
        with pytest.raises(TypeError):
            call(rays, facing=1)
    with pytest.raises(ValueError, match="exact"):
        tree.closest(rays, facing="front", test="watertight")


def test_any_bits_are_rays_to_all_trees_and_paths():
    tree, other = (kind(*sphere(triangles=200)) for kind in (raylanes.Bvh, raylanes.KdTree))
    rays, points = any_bits(1, 1000, raylanes.ray_dtype), any_bits(2, 3000, np.dtype("f4")).reshape(-1, 3)
    rays[::2]["origin"] = random_rays(3, 500)["origin"]
    hits, close = tree.closest(rays), tree.closest_points(points)
    located = tree.locate(points)
    for path in supported:
        with raylanes.use_path(path):
            for each in (tree, other):
                assert same(each.closest(rays), hits)
                assert same(each.occluded(rays), hits.hit)
                assert same(each.all_hits(rays, max_count=1).items, hits[hits.hit])
                assert same(each.closest_points(points), close)
                assert same(each.locate(points), located)
    assert not hits.hit[~np.isfinite(rays["origin"]).all(axis=1)].any()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_stretches_have_the_lengths_within_a_box(kind, dtype):
    if kind is raylanes.KdTree and dtype is np.float64:
        pytest.skip("no k-d trees of doubles")
    tree, random = cube(kind, dtype=dtype), np.random.default_rng(6)
    origins = random.uniform(-3, 3, (500, 3))
    targets = random.choice([-1.0, 1.0], (500, 3))
    targets[::2, 0] = random.uniform(-1, 1, 250)  # corners, and points of edges
    rays = raylanes.rays(origins, targets - origins, dtype=dtype)
    lists = tree.stretches(rays)
    slabs = np.sort((np.array([[-1.0], [1.0]])[:, None] - rays["origin"].astype(float)) / rays["direction"], axis=0)
    begin, end = np.maximum(slabs[0].max(axis=1), 0), slabs[1].min(axis=1)
    lengths = np.bincount(lists.ray, (lists.items.exit - lists.items.entry) * lists.items.winding, minlength=500)
    assert np.abs(lengths - np.maximum(end - begin, 0)).max() < 1e-4
    inside = np.abs(rays["origin"]).max(axis=1) < 1
    assert (lists.counts[inside] == 1).all() and (lists.items.winding == 1).all() and lists.counts.max() == 1
    first = [of_ray[0] for of_ray, within in zip(lists, inside) if within]
    assert all(one.entry == 0 and one.entered_by == raylanes.no_primitive for one in first)
    assert isinstance(first[0], raylanes.Stretch) and lists.items.left_by.dtype == np.uint32


@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_a_closed_mesh_is_left_as_often_as_entered(kind):
    tree, random = cube(kind), np.random.default_rng(5)
    origins = random.choice([-3, -2, 2, 3], (500, 3))
    rays = raylanes.rays(origins, random.choice([-1, 0, 1], (500, 3)) - origins)  # at corners, edges, diagonals
    crossings, counts = tree.crossings(rays), tree.count_crossings(rays)
    assert same(crossings.counts.astype(np.uint32), counts["crossings"].copy())
    assert set(counts["crossings"]) == {0, 2} and not counts["winding"].any()
    through = [of_ray for of_ray in crossings if len(of_ray) and of_ray.t[0] < of_ray.t[1]]
    assert len(through) > 100 and all(list(of_ray.side) == [-1, 1] for of_ray in through)
    assert np.abs(np.max(np.abs(crossings.positions(rays)), axis=1) - 1).max() < 1e-6


def solid_angles(triangles, points):
    """The sum over triangles of the solid angles that points see them at, over 4 pi."""
    a, b, c = np.moveaxis(triangles.astype(float) - points[:, None, None, :], 2, 0)
    la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
    dot = [np.sum(u * v, axis=-1) for u, v in ((a, b), (b, c), (c, a))]
    volume = np.sum(a * np.cross(b, c), axis=-1)
    halves = np.arctan2(volume, la * lb * lc + dot[0] * lc + dot[1] * la + dot[2] * lb)
    return halves.sum(axis=-1) / (2 * np.pi)


@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_points_of_a_cube(kind):
    axis = np.arange(-8, 9) / 4
    points = np.stack(np.meshgrid(axis, axis, axis), axis=-1)  # (17, 17, 17, 3)
    tree, far = cube(kind), np.max(np.abs(points), axis=-1)
    assert same(tree.locate(points), np.select([far < 1, far == 1], [raylanes.INSIDE, raylanes.ON]).astype(np.uint8))
    assert same(tree.inside(points), far <= 1)
    outside = np.sqrt(np.sum(np.maximum(np.abs(points) - 1, 0) ** 2, axis=-1))
    expected = np.where(far > 1, outside, far - 1)
    distance = tree.signed_distances(points)
    assert distance.dtype == np.float32 and np.abs(distance - expected).max() < 2e-7
    assert same(np.sign(distance), np.sign(far - 1).astype(np.float32))
    band = tree.signed_distances(points, max_distance=0.25)
    near = np.abs(expected) <= 0.25
    assert same(band[near], distance[near]) and same(band[~near], np.copysign(np.float32(np.inf), distance[~near]))
    close = tree.closest_points(points)
    assert np.abs(close.distance - np.abs(expected)).max() < 2e-7 and close.primitive.max() < 12
    assert np.abs(np.linalg.norm(close.point - points, axis=-1) - close.distance).max() < 1e-6
    holed = kind(cube_vertices, cube_faces[1:])
    assert same(holed.locate(points[far < 1], rule="vote"), np.full((far < 1).sum(), raylanes.INSIDE))
    whole = tree.winding_numbers(points)
    assert whole.dtype == np.float32 and same(whole[far != 1], (far[far != 1] < 1).astype(np.float32))
    summed = solid_angles(cube_vertices[cube_faces[1:]], points[far != 1])
    for accuracy in (0, 1e-3):
        numbers = holed.winding_numbers(points, accuracy=accuracy)[far != 1]
        assert np.abs(numbers - summed).max() < accuracy + 1e-6
    assert same(holed.inside(points[far != 1], rule="winding"), holed.winding_numbers(points)[far != 1] >= 0.5)
    near = tree.closest_points(points, max_distance=0.5)
    assert same(near[np.abs(expected) <= 0.5], close[np.abs(expected) <= 0.5])
    assert np.isinf(near.distance[np.abs(expected) > 0.5]).all()


@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_a_rule_of_inside_reaches_the_library(kind):
    """In a cube within a cube, both outwards: crossed twice, so outside by parity and inside by nonzero."""
    nested = kind(np.concatenate([cube_vertices, cube_vertices / 2]), np.concatenate([cube_faces, cube_faces + 8]))
    centre = np.zeros((1, 3), np.float32)
    for rule in ("parity", "vote"):
        assert nested.locate(centre, rule=rule)[0] == raylanes.OUTSIDE
    assert nested.locate(centre, rule="nonzero")[0] == raylanes.INSIDE
    distances = [nested.signed_distances(centre, rule=rule)[0] for rule in ("parity", "nonzero")]
    assert distances == [0.5, -0.5]


def test_builders_make_different_trees():
    for kind in (raylanes.Bvh, raylanes.KdTree):
        trees = [kind(*sphere(), builder=builder).report() for kind_of, builder in tree_kinds if kind_of is kind]
        assert len({(tree["bytes"], tree["sah_cost"]) for tree in trees}) == len(trees)


def test_shadows_from_a_point():
    tree, light = raylanes.Bvh(*sphere()), np.array([3, 0, 0], np.float32)
    points = random_rays(7, 3000)["origin"]
    dark = tree.occluded_from(light, points, end=1.0)
    assert same(dark, tree.occluded(raylanes.rays(points, light - points, 0, 1))) and 0 < dark.mean() < 1
    assert same(dark, tree.occluded_from(light, points, end=1.0, hint="shared_origin", mode="single"))


@pytest.mark.parametrize("builder", ["binned_sah", "spatial_splits"])
def test_a_refit_tree_answers_as_a_new_one(builder):
    vertices, faces = sphere()
    tree, rays = raylanes.Bvh(vertices, faces, builder=builder, optimize=True), random_rays(8, 2000)
    moved = vertices * np.float32(1.5) + np.float32(0.25)
    tree.refit(moved, faces)
    new = raylanes.Bvh(moved, faces)
    assert same(tree.closest(rays), new.closest(rays)) and same(tree.bounds, new.bounds)
    assert tree.decay() == pytest.approx(1, abs=0.5) and tree.sah_cost() > 0
    with pytest.raises(ValueError, match="triangles"):
        tree.refit(moved, faces[:-1])
    assert same(tree.closest(rays), new.closest(rays))


@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_trees_keep_nothing_of_arrays(kind):
    vertices, faces = sphere()
    tree, rays = kind(vertices, faces), random_rays(9, 500)
    before = tree.closest(rays)
    vertices[:], faces[:] = np.nan, -1
    assert same(tree.closest(rays), before) and before.hit.any()


@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_an_empty_mesh_is_hit_by_nothing(kind):
    for vertices, faces in (([], []), (np.zeros((0, 3)), np.zeros((0, 3), int)), (cube_vertices, [])):
        tree, rays = kind(vertices, faces), random_rays(1, 10)
        assert not tree.closest(rays).hit.any() and len(tree.all_hits(rays).items) == 0
        assert not tree.inside(rays["origin"]).any() and np.isinf(tree.signed_distances(rays["origin"])).all()
        assert (tree.bounds == [[np.inf] * 3, [-np.inf] * 3]).all()


def test_what_is_wrong_is_a_value_error():
    for wrong, sentence in [(lambda: raylanes.Bvh(cube_vertices, cube_faces + 1), "index 8 is out of range"),
                            (lambda: raylanes.Bvh(cube_vertices, cube_faces - 1), "index -1 is out of range"),
                            (lambda: raylanes.KdTree(cube_vertices * np.nan, cube_faces), "coordinate x is nan"),
                            (lambda: cube(builder="best"), 'no "best", but median'),
                            (lambda: cube().closest(random_rays(1, 2), test="none"), 'no "none", but exact'),
                            (lambda: cube().closest(random_rays(1, 2), test="precomputed"),
                             'no "precomputed", but exact, watertight, moller_trumbore$'),
                            (lambda: cube().closest(random_rays(1, 2), threads=-1), "-1 threads"),
                            (lambda: cube().locate(cube_vertices, rule="odd"), 'no "odd", but parity'),
                            (lambda: cube().winding_numbers(cube_vertices, accuracy=-1e-9), "accuracy -1e-09, allowed"),
                            (lambda: cube().winding_numbers(cube_vertices, accuracy=-1e-300), "accuracy -1e-300, all"),
                            (lambda: cube().winding_numbers(cube_vertices, accuracy=np.nan), "accuracy nan, allowed"),
                            (lambda: raylanes.use_path("mmx").__enter__(), 'no path "mmx"')]:
        with pytest.raises(ValueError, match=sentence):
            wrong()


def test_whether_a_mesh_is_closed():
    assert raylanes.closed_report(cube_vertices, cube_faces)["is_closed"]
    report = raylanes.closed_report(cube_vertices, cube_faces[1:], max_listed=2)
    assert not report["has_parity"] and report["open"] == 3 and [f[0] for f in report["first"]] == ["open"] * 2


@pytest.mark.parametrize("kind, dtype", [(raylanes.Bvh, np.float32), (raylanes.Bvh, np.float64),
                                         (raylanes.KdTree, np.float32)])
def test_normals_need_no_mesh(kind, dtype):
    vertices, faces, rays = lattice(7)
    faces = np.concatenate([faces[:5], faces[:1] * 0, faces[5:]])  # one triangle has no leaf
    with pytest.warns(raylanes.MeshWarning):
        tree = kind(vertices.astype(dtype), faces, dtype=dtype)
    hits = tree.closest(rays)
    assert hits.hit.any() and not hits.hit.all()
    assert hits.normals(tree).tobytes() == hits.normals(vertices.astype(dtype), faces).tobytes()
    grid = hits[:6].reshape(2, 3)
    assert grid.normals(tree).tobytes() == hits[:6].normals(tree).tobytes() and grid.normals(tree).shape == (2, 3, 3)
    assert hits[0].normals(tree).shape == (3,) and hits[:0].normals(tree).shape == (0, 3)
    assert tree.closest_points(vertices).normals(tree).tobytes() == tree.closest_points(vertices).normals(
        vertices.astype(dtype), faces).tobytes()
    if dtype == np.float32 and kind is raylanes.Bvh:
        scene = raylanes.Scene()
        scene.place(scene.add(tree), [[0, 0, -1, 0], [0, 2, 0, 0], [1, 0, 0, 3]])
        scene.update()
        found = scene.closest(rays)
        assert found.normals(scene, [tree]).tobytes() == found.normals(scene, [(vertices, faces)]).tobytes()
