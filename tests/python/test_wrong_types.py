"""Arguments of any type: what is wrong is a TypeError or ValueError, in a line of the module's own."""

import io
import pathlib

import numpy as np
import pytest

import raylanes
import raylanes.trimesh
from meshes import cube, cube_faces, cube_vertices, random_rays

wrong_values = [None, "text", b"bytes", bytearray(b"bytes"), object(), object, len, {}, {"a": 1}, {1}, ["a", "b"],
                [["a", "b", "c"]], [[None] * 3], [object()], [1, 2, [3]], (), [], [[]], 1j, 3, -3, 2.5, np.nan, True,
                2**70, -(2**70), "\0", "\udc80", io.StringIO("text"), io.BytesIO(b"bytes"), iter([1]), range(3),
                np.array(["a"]), np.ones(3, complex), np.ones((2, 3), object), np.zeros(2, "M8[s]"), np.float64(2),
                np.zeros((2, 3), "V4"), memoryview(b"bytes"), slice(3), raylanes.Bvh, cube(),
                raylanes.Scene()]

# Words of the binding, which mean nothing to users.
inner_words = ("_native", "pybind", "incompatible", "signature", "SharedTree", "SharedScene", "std::", "C++",
               "Unable to c")


class Closed:
    vertices, faces = cube_vertices.astype(float), cube_faces


def trees_calls():
    rays, points = random_rays(1, 4), np.zeros((4, 3), np.float32)
    traced = {"test": "exact", "grade": "reproducible", "mode": "single", "hint": "none", "facing": "any"}
    common = {"active": np.ones(4, bool), "threads": 1, "progress": print}
    for kind in (raylanes.Bvh, raylanes.KdTree):
        tree = kind(cube_vertices, cube_faces)
        yield kind, (cube_vertices, cube_faces), {"builder": "midpoint" if kind is raylanes.KdTree else "median",
                                                  "threads": 1, "progress": print}
        yield tree.closest, (rays,), {**traced, **common, "after": tree.closest(rays),
                                      "out": np.zeros(4, raylanes.hit_dtype)}
        yield tree.occluded, (rays,), {**traced, **common, "out": np.zeros(4, bool)}
        yield tree.occluded_from, (points[0], points), {**traced, **common, "start": 0.0, "end": 1.0,
                                                        "out": np.zeros(4, bool)}
        yield tree.occluded_towards, (points[0], points), {**traced, **common, "out": np.zeros(4, bool)}
        yield tree.all_hits, (rays,), {**common, "max_count": 2, "facing": "any"}
        yield tree.crossings, (rays,), {**common, "max_count": 2, "facing": "any"}
        yield tree.count_crossings, (rays,), {**common, "facing": "any", "out": np.zeros(4, raylanes.count_dtype)}
        yield tree.locate, (points,), {**common, "rule": "parity", "out": np.zeros(4, np.uint8)}
        yield tree.inside, (points,), {"rule": "parity", "threads": 1, "progress": print}
        yield tree.winding_numbers, (points,), {**common, "accuracy": 1e-6, "out": np.zeros(4, np.float32)}
        yield tree.closest_points, (points,), {**common, "max_distance": 1.0,
                                               "out": np.zeros(4, raylanes.closest_point_dtype)}
        yield tree.signed_distances, (points,), {**common, "rule": "parity", "max_distance": 1.0,
                                                 "out": np.zeros(4, np.float32)}
        yield tree.save, ("tree",), {}
        yield kind.load, ("tree",), {}
        yield kind, (cube_vertices, cube_faces), {"dtype": np.float32}
    bvh = cube()
    yield from doubles_calls()
    yield raylanes.Bvh, (cube_vertices, cube_faces), {"optimize": False, "rays": 0}
    yield bvh.refit, (cube_vertices, cube_faces), {"threads": 1}
    yield bvh.closest(rays).positions, (rays,), {}
    yield bvh.all_hits(rays).positions, (rays,), {}


def doubles_calls():
    tree, points = raylanes.Bvh(cube_vertices.tolist(), cube_faces), np.zeros((4, 3))
    rays = random_rays(1, 4, dtype=None)
    common = {"active": np.ones(4, bool), "threads": 1}
    yield tree.closest, (rays,), {**common, "test": "exact", "mode": "single", "after": tree.closest(rays),
                                  "out": np.zeros(4, raylanes.double_hit_dtype)}
    yield tree.occluded_from, (points[0], points), {**common, "start": 0.0, "end": 1.0}
    yield tree.occluded_towards, (points[0], points), common
    yield tree.all_hits, (rays,), {**common, "max_count": 2, "facing": "any"}
    yield tree.locate, (points,), {**common, "rule": "parity", "out": np.zeros(4, np.uint8)}
    yield tree.winding_numbers, (points,), {**common, "accuracy": 1e-6, "out": np.zeros(4)}
    yield tree.closest_points, (points,), {**common, "max_distance": 1.0,
                                           "out": np.zeros(4, raylanes.double_closest_point_dtype)}
    yield tree.signed_distances, (points,), {**common, "rule": "winding", "max_distance": 1.0, "out": np.zeros(4)}
    yield tree.refit, (cube_vertices, cube_faces), {"threads": 1}
    yield tree.closest(rays).positions, (rays,), {}


def scenes_calls():
    tree, spheres, rays, points = cube(), raylanes.SphereTree([[0, 0, 0]], 1), random_rays(1, 4), np.zeros((4, 3))
    traced = {"test": "exact", "grade": "reproducible", "mode": "single", "hint": "none", "facing": "any", "mask": 1,
              "active": np.ones(4, bool), "threads": 1}
    scene, changed = raylanes.Scene(), raylanes.Scene()
    for each in (scene, changed):
        each.place(each.add(tree)), each.update()
    yield raylanes.SphereTree, (points, np.ones(4)), {"builder": "median", "threads": 1, "dtype": np.float32}
    of_spheres = {"active": np.ones(4, bool), "threads": 1, "filter": lambda indices, hits: np.zeros(len(hits), bool)}
    yield spheres.closest, (rays,), {**of_spheres, "after": spheres.closest(rays)}
    yield spheres.occluded, (rays,), of_spheres
    yield spheres.occluded_from, (points[0], points), {**of_spheres, "start": 0.0, "end": 1.0}
    yield spheres.occluded_towards, (points[0], points), of_spheres
    yield changed.add, (tree,), {}
    yield changed.replace, (0, tree), {}
    yield changed.refit, (0, cube_vertices, cube_faces), {"threads": 1}
    yield changed.place, (0, np.eye(4)), {"mask": 1}
    yield changed.move, (0, np.eye(4)), {}
    yield changed.set_mask, (0, 1), {}
    yield changed.set_moving, (0,), {}
    yield changed.update, (), {"threads": 1}
    for query in (scene.geometry_of, scene.mask_of, scene.transform_of):
        yield query, (0,), {}
    traced_and_filtered = {**traced, "filter": lambda indices, hits: np.zeros(len(hits), bool)}
    yield scene.closest, (rays,), {**traced_and_filtered, "after": scene.closest(rays),
                                   "out": np.zeros(4, raylanes.scene_hit_dtype)}
    yield scene.occluded, (rays,), {**traced_and_filtered, "out": np.zeros(4, bool)}
    yield scene.occluded_from, (points[0], points), {**traced_and_filtered, "start": 0.0, "end": 1.0,
                                                           "out": np.zeros(4, bool)}
    yield scene.occluded_towards, (points[0], points), {**traced_and_filtered, "out": np.zeros(4, bool)}
    hits = scene.closest(rays)
    yield scene.save, ("tree",), {}
    yield raylanes.Scene.load, ("scene",), {}
    yield hits.positions, (rays,), {}
    yield hits.interpolate, ([np.ones(8)], [cube_faces]), {}
    yield hits.normals, (scene, [(cube_vertices, cube_faces)]), {"rays": rays}


def other_calls():
    points = np.zeros((4, 3))
    yield raylanes.closed_report, (cube_vertices, cube_faces), {"max_listed": 1}
    yield raylanes.rays, (points, points + 1), {"tmin": 0.0, "tmax": 1.0, "dtype": np.float64}
    for root in (raylanes.sqrt, raylanes.rsqrt, raylanes.reciprocal):
        yield root, (np.ones(3), "2^-11", np.ones(3)), {}
    yield lambda name: raylanes.use_path(name).__enter__(), ("scalar",), {}
    rays_of_mesh, distances = raylanes.trimesh.RayMeshIntersector(Closed), raylanes.trimesh.ProximityQuery(Closed)
    for method in (rays_of_mesh.intersects_id, rays_of_mesh.intersects_location, rays_of_mesh.intersects_first,
                   rays_of_mesh.intersects_any):
        yield method, (points, points + 1), {}
    for method in (rays_of_mesh.contains_points, distances.on_surface, distances.signed_distance):
        yield method, (points,), {}


def variants(arguments, options):
    """The same with one argument at a time replaced."""
    for wrong in wrong_values:
        for i in range(len(arguments)):
            yield (*arguments[:i], wrong, *arguments[i + 1:]), options
        for name in options:
            yield arguments, {**options, name: wrong}


@pytest.mark.filterwarnings("ignore")  # NumPy's, of conversions
@pytest.mark.parametrize("calls", [trees_calls, scenes_calls, other_calls])
def test_words_of_the_binding_reach_nobody(calls, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused = 0
    for call, arguments, options in calls():
        cube().save("tree"), raylanes.Scene(dtype=np.float32).save("scene")
        for some, others in variants(arguments, options):
            try:
                call(*some, **others)
            except (TypeError, ValueError, IndexError, FileNotFoundError) as error:
                text = f"{call} {some} {others}: {type(error).__name__}: {error}"
                assert str(error) and "\n" not in str(error), text
                assert not any(word in str(error) for word in inner_words), text
                refused += 1
    assert refused > 500


@pytest.mark.parametrize("kind", [raylanes.Bvh, raylanes.KdTree])
def test_files_of_text(kind, tmp_path):
    tree = cube(kind)
    wrong = [(lambda: kind.load(io.StringIO("tree")), "^file: bytes are needed, not str$"),
             (lambda: kind.load(None), "^file: a path or a file object is needed, not NoneType$"),
             (lambda: kind.load(3), "^file: a path or a file object is needed, not int$"),
             (lambda: tree.save(True), "^file: a path or a file object is needed, not bool$"),
             (lambda: tree.save(io.StringIO()), "^file: a file opened for writing bytes is needed, not StringIO$")]
    for call, sentence in wrong:
        with pytest.raises(TypeError, match=sentence):
            call()
    with open(tmp_path / "text", "w", encoding="utf-8") as file, pytest.raises(TypeError, match="not TextIOWrapper$"):
        tree.save(file)
    assert pathlib.Path(tmp_path / "text").stat().st_size == 0
