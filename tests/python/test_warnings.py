"""Warnings about meshes: for what, once, and at whose line."""

import types
import warnings

import numpy as np
import pytest

import raylanes
import raylanes.trimesh
from meshes import cube_faces, cube_vertices, lattice, sphere, tree_kinds, warnings_of

kinds = [raylanes.Bvh, raylanes.KdTree]
centre = [[0.0, 0.0, 0.0]]


@pytest.mark.parametrize("kind", kinds)
@pytest.mark.parametrize("query", ["inside", "locate", "signed_distances"])
def test_parity_of_an_open_mesh(kind, query):
    tree = kind(cube_vertices, cube_faces[1:])
    for rule in ("winding", "nonzero", "vote"):
        assert warnings_of(lambda rule=rule: getattr(tree, query)(centre, rule=rule)) == []
    text, = warnings_of(lambda: getattr(tree, query)(centre))
    assert 'rule="winding"' in text and "closed_report()" in text and "\n" not in text
    assert warnings_of(lambda: [tree.inside(centre), tree.locate(centre), tree.signed_distances(centre)]) == []


@pytest.mark.parametrize("kind,builder", tree_kinds)
@pytest.mark.parametrize("mesh", [sphere(1), sphere(2, 40), lattice(1)[:2], lattice(2, 5)[:2],
                                  (cube_vertices, np.concatenate([cube_faces, cube_faces])),
                                  (cube_vertices, cube_faces[:0])])
def test_the_warning_is_that_of_the_report(kind, builder, mesh):
    """Also if a builder splits triangles, if triangles share no vertices, and where −0 and 0 meet."""
    vertices, faces = (np.array(part) for part in mesh)
    if len(vertices):
        vertices = (vertices - vertices[0])[faces.reshape(-1)]
        faces = np.arange(len(vertices)).reshape(-1, 3)
        vertices[::2] = np.where(vertices[::2] == 0, -0.0, vertices[::2])
    for kept in (faces, faces[:-1]):
        has_parity = raylanes.closed_report(vertices, kept)["has_parity"]
        warnings.simplefilter("ignore")
        tree = kind(vertices, kept, builder=builder)
        assert len(warnings_of(lambda tree=tree: tree.inside(centre))) == (not has_parity)


def test_triangles_that_a_refit_makes_a_line():
    """They have no edges, as in the report: here the rim of the hole shrinks to a line."""
    faces, vertices = cube_faces[1:], cube_vertices.copy()
    tree = raylanes.Bvh(vertices, faces)
    vertices[1] = vertices[0]
    tree.refit(vertices, faces)
    assert raylanes.closed_report(vertices, faces)["has_parity"]
    assert warnings_of(lambda: tree.inside(centre)) == []


@pytest.mark.parametrize("kind", kinds)
def test_triangles_that_are_left_out(kind):
    faces = np.concatenate([cube_faces, [[0, 0, 1], [2, 3, 3], [4, 5, 4]]])
    text, = warnings_of(lambda: kind(cube_vertices, faces))
    assert text.startswith("3 of 15 triangles have two equal corners")
    assert warnings_of(lambda: kind(cube_vertices, cube_faces)) == []
    mesh = types.SimpleNamespace(vertices=cube_vertices.astype(float), faces=faces)
    assert len(warnings_of(lambda: raylanes.trimesh.closest_point(mesh, centre))) == 1


def test_faces_that_are_doubled():
    """What the report says, and what the rules then say of the centre."""
    doubled = np.concatenate([cube_faces, np.roll(cube_faces, 1, axis=1)])
    report = raylanes.closed_report(cube_vertices, doubled)
    assert report["doubled"] == 12 and report["has_parity"] and not report["is_closed"]
    assert raylanes.closed_report(cube_vertices, cube_faces)["doubled"] == 0
    tree = raylanes.Bvh(cube_vertices, doubled)
    found = {rule: tree.inside(centre, rule=rule)[0] for rule in ("parity", "nonzero", "winding")}
    assert found == {"parity": False, "nonzero": True, "winding": True}
    turned = np.concatenate([cube_faces, cube_faces[:, ::-1], cube_faces[:1]])
    assert raylanes.closed_report(cube_vertices, turned)["doubled"] == 13


@pytest.mark.parametrize("kind", [*kinds, lambda vertices, faces: raylanes.Bvh(vertices, faces, dtype=np.float64)])
def test_meshes_that_are_inside_out(kind):
    """Each tree warns once, where winding numbers or sides of triangles decide."""
    rays = raylanes.rays([[0, 0, 9]], [0, 0, -1])
    calls = [lambda tree: tree.inside(centre, rule="winding"), lambda tree: tree.closest(rays, facing="back"),
             lambda tree: tree.closest_crossing(rays, facing="front"), lambda tree: tree.occluded(rays, facing="back"),
             lambda tree: tree.occluded_from([0, 0, 9], centre, facing="back")]
    turned, one_turned = cube_faces[:, ::-1], np.concatenate([cube_faces[1:], cube_faces[:1, ::-1]])
    for call in calls:
        tree = kind(cube_vertices + np.float32(100), turned)
        text, = warnings_of(lambda: call(tree))
        assert text.startswith("the mesh is turned inside out") and "faces[:, ::-1]" in text
        assert warnings_of(lambda: [each(tree) for each in calls]) == []
        for good in (cube_faces, turned[1:], one_turned, turned[:0]):
            assert warnings_of(lambda: call(kind(cube_vertices, good))) == []
    tree = kind(cube_vertices, turned)
    assert warnings_of(lambda: [tree.inside(centre), tree.closest(rays)]) == []


def test_the_report_of_meshes_that_are_inside_out():
    side = float(np.ptp(cube_vertices[:, 0]))
    for vertices in (cube_vertices, cube_vertices.astype(np.float64) + 1e6):
        good = raylanes.closed_report(vertices, cube_faces)
        turned = raylanes.closed_report(vertices, cube_faces[:, ::-1])
        assert good["volume"] == side**3 == -turned["volume"]
        assert (good["is_inside_out"], turned["is_inside_out"], turned["is_closed"]) == (False, True, True)
    flat = raylanes.closed_report(cube_vertices * np.float32([1, 1, 0]), cube_faces[:, ::-1])
    assert (flat["volume"], flat["is_inside_out"]) == (0, False)
    assert raylanes.closed_report(cube_vertices, cube_faces[1:, ::-1])["volume"] == 0


@pytest.mark.parametrize("dtype", [np.int64, np.uint64, np.longdouble])
def test_vertices_that_float64_does_not_hold(dtype):
    far = (cube_vertices - cube_vertices.min(axis=0)).astype(dtype) + dtype(2**60)
    if dtype is np.longdouble and np.finfo(dtype).nmant < 60:
        pytest.skip("a long double is a double here")
    odd = far.copy()
    odd[0, 0] += dtype(1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        lost = raylanes.Bvh(odd, cube_faces)
    assert lost.report()["rounded_away"] == len(cube_faces)
    text = warnings_of(lambda: raylanes.Bvh(odd, cube_faces))[0]
    assert text.startswith(f"vertices: float64 does not hold these {np.dtype(dtype)} numbers")
    asked = warnings_of(lambda: raylanes.Bvh(odd, cube_faces, dtype=np.float64))
    assert all("does not hold" not in text for text in asked)
    near = (cube_vertices - cube_vertices.min(axis=0)).astype(dtype)
    assert warnings_of(lambda: raylanes.Bvh(near * dtype(2**58), cube_faces)) == []
    with pytest.raises(ValueError, match="^vertices: float32 does not hold"):
        raylanes.KdTree(odd, cube_faces)
    tree = raylanes.Bvh(near, cube_faces)
    assert warnings_of(lambda: tree.refit(odd, cube_faces))
    assert raylanes.closed_report(odd, cube_faces)["degenerate"] == 0


def test_which_integers_floats_hold():
    from raylanes._arrays import changes

    for dtype in (np.int32, np.uint32, np.int64, np.uint64):
        ends = np.iinfo(dtype)
        for n in [0, 1, 2**24 - 1, 2**24, 2**24 + 1, ends.min, ends.min + 1, ends.max, 2**31 - 128, 2**53 + 1]:
            if ends.min <= n <= ends.max:
                for real in (np.float32, np.float64):
                    given = np.array([0, n], dtype)
                    assert changes(given, given.astype(real)) == (int(real(n)) != n), n
