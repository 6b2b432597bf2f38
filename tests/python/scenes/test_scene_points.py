"""Points in scenes: closest points, inside and outside, which part; and the triangles that hits name."""

import numpy as np
import pytest

import raylanes
from meshes import cube, cube_faces, cube_vertices, same
from parts import number_types

INSIDE, ON, OUTSIDE = raylanes.INSIDE, raylanes.ON, raylanes.OUTSIDE
typed = pytest.mark.parametrize("dtype", number_types)


def shells(dtype=np.float32):
    """Cubes of half sides 1, 2 and 4 around zero, the last one a mesh; and one of 1 at 6, stretched to 2 along z."""
    scene = raylanes.Scene()
    part = scene.add(cube(dtype=dtype))
    scene.place(part, [np.eye(4), np.diag([2, 2, 2, 1])])
    scene.place(scene.add(4 * cube_vertices.astype(dtype), cube_faces), mask=2)
    stretched = np.diag([1.0, 1, 2, 1])
    stretched[0, 3] = 6
    scene.place(part, stretched)
    scene.update()
    return scene


@typed
def test_closest_points_are_in_the_space_of_the_scene(dtype):
    scene = shells(dtype)
    closest = scene.closest_points([[0, 0, 1.25], [0, 3.5, 0], [6, 0, 3], [np.nan, 0, 0]])
    assert isinstance(closest, raylanes.SceneClosestPoints)
    assert closest.distance.tolist() == [0.25, 0.5, 1, np.inf]
    assert closest.instance.tolist() == [0, 2, 3, raylanes.no_part]
    assert closest.geometry.tolist() == [0, 1, 0, raylanes.no_part]
    assert closest.point[2].tolist() == [6, 0, 2] and closest.point.dtype == closest.u.dtype == dtype
    assert isinstance(closest[0], raylanes.SceneClosestPoint) and int(closest[1].instance) == 2
    hidden = scene.closest_points([[0, 3.5, 0]], mask=1)
    assert hidden.distance.tolist() == [1.5] and hidden.instance.tolist() == [1]
    assert scene.closest_points([[0, 0, 1.25]], max_distance=0.125).instance.tolist() == [raylanes.no_part]
    assert scene.closest_points(np.zeros((2, 3, 3))).shape == (2, 3)
    assert scene.closest_points(np.zeros((0, 3))).shape == (0,)


@typed
def test_one_part_is_its_tree(dtype):
    points = np.random.default_rng(5).uniform(-3, 3, (2000, 3)).astype(dtype)
    tree, scene = cube(dtype=dtype), raylanes.Scene()
    scene.place(scene.add(tree))
    scene.update()
    closest, expected = scene.closest_points(points), tree.closest_points(points)
    for name in expected.dtype.names:
        assert same(np.asarray(closest[name]), np.asarray(expected[name]))
    assert same(scene.locate(points), tree.locate(points))
    assert same(scene.signed_distances(points), tree.signed_distances(points))
    assert same(scene.winding_numbers(points), tree.winding_numbers(points))
    assert same(scene.inside(points), tree.inside(points))


@typed
def test_parts_are_named_innermost_first(dtype):
    scene = shells(dtype)
    points = [[0, 0, 0], [0.5, 1, 0.25], [0, 1.5, 0], [3, 0, 0], [6, 0, 1.5], [9, 9, 9]]
    parts = scene.innermost_parts(points)
    assert isinstance(parts, raylanes.ContainingParts)
    assert parts.instance.tolist() == [0, 0, 1, 2, 3, raylanes.no_part]
    assert parts.location.tolist() == [INSIDE, ON, INSIDE, INSIDE, INSIDE, OUTSIDE]
    assert parts.found.tolist() == [True] * 5 + [False]
    assert isinstance(parts[0], raylanes.ContainingPart) and parts[3].geometry == 1
    lists = scene.containing_parts(points)
    assert lists.counts.tolist() == [3, 3, 2, 1, 1, 0]
    assert lists[0].instance.tolist() == [0, 1, 2] and lists.ray.tolist()[:4] == [0, 0, 0, 1]
    assert scene.containing_parts(points, mask=1).counts.tolist() == [2, 2, 1, 0, 1, 0]
    assert scene.containing_parts(points, active=[False, True] * 3).counts.tolist() == [0, 3, 0, 1, 0, 0]
    assert scene.locate(points).tolist() == [INSIDE] * 5 + [OUTSIDE]
    assert scene.winding_numbers(points).tolist() == [3, 2.5, 2, 1, 1, 0]
    assert scene.signed_distances(points).tolist()[:5] == [-1, 0, -0.5, -1, -0.5]
    out = np.zeros(6, raylanes.containing_part_dtype)
    assert scene.innermost_parts(points, out=out, active=[True] + [False] * 5, threads=1) is out
    assert out["location"].tolist() == [INSIDE, 0, 0, 0, 0, 0] and out["instance"].tolist() == [0] * 6
    heard = []
    scene.innermost_parts(points, progress=heard.append)
    assert heard[-1] == 1


@typed
def test_neighbours_share_faces(dtype):
    scene = raylanes.Scene()
    part = scene.add(cube(dtype=dtype))
    places = np.array([np.eye(4)] * 2)
    places[1, 0, 3] = 2
    scene.place(part, places)
    scene.update()
    lists = scene.containing_parts([[1, 0, 0], [0.5, 0, 0], [1.5, 0, 0], [1, 1, 1]])
    assert [each.instance.tolist() for each in lists] == [[0, 1], [0], [1], [0, 1]]
    assert lists[0].location.tolist() == [ON, ON]


@typed
def test_corners_and_normals_need_no_trees(dtype):
    scene = shells(dtype)
    rays = raylanes.rays([[0, 0, 9], [6, 0, 9], [20, 0, 9]], [0, 0, -1])
    hits = scene.closest(rays)
    corners = scene.corners(hits)
    assert corners.shape == (3, 3, 3) and corners.dtype == scene.normals(hits).dtype == dtype
    assert np.isnan(corners[2]).all() and (corners[0, :, 2] == 4).all() and (corners[1, :, 2] == 2).all()
    assert scene.normals(hits)[:2].tolist() == [[0, 0, 1], [0, 0, 1]]
    assert scene.corners(hits[0]).shape == (3, 3) and scene.normals(hits[:0]).shape == (0, 3)
    closest = scene.closest_points([[9, 0, 0]])
    assert (scene.corners(closest)[0, :, 0] == 7).all()
    for ask in (scene.corners, scene.normals):
        with pytest.raises(TypeError, match="an instance"):
            ask(cube().closest(rays))


def test_what_is_refused():
    scene = shells()
    scene.place(scene.add(raylanes.SphereTree([[0, 0, 0]], 1)), mask=4)
    with pytest.raises(RuntimeError, match="update"):
        scene.closest_points([[0, 0, 0]])
    scene.update()
    for ask in (scene.closest_points, scene.locate, scene.innermost_parts, scene.containing_parts,
                scene.signed_distances, scene.winding_numbers):
        with pytest.raises(ValueError, match="instance 4 of the scene has spheres"):
            ask([[0, 0, 0]])
        ask([[0, 0, 0]], mask=3)
    with pytest.raises(ValueError, match="rule"):
        scene.locate([[0, 0, 0]], rule="odd", mask=3)
    with pytest.raises(ValueError, match="two dimensions"):
        scene.containing_parts([0, 0, 0], mask=3)
    with pytest.raises(TypeError, match="out"):
        scene.innermost_parts([[0, 0, 0]], out=np.zeros(1), mask=3)
