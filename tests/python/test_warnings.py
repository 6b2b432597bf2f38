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
