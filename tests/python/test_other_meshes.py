"""Meshes of other packages in place of arrays, and what hits say of their triangles."""

from types import SimpleNamespace

import numpy as np
import pytest

import raylanes

VERTICES = np.array([[0, 0, 0], [4, 0, 0], [0, 2, 0], [0, 0, 1]], np.float64)
FACES = np.array([[0, 1, 2], [0, 3, 1]])
DOWN = raylanes.rays([[1, 0.5, 5], [9, 9, 9], [2, 0.25, 3]], [[0, 0, -1.0]])


class Tensor:
    """As Open3D's: on a device, then in memory, then as an array."""

    def __init__(self, array, device="cuda"):
        self.array, self.device = array, device

    def cpu(self):
        return Tensor(self.array, "cpu")

    def numpy(self):
        assert self.device == "cpu"
        return self.array


OTHERS = {
    "faces": SimpleNamespace(vertices=VERTICES, faces=FACES),
    "triangles": SimpleNamespace(vertices=VERTICES.tolist(), triangles=FACES.tolist()),
    "tensors": SimpleNamespace(vertex={"positions": Tensor(VERTICES)}, triangle={"indices": Tensor(FACES)}),
}


@pytest.fixture(params=OTHERS, name="other")
def one_of_others(request):
    return OTHERS[request.param]


def test_a_mesh_stands_for_vertices_and_faces(other):
    known = raylanes.Bvh(VERTICES, FACES).closest(DOWN)
    tree = raylanes.Bvh(other)
    assert tree.dtype == np.float64
    assert tree.closest(DOWN).tobytes() == known.tobytes()
    tree.refit(other)
    assert tree.closest(DOWN).tobytes() == known.tobytes()
    assert raylanes.Bvh(other, dtype=np.float32).dtype == np.float32
    assert list(raylanes.KdTree(other).closest(DOWN).primitive) == list(known.primitive)
    assert raylanes.closed_report(other) == raylanes.closed_report(VERTICES, FACES)


def test_meshes_of_trimesh():
    trimesh = pytest.importorskip("trimesh")
    tree = raylanes.Bvh(trimesh.creation.box())
    assert tree.locate([[0, 0, 0], [2, 2, 2]]).tolist() == [raylanes.INSIDE, raylanes.OUTSIDE]


def test_what_is_no_mesh_is_refused():
    for wrong in (VERTICES, None, SimpleNamespace(vertices=VERTICES), "box"):
        with pytest.raises(TypeError, match="faces: give vertices and faces, or a mesh"):
            raylanes.Bvh(wrong)


def test_lists_of_meshes_are_refused_with_what_to_do(other):
    join = "one mesh is needed, not a list of 2. Join them: concatenate .* or add each mesh to a raylanes.Scene$"
    for given in [([VERTICES, VERTICES[:3]], [FACES, FACES[:1]]), ([VERTICES.tolist()] * 2, FACES), ([other, other],)]:
        for call in (raylanes.Bvh, raylanes.KdTree, raylanes.closed_report, raylanes.Bvh(VERTICES, FACES).refit):
            with pytest.raises(TypeError, match="^vertices: " + join):
                call(*given)
    with pytest.raises(TypeError, match="^faces: " + join):
        raylanes.Bvh(VERTICES, [FACES, FACES])
    with pytest.raises(TypeError, match="not list: call add.. for each part$"):
        raylanes.Scene().add([raylanes.Bvh(VERTICES, FACES, dtype=np.float32)])


def test_pairs_of_points_are_refused_with_what_to_do():
    scene, points = raylanes.Scene(), np.zeros((5, 3))
    scene.update()
    pairs = r"^origin: one .* not 5 .* occluded\(origins=A, directions=B - A, tmax=1\)$"
    for asked in (raylanes.Bvh(VERTICES, FACES), scene, raylanes.SphereTree([[0, 0, 0]], 1)):
        with pytest.raises(ValueError, match=pairs):
            asked.occluded_from(points, points)
        with pytest.raises(ValueError, match=r"^direction: .* not 5 .* occluded\(origins=points, directions=D\)$"):
            asked.occluded_towards(points, points)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_hits_have_weights_normals_and_values_of_corners(other, dtype):
    hits = raylanes.Bvh(other, dtype=dtype).closest(DOWN)
    assert hits.hit.tolist() == [True, False, True]
    weights = hits.barycentric
    assert weights.dtype == dtype and weights.shape == (3, 3)
    assert weights[[0, 2]].tolist() == [[0.5, 0.25, 0.25], [0.375, 0.5, 0.125]] and np.isnan(weights[1]).all()
    # The place itself, from the corners.
    places = hits.interpolate(VERTICES, FACES)
    assert places[[0, 2]].tolist() == [[1, 0.5, 0], [2, 0.25, 0]] and np.isnan(places[1]).all()
    assert np.array_equal(hits.interpolate(VERTICES[:, 0], other), places[:, 0], equal_nan=True)
    normals = hits.normals(other)
    assert normals[[0, 2]].tolist() == [[0, 0, 1]] * 2 and np.isnan(normals[1]).all()
    assert np.array_equal(hits.normals(VERTICES, FACES), normals, equal_nan=True)


def test_single_hits_and_closest_points_have_them_too():
    tree = raylanes.Bvh(VERTICES, FACES)
    hit, point = tree.closest(DOWN)[0], tree.closest_points([[1, 0.5, -2]])[0]
    for record in (hit, point):
        assert record.barycentric.tolist() == [0.5, 0.25, 0.25]
        assert record.normals(VERTICES, FACES).tolist() == [0, 0, 1]
        assert record.interpolate([0, 8, 0, 0], FACES) == 2


def test_other_shapes():
    tree = raylanes.Bvh(VERTICES, FACES)
    grid = tree.closest(np.stack([DOWN, DOWN]))
    assert grid.barycentric.shape == grid.normals(VERTICES, FACES).shape == (2, 3, 3)
    assert grid.interpolate(np.zeros((4, 2)), FACES).shape == (2, 3, 2)
    none = tree.closest(DOWN[:0])
    assert none.normals(VERTICES, FACES).shape == none.barycentric.shape == (0, 3)
    nothing = raylanes.Bvh(np.zeros((0, 3)), np.zeros((0, 3), int)).closest(DOWN)
    assert np.isnan(nothing.normals(np.zeros((0, 3)), np.zeros((0, 3), int))).all()
    assert np.isnan(nothing.interpolate(np.zeros((0, 2)), np.zeros((0, 3), int))).all()


def test_another_mesh_is_refused():
    hits = raylanes.Bvh(VERTICES, FACES).closest(DOWN)
    with pytest.raises(ValueError, match="faces: there are 0, and a hit is on face 0"):
        hits.normals(VERTICES, FACES[:0])
    with pytest.raises(ValueError, match="faces: an index is no row of 2"):
        hits.normals(VERTICES[:2], FACES)
    with pytest.raises(ValueError, match="faces: an index is no row of 3"):
        hits.interpolate([1, 2, 3], FACES + 1)
    with pytest.raises(ValueError, match="values: the shape"):
        hits.interpolate(np.zeros((4, 1, 1)), FACES)
    with pytest.raises(TypeError, match="values: real numbers"):
        hits.interpolate(list("abcd"), FACES)


def test_flat_triangles_have_no_normal():
    flat = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], float)
    points = raylanes.Bvh(flat, [[0, 1, 2]]).closest_points([[0.5, 1, 0]])
    assert np.isnan(points.normals(flat, [[0, 1, 2]])).all()
