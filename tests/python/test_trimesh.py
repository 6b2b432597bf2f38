"""trimesh's interface, with a mesh that has what is asked of it: shapes, types, order, and what its users met."""

import pickle
import subprocess
import sys

import numpy as np
import pytest

import rational
import raylanes
from meshes import cube_faces, cube_vertices, sphere
from raylanes.trimesh import ProximityQuery, RayMeshIntersector, closest_point, signed_distance
from raylanes.trimesh.proximity import nearest_offsets


class Mesh:
    def __init__(self, vertices, faces):
        self.vertices, self.faces = np.array(vertices, np.float64), np.array(faces, np.int64)

    @property
    def bounds(self):
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])


def box(low=(0, 0, 0), high=(1, 1, 1)):
    low, high = np.float64(low), np.float64(high)
    return Mesh(low + (cube_vertices.astype(np.float64) + 1) / 2 * (high - low), cube_faces)


def crossing_rays(mesh, count=500, seed=1):
    """Origins around a mesh and directions towards points in its box."""
    random = np.random.default_rng(seed)
    low, high = mesh.bounds
    middle, size = low / 2 + high / 2, high - low
    origins = middle + size * random.normal(size=(count, 3)) * 2
    return origins, middle + size * random.uniform(-0.6, 0.6, (count, 3)) - origins


def test_shapes_types_and_order():
    ray, (origins, directions) = RayMeshIntersector(box()), crossing_rays(box())
    index_tri, index_ray = ray.intersects_id(origins, directions)
    assert index_tri.dtype == index_ray.dtype == np.int64 and index_tri.shape == index_ray.shape
    tri, of, locations = ray.intersects_id(origins, directions, return_locations=True)
    assert (tri == index_tri).all() and (of == index_ray).all()
    assert locations.dtype == np.float64 and locations.shape == (len(tri), 3)
    assert (np.diff(index_ray) >= 0).all()
    along = np.einsum("hx,hx->h", locations - origins[of], directions[of])
    assert (along >= 0).all() and (np.diff(along)[np.diff(of) == 0] >= -1e-9).all()
    locations, of, tri = ray.intersects_location(ray_origins=origins, ray_directions=directions, multiple_hits=True)
    assert locations.shape == (len(of), 3) and of.shape == tri.shape == (len(of),)
    first, any_hit = ray.intersects_first(origins, directions), ray.intersects_any(origins, directions)
    assert first.dtype == np.int64 and first.shape == (500,) and any_hit.dtype == bool and any_hit.shape == (500,)
    assert ((first == -1) == ~any_hit).all() and 0 < any_hit.mean() < 1
    contains = ray.contains_points(origins)
    assert contains.dtype == bool and contains.shape == (500,)


def test_one_hit_and_some():
    ray, (origins, directions) = RayMeshIntersector(box()), crossing_rays(box())
    first = ray.intersects_first(origins, directions)
    tri, of, locations = ray.intersects_id(origins, directions, multiple_hits=False, return_locations=True)
    assert (of == np.flatnonzero(first >= 0)).all() and (tri == first[of]).all() and len(locations) == len(of)
    again = ray.intersects_location(origins, directions, multiple_hits=False)
    assert (again[0] == locations).all() and (again[1] == of).all() and (again[2] == tri).all()
    every = ray.intersects_id(origins, directions)
    for most in (1, 2, 3):
        tri, of = ray.intersects_id(origins, directions, True, most)
        kept = np.concatenate([np.flatnonzero(every[1] == i)[:most] for i in range(len(origins))])
        assert (tri == every[0][kept]).all() and (of == every[1][kept]).all()


def test_nothing_is_hit():
    ray = RayMeshIntersector(box())
    for origins, directions in [(np.zeros((0, 3)), np.zeros((0, 3))), ([], []), ([[5, 5, 5]], [[1, 0, 0]]),
                                ([[np.nan, 0, 0]], [[1, 0, 0]]), ([[0.5, 0.5, 5]], [[0, 0, 0]]),
                                ([[0.5, 0.5, 5]], [[0, 0, np.inf]]), ([[0.5, 0.5, 1e300]], [[0, 0, 1]])]:
        tri, of, locations = ray.intersects_id(origins, directions, return_locations=True)
        assert tri.shape == of.shape == (0,) and locations.shape == (0, 3) and tri.dtype == of.dtype == np.int64
        assert [len(x) for x in ray.intersects_location(origins, directions)] == [0, 0, 0]
        assert (ray.intersects_first(origins, directions) == -1).all()
        assert not ray.intersects_any(origins, directions).any()
    empty = Mesh(np.zeros((0, 3)), np.zeros((0, 3)))
    assert not RayMeshIntersector(empty).intersects_any([[0, 0, 0]], [[0, 0, 1]]).any()
    assert not RayMeshIntersector(empty).contains_points([[0, 0, 0]]).any()
    closest, distance, triangle = closest_point(empty, [[0, 0, 0]])
    assert np.isnan(closest).all() and np.isinf(distance).all() and (triangle == -1).all()


@pytest.mark.parametrize("scale", [1e-30, 1e-9, 1e-3, 1, 12345.678, 1e9, 1e30])
@pytest.mark.parametrize("offset", [0, 1e6])
def test_answers_do_not_depend_on_scale_and_place(scale, offset):
    """A ball is hit alike in metres and millimetres, also far away: in doubles 1e6 sizes away 30 bits are left."""
    ball = Mesh(*sphere(triangles=500))
    origins, directions = crossing_rays(ball)
    expected = RayMeshIntersector(ball).intersects_id(origins, directions, return_locations=True)
    moved = Mesh((ball.vertices + offset) * scale, ball.faces)
    at = (origins + offset) * scale
    tri, of, locations = RayMeshIntersector(moved).intersects_id(at, directions * 1e3, return_locations=True)
    assert len(tri) > 300 and (tri == expected[0]).all() and (of == expected[1]).all()
    assert np.abs(locations / scale - offset - expected[2]).max() <= 1e-8 + offset * 1e-14
    assert (RayMeshIntersector(moved).contains_points(at) == RayMeshIntersector(ball).contains_points(origins)).all()


def test_locations_are_those_of_doubles():
    mesh = box((0.1, 0.2, 0.3), (1.7, 2.9, 3.3))
    origins, directions = crossing_rays(mesh, 2000)
    locations, of, _ = RayMeshIntersector(mesh).intersects_location(origins, directions)
    low, high = mesh.bounds
    with np.errstate(divide="ignore"):
        slabs = np.sort(((np.stack([low, high])[:, None] - origins) / directions), axis=0)  # (2, n, 3)
    enters, leaves = slabs[0].max(axis=1), slabs[1].min(axis=1)
    times = np.stack([enters, leaves], axis=1)
    ahead = (times >= 0) & (enters <= leaves)[:, None]
    places = origins[:, None] + times[..., None] * directions[:, None]
    sure = np.abs(enters - leaves) > 1e-5  # else by an edge, within what rounding moves
    assert (ahead.sum(axis=1) == np.bincount(of, minlength=2000))[sure].all()
    assert np.abs(locations[sure[of]] - places[ahead & sure[:, None]]).max() < 1e-12


def test_locations_of_grazing_rays_are_on_the_mesh():
    """What rounding moves such a ray by moves its hit by far more, in the triangle's plane."""
    mesh, random = box((0.1, 0.1, 0.1), (1.3, 1.3, 1.3)), np.random.default_rng(5)
    above = 1.3 + random.uniform(0, 4e-6, 2000)
    origins = np.column_stack([np.full(2000, -0.5), random.uniform(0.2, 1.2, 2000), above])
    directions = np.column_stack([np.ones(2000), np.zeros(2000), random.uniform(-2e-6, 0, 2000)])
    locations, of, _ = RayMeshIntersector(mesh).intersects_location(origins, directions)
    assert len(of) > 500 and np.abs(np.max(np.abs(locations - 0.7), axis=1) - 0.6).max() < 1.2 * 2.0**-20
    off = locations - origins[of]
    assert np.abs(off[:, 1:] - off[:, :1] * directions[of, 1:]).max() < 1.2 * 2.0**-20


def test_a_ray_from_far_away_is_as_good_as_a_near_one():
    ball = Mesh(*sphere(triangles=500))
    origins, directions = crossing_rays(ball, 1000)
    unit = directions / np.linalg.norm(directions, axis=1)[:, None]
    ray = RayMeshIntersector(ball)
    near = ray.intersects_location(origins, directions)
    for distance in (1e2, 1e5):
        far = ray.intersects_location(origins - distance * unit, directions)
        ahead = np.einsum("hx,hx->h", far[0] - origins[far[1]], unit[far[1]]) > 0
        assert ahead.sum() == len(near[1]) and (far[1][ahead] == near[1]).all()
        assert np.abs(far[0][ahead] - near[0]).max() < 1e-9


def test_rays_at_corners_and_edges():
    """What disagrees where hits at edges are rounding errors: every method here sees the same hits."""
    mesh = box((-1, -1, -1), (1, 1, 1))
    ray, random = RayMeshIntersector(mesh), np.random.default_rng(2)
    origins = random.choice([-3, -2, 2, 3], (500, 3)).astype(float)
    directions = random.choice([-1, -0.5, 0, 0.5, 1], (500, 3)) - origins
    tri, of = ray.intersects_id(origins, directions)
    assert (np.bincount(of, minlength=500) > 0).tolist() == ray.intersects_any(origins, directions).tolist()
    triangles = [[rational.fractions(corner) for corner in corners] for corners in mesh.vertices[mesh.faces]]
    for i, made in enumerate(raylanes.rays(origins, directions)):
        hits = sorted((t[0], k) for k, t in enumerate(rational.hit(made, corners) for corners in triangles) if t)
        assert tri[of == i].tolist() == [k for _, k in hits]
    locations, of, _ = ray.intersects_location(origins, directions)
    assert len(np.unique(np.column_stack([of, locations]), axis=0)) == len(of)  # a place is one hit
    assert np.abs(np.max(np.abs(locations), axis=1) - 1).max() < 1e-15


@pytest.mark.parametrize("offset", [(1e5, 1e6, 0), (5e5, 4e6, -1e3)])
def test_rays_are_those_of_the_doubles(offset):
    """Hits far from zero, against exact arithmetic, some at corners and edges; directions of any length."""
    ball, random = sphere(triangles=60), np.random.default_rng(6)
    mesh = Mesh(ball[0].astype(float) * 1e-3 + offset, ball[1])
    origins = random.uniform(-3e-3, 3e-3, (200, 3)) + offset
    directions = random.normal(size=(200, 3))
    directions[::2] = (mesh.vertices[random.integers(0, len(mesh.vertices), 200)] - origins)[::2]
    triangles = [[rational.fractions(corner) for corner in corners] for corners in mesh.vertices[mesh.faces]]
    made = [sorted((t[0], k) for k, t in enumerate(rational.hit(ray, corners) for corners in triangles) if t)
            for ray in raylanes.rays(origins, directions)]
    assert sum(map(len, made)) > 200
    for length in (1, 2.0**-900, 2.0**900):
        tri, of = RayMeshIntersector(mesh).intersects_id(origins, directions * length)
        assert [tri[of == i].tolist() for i in range(200)] == [[k for _, k in hits] for hits in made]


def test_directions_that_a_scale_would_round():
    """A component that is 2^-1080 of another one decides on which side of an edge the ray passes."""
    mesh = Mesh([[1, 0, 0], [1, 1, 0], [1, 0, 1], [1, 0, -1]], [[0, 1, 2], [0, 3, 1]])
    directions = [[2.0**1000, 2.0**999, 2.0**-80], [2.0**1000, 2.0**999, -(2.0**-80)], [2.0**1000, 2.0**999, 0]]
    tri, of = RayMeshIntersector(mesh).intersects_id(np.zeros((3, 3)), directions)
    assert tri.tolist() == [0, 1, 0, 1] and of.tolist() == [0, 1, 2, 2]
    # In lengths of this direction the distance is 2^1080, which is no double.
    tri, of = RayMeshIntersector(mesh).intersects_id([[-1023, 0.5, 0.25]], [[2.0**-1070, 0, 0]])
    assert tri.tolist() == [0]


def test_small_parts_of_large_meshes():
    """A ball of a millimetre in a hall of ten kilometres keeps its triangles."""
    hall, ball = box((0, 0, 0), (1e4, 1e4, 1e4)), sphere(triangles=300)
    centre = np.array([7000.1, 2000.2, 3000.3])
    vertices = np.concatenate([hall.vertices, ball[0].astype(float) * 1e-3 + centre])
    mesh = Mesh(vertices, np.concatenate([hall.faces, ball[1][:, ::-1] + 8]))  # a hole in the hall
    ray = RayMeshIntersector(mesh)
    assert ray.contains_points([centre, centre + 2e-3, centre - 1e5]).tolist() == [False, True, False]
    tri, _, at = ray.intersects_id([centre - [5, 1.1e-4, 2.3e-4]], [[1, 0, 0]], return_locations=True)
    assert len(tri) == 3 and (tri[:2] >= 12).all() and tri[2] < 12
    assert np.abs(at[0] - centre).max() < 1.2e-3 and at[0, 0] < centre[0] < at[1, 0]
    assert signed_distance(mesh, [[5000, 5000, 9000.0]]) == pytest.approx(1000, abs=1e-9)
    near = raylanes.Bvh(*ball).closest_points([[2, 0, 0], [0, 0.1, 3]])
    closest, distance, triangle = closest_point(mesh, centre + 1e-3 * np.array([[2, 0, 0], [0, 0.1, 3]]))
    assert np.abs(distance - 1e-3 * near.distance).max() < 1e-9 and (triangle >= 12).all()
    assert np.abs(closest - centre - 1e-3 * near.point).max() < 1e-9


def test_layers_close_to_each_other_are_all_hit():
    """Where others move the origin behind each hit, those nearer than the step are lost."""
    heights = np.concatenate([np.arange(8) * 1e-6, [0.5, 0.5, 1]])  # two of them coincide
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    vertices = [[x, y, z] for z in heights for x, y in square]
    faces = [[4 * i + a, 4 * i + b, 4 * i + c] for i in range(len(heights)) for a, b, c in [(0, 1, 2), (0, 2, 3)]]
    ray = RayMeshIntersector(Mesh(vertices, faces))
    tri, of, locations = ray.intersects_id([[0.3, 0.6, -1]], [[0, 0, 1]], return_locations=True)
    assert (tri == 2 * np.arange(11) + 1).all() and np.abs(locations[:, 2] - heights).max() < 1e-15
    assert len(ray.intersects_location([[0.3, 0.6, -1]], [[0, 0, 1]])[0]) == 10


def test_what_is_inside():
    mesh = box((0, 0, 0), (1, 1, 1))
    ray = RayMeshIntersector(mesh)
    axis = np.arange(-2, 7) / 4
    points = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    expected = ((points >= 0) & (points <= 1)).all(axis=1)
    for _ in range(3):
        assert (ray.contains_points(points) == expected).all()
    distance = signed_distance(mesh, points)
    outside = np.linalg.norm(points - np.clip(points, 0, 1), axis=1)
    inside = np.minimum(points, 1 - points).min(axis=1)
    assert np.abs(distance - np.where(expected, inside, -outside)).max() < 1e-15
    assert not ray.contains_points([[np.nan, 0, 0], [1e300, 0, 0]]).any()
    within = points[((points > 0) & (points < 1)).all(axis=1)]
    for missing in range(12):  # one triangle: a ray through the hole is one of six
        holed = Mesh(mesh.vertices, np.delete(mesh.faces, missing, axis=0))
        assert RayMeshIntersector(holed).contains_points(within).all()
        assert (signed_distance(holed, within) > 0).all()


@pytest.mark.parametrize("offset, scale", [(0, 1), (1000, 1), (0, 1e-20)])
def test_closest_points_are_those_of_doubles(offset, scale):
    mesh = Mesh(*sphere(triangles=300))
    mesh.vertices = (mesh.vertices + offset) * scale
    points = (np.random.default_rng(3).uniform(-2, 2, (300, 3)) + offset) * scale
    closest, distance, triangle = ProximityQuery(mesh).on_surface(points)
    assert closest.shape == (300, 3) and distance.shape == (300,) and triangle.dtype == np.int64
    assert np.abs(np.linalg.norm(closest - points, axis=1) - distance).max() <= (1e-15 + offset * 1e-15) * scale
    corners = mesh.vertices[mesh.faces]
    weights = np.random.default_rng(4).dirichlet((0.5, 0.5, 0.5), (len(corners), 40))
    samples = np.einsum("fsk,fkx->fsx", weights, corners).reshape(-1, 3)
    for i in range(0, 300, 5):
        nearest = np.linalg.norm(samples - points[i], axis=1)
        assert distance[i] <= nearest.min() + 1e-6 * scale
        assert distance[i] >= nearest.min() - 0.05 * scale  # samples are that dense
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[triangle]
    on_plane = np.abs(np.einsum("nx,nx->n", normals, closest - corners[triangle, 0])) / np.linalg.norm(normals, axis=1)
    assert on_plane.max() <= (1e-14 + offset * 1e-14) * scale
    sign = np.where(RayMeshIntersector(mesh).contains_points(points), 1, -1)
    assert (signed_distance(mesh, points) == sign * distance).all()


def test_points_beyond_a_sharp_edge():
    """The case test_acute_edge_case of trimesh: two triangles share the closest point, one faces the query."""
    mesh = Mesh([[-1, 0.5, 0], [1, 0.5, 0], [0, -1, -0.5], [0, -1, 0.5]], [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]])
    z = np.linspace(-1, 1, 20)
    points = np.column_stack([np.zeros(20), np.ones(20), z])
    for turn in range(4):  # whatever the order of triangles
        mesh.faces = np.roll(mesh.faces, 1, axis=0)
        closest, _, triangle = closest_point(mesh, points)
        facing = [np.flatnonzero((np.sort(mesh.faces, axis=1) == corners).all(axis=1))[0] for corners in ([0, 1, 2],
                                                                                                       [0, 1, 3])]
        assert (triangle == np.where(z < 0, *facing)).all() and np.abs(closest - [0, 0.5, 0]).max() < 1e-15


@pytest.mark.parametrize("scale, offset", [(1, 0), (1e-9, 0), (1e9, 0), (1, 1)])
def test_parts_of_the_surface_that_are_as_near(scale, offset):
    """The case test_returns_correct_point_in_ambiguous_cases of trimesh, and walls at other angles."""
    mesh = Mesh([[0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, -1]], [[0, 1, 2], [0, 1, 3]])
    mesh.vertices = (mesh.vertices + offset) * scale
    closest, _, triangle = closest_point(mesh, (np.array([[-0.25 - 1e-9, 0.0, -0.25]]) + offset) * scale)
    assert triangle[0] == 1 and np.abs(closest[0] / scale - offset - [0, 0, -0.25]).max() < 3e-9
    for angle in (0.02, 0.3, 1, 2, 3, np.pi):
        wall = np.array([[1, -1, -1], [1, 1, -1], [1, 0, 1.0]])
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        vertices = (np.concatenate([wall, wall @ turn.T]) + offset) * scale
        for faces in ([[0, 1, 2], [3, 5, 4]], [[3, 5, 4], [0, 1, 2]], [[0, 2, 1], [3, 4, 5]], [[3, 4, 5], [0, 2, 1]]):
            mesh = Mesh(vertices, faces)
            _, _, triangle = closest_point(mesh, np.full((1, 3), offset * scale))
            normal = np.cross(*(vertices[faces[triangle[0]]][1:] - vertices[faces[triangle[0]]][0]))
            assert normal @ (vertices[faces[triangle[0]][0]] - offset * scale) < 0


def test_ties_go_to_the_triangle_that_faces_the_point():
    """Meshes on a coarse lattice, beside all triangles in turn."""
    checked = 0
    for seed in range(20):
        random = np.random.default_rng(seed)
        mesh = Mesh(random.integers(-2, 3, (12, 3)), random.integers(0, 12, (30, 3)))
        mesh.faces[1] = mesh.faces[0, [1, 0, 2]]  # the same triangle seen from behind
        points = random.integers(-8, 9, (60, 3)) / 2.0
        closest, distance, triangle = ProximityQuery(mesh).on_surface(points)
        corners = mesh.vertices[mesh.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        proper = np.flatnonzero(np.linalg.norm(normals, axis=1) > 0)
        normals[proper] /= np.linalg.norm(normals[proper], axis=1)[:, None]
        for i in range(len(points)):
            offsets = nearest_offsets(corners[proper] - points[i])[0]
            every = np.linalg.norm(offsets, axis=1)
            assert distance[i] <= every.min() * (1 + 2.0**-23) + 1e-15
            if distance[i] == 0 or triangle[i] not in proper:
                continue
            span = mesh.faces[triangle[i]][nearest_offsets(corners[triangle[i], None] - points[i])[1][0]]
            spanned = (mesh.vertices[span][:, None] == corners[proper, None]).all(axis=-1).any(axis=2).all(axis=1)
            here = proper[spanned]  # share the closest corner or edge, or all corners
            assert np.linalg.norm(points[i] + offsets[spanned] - closest[i], axis=1).max() < 1e-12
            cosines = normals[here] @ (points[i] - closest[i]) / distance[i]
            checked += len(here) > 1
            assert triangle[i] == here[cosines > cosines.max() - 1e-12].min()
    assert checked > 300


def test_slivers_and_points_are_triangles_too():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]], [[0, 1, 2], [3, 3, 3]])
    closest, distance, triangle = closest_point(mesh, [[1.5, 1, 0], [-1, 0, 0], [5, 5, 5]])
    assert np.allclose(closest[:2], [[1.5, 0, 0], [0, 0, 0]], atol=1e-12) and (triangle == 0).all()
    assert np.allclose(distance[:2], [1, 1], atol=1e-12)


def test_a_mesh_that_changes():
    mesh = box()
    ray, near = RayMeshIntersector(mesh), ProximityQuery(mesh)
    assert not ray.contains_points([[2, 2, 2]])[0] and near.on_surface([[3, 3, 3]])[1][0] == pytest.approx(12**0.5)
    tree = ray.of_mesh()
    assert ray.of_mesh() is tree
    mesh.vertices *= 4
    assert ray.contains_points([[2, 2, 2]])[0] and near.signed_distance([[3, 3, 3]])[0] == 1
    mesh.faces = mesh.faces[:0]
    assert not ray.contains_points([[2, 2, 2]])[0]


def test_wrong_arguments():
    ray = RayMeshIntersector(box())
    for wrong in (lambda: ray.intersects_id([[0, 0, 0]], [[0, 0, 1]] * 2),
                  lambda: ray.intersects_any([0, 0, 0], [0, 0, 1]),
                  lambda: ray.contains_points([[0, 0]]), lambda: closest_point(box(), np.zeros((2, 2))),
                  lambda: RayMeshIntersector(Mesh([[0, 0, 0]], [[0, 0, 1]])).contains_points([[0, 0, 0]]),
                  lambda: RayMeshIntersector(Mesh([[0, 0, np.nan]], [[0, 0, 0]])).contains_points([[0, 0, 0]])):
        with pytest.raises(ValueError, match="shape|ray_directions|out of range|is nan"):
            wrong()


def test_vertices_that_no_face_uses():
    """Also NaN and infinity, which nothing makes another mesh."""
    mesh, whole = box(), box()
    mesh.vertices = np.concatenate([mesh.vertices, [[np.nan, 0, 0], [0, np.inf, 9]]])
    ray, near = RayMeshIntersector(mesh), ProximityQuery(mesh)
    points = np.random.default_rng(1).uniform(-1, 2, (50, 3))
    assert (ray.contains_points(points) == RayMeshIntersector(whole).contains_points(points)).all()
    for found, expected in zip(near.on_surface(points), closest_point(whole, points)):
        assert (found == expected).all()
    assert ray.of_mesh() is ray.of_mesh()


def test_words_of_trimesh():
    """Those of its two intersectors, by the names that they have there; others are refused."""
    mesh, rays = box(), {"ray_origins": [[0.5, 0.5, 3]], "ray_directions": [[0, 0, -1]]}
    for ray in (RayMeshIntersector(mesh), RayMeshIntersector(mesh, False), RayMeshIntersector(geometry=mesh),
                RayMeshIntersector(geometry=mesh, scale_to_box=False), RayMeshIntersector(mesh=mesh)):
        assert len(ray.intersects_id(**rays, multiple_hits=False, max_hits=3, return_locations=True)) == 3
        assert len(ray.intersects_location(**rays, multiple_hits=False)[0]) == 1
        assert ray.intersects_first(**rays)[0] >= 0 and ray.intersects_any(**rays)[0]
        for method in (ray.intersects_id, ray.intersects_location, ray.intersects_first, ray.intersects_any):
            with pytest.raises(TypeError, match="multiple_hit"):
                method(**rays, multiple_hit=False)
    for meshes in ({}, {"mesh": mesh, "geometry": mesh}):
        with pytest.raises(TypeError, match="^RayMeshIntersector: one mesh is needed"):
            RayMeshIntersector(**meshes)


def test_pickles_and_needs_no_trimesh():
    ray = RayMeshIntersector(box())
    origins, directions = crossing_rays(box())
    first = ray.intersects_first(origins, directions)
    assert (pickle.loads(pickle.dumps(ray)).intersects_first(origins, directions) == first).all()
    code = "import sys; sys.modules['trimesh'] = None; import raylanes.trimesh"
    subprocess.run([sys.executable, "-c", code], check=True)
