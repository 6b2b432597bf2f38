"""Scenes of float64: which geometry decides the type, what is converted and what is refused; and boxes far away from
zero, beside exact arithmetic."""

import copy
import pickle
import threading
from fractions import Fraction

import numpy as np
import pytest

import raylanes
from meshes import cube, cube_faces, cube_vertices, random_rays, supported, warnings_of
from parts import far

wide = np.float64
cube_doubles = cube_vertices.astype(wide)
rays = random_rays(1, 400, reach=3, dtype=wide)
spheres = raylanes.SphereTree([[0, 0, 0]], 1)


def scene_of(*geometries, dtype=None):
    scene = raylanes.Scene(dtype=dtype)
    for geometry in geometries:
        scene.place(scene.add(*geometry) if isinstance(geometry, tuple) else scene.add(geometry))
    scene.update()
    return scene


@pytest.mark.parametrize("first, expected", [
    *(((cube_vertices.astype(of), cube_faces), np.float32) for of in ("f2", "f4", ">f4")),
    *(((cube_vertices.astype(of), cube_faces), wide) for of in ("f8", ">f8", "i1", "i8")),
    ((cube_vertices.tolist(), cube_faces.tolist()), wide), (cube(), np.float32), (cube(dtype=wide), wide),
    (spheres, np.float32), (scene_of(cube()), np.float32), (scene_of(cube(dtype=wide)), wide)])
def test_the_first_geometry_decides(first, expected):
    scene = scene_of(first)
    assert scene.dtype == expected and scene.bounds.dtype == expected and f" of {scene.dtype} in " in repr(scene)
    hits, kinds = scene.closest(rays), (raylanes.scene_hit_dtype, raylanes.double_scene_hit_dtype)
    assert hits.dtype == kinds[expected == wide] and hits.hit.any() and hits.positions(rays).dtype == expected
    assert scene.transform_of(0).dtype == expected and scene.levels_of(0).tolist()[0][0] == 0
    assert copy.copy(scene).dtype == expected


@pytest.mark.parametrize("dtype", [np.float32, wide, "float32", np.dtype(wide)])
def test_types_that_are_asked_for(dtype):
    thirds = cube_doubles / 3
    scene, other = scene_of((thirds, cube_faces), dtype=dtype), [np.float32, wide][np.dtype(dtype) == np.float32]
    assert scene.dtype == dtype
    assert scene.corners(scene.closest(rays))[0].dtype == dtype
    alone = scene_of(raylanes.Bvh(thirds, cube_faces, dtype=dtype))
    assert alone.dtype == dtype and scene.closest(rays).tobytes() == alone.closest(rays).tobytes()
    scene.refit(0, thirds / 3, cube_faces)
    scene.replace(0, thirds, cube_faces)
    scene.update()
    assert scene.closest(rays).tobytes() == alone.closest(rays).tobytes()
    with pytest.raises(ValueError, match=f"^tree: the scene has {scene.dtype}, this Bvh has {np.dtype(other)}; "
                       f"give it a Bvh made with dtype=numpy.{scene.dtype}$"):
        scene.add(cube(dtype=other))
    with pytest.raises(TypeError, match="^dtype: numpy.float32 or numpy.float64 is needed, not "):
        raylanes.Scene(dtype=int)


def test_meshes_are_converted_if_no_number_changes():
    scene = scene_of((cube_doubles, cube_faces))
    expected = scene.closest(rays).tobytes()
    for vertices in (cube_vertices, cube_vertices.astype("i4"), cube_vertices.tolist()):
        scene.replace(0, vertices, cube_faces)
        assert scene.add(vertices, cube_faces) > 0
        scene.update()
        assert scene.closest(rays).tobytes() == expected and scene.dtype == wide
    odd = cube_vertices.astype(np.int64) * (2**53 + 1)
    for change in (lambda: scene.add(odd, cube_faces), lambda: scene.replace(0, odd, cube_faces),
                   lambda: scene.refit(0, odd, cube_faces)):
        with pytest.raises(ValueError, match="^vertices: float64 does not hold these int64 numbers; the scene has "
                           r"float64: Scene\(dtype=numpy.float64\) rounds them$"):
            change()
    assert scene_of((odd, cube_faces), dtype=wide).bounds[1, 0] >= 2**53
    floats = scene_of((cube_vertices, cube_faces))
    assert floats.add(cube_doubles, cube_faces) == 1 and floats.dtype == np.float32
    with pytest.raises(ValueError, match="^vertices: float32 does not hold these float64 numbers; the scene has "
                       r"float32: Scene\(dtype=numpy.float32\) rounds them, Scene\(dtype=numpy.float64\) has float64$"):
        floats.add(cube_doubles / 3, cube_faces)


def test_triangles_without_an_area():
    flat = np.append(cube_faces, [[0, 0, 1]], axis=0)
    warned = warnings_of(lambda: raylanes.Scene().add(cube_doubles, flat))
    assert len(warned) == 1 and warned[0].startswith("1 of 13 triangles have two equal corners")
    scene = scene_of((cube_doubles, flat))
    assert scene.closest(rays).tobytes() == scene_of((cube_doubles, cube_faces)).closest(rays).tobytes()


def test_before_the_first_geometry():
    scene = raylanes.Scene()
    scene.update()
    assert scene.dtype == wide and not scene.closest(rays).hit.any() and not scene.occluded(rays).any()
    assert (scene.bounds == [[np.inf] * 3, [-np.inf] * 3]).all() and scene.name_of([]).shape == (0,)
    assert (scene.geometry_count, scene.instance_count) == (0, 0)
    for wrong, error in ((lambda: scene.place(0), IndexError), (lambda: scene.move(0, np.eye(4)), IndexError),
                         (lambda: scene.add(cube_doubles, cube_faces + 1), ValueError),
                         (lambda: scene.add(cube_doubles, [[0, 1, 2.5]]), TypeError),
                         (lambda: scene.add(None), TypeError), (lambda: scene.refit(0, cube_vertices, cube_faces),
                                                                IndexError)):
        with pytest.raises(error):
            wrong()
    for other in (scene, copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert "_tree" not in vars(other) and other.add(spheres) == 0 and other.dtype == np.float32
    assert raylanes.Scene().geometry_count == 0 and raylanes.Scene(dtype=wide).add(cube(dtype=wide)) == 0


def test_one_of_many_threads_decides():
    for _ in range(20):
        scene, refused, begin = raylanes.Scene(), [], threading.Barrier(8)

        def add(tree):
            begin.wait()
            try:
                scene.place(scene.add(tree))
            except ValueError as error:
                refused.append(str(error))

        trees = [cube(dtype=[np.float32, wide][k % 2]) for k in range(8)]
        threads = [threading.Thread(target=add, args=(tree,)) for tree in trees]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert scene.geometry_count == scene.instance_count == len(refused) == 4
        assert all(text.startswith(f"tree: the scene has {scene.dtype}, this Bvh has") for text in refused)


def test_changes():
    tree = raylanes.Bvh(cube_doubles / 3, cube_faces)
    scene = scene_of(tree)
    before, third = scene.closest(rays), scene.transform_of(0)
    third[:, 3] = 1 / 3
    scene.set_mask(0, 2)
    with pytest.raises(RuntimeError, match=r"update\(\) comes before the next query"):
        scene.closest(rays)
    scene.update()
    assert not scene.closest(rays, mask=1).hit.any() and scene.closest(rays, mask=2).tobytes() == before.tobytes()
    other = copy.copy(scene)
    scene.move(0, third)
    scene.refit(0, cube_doubles / 7, cube_faces)
    scene.update()
    assert scene.transform_of(0).tobytes() == third.tobytes()  # no rounding to float32
    corners = scene.corners(scene.closest(rays))
    assert set(corners[np.isfinite(corners)]) == {1 / 3 - 1 / 7, 1 / 3 + 1 / 7}
    assert other.closest(rays).tobytes() == before.tobytes() and (tree.bounds == [[-1 / 3] * 3, [1 / 3] * 3]).all()
    tree.refit(cube_doubles, cube_faces)
    assert other.closest(rays).tobytes() == before.tobytes()
    found = scene.closest(rays).tobytes()
    for wrong, error in ((lambda: scene.refit(0, cube_doubles, cube_faces[1:]), ValueError),
                         (lambda: scene.refit(1, cube_doubles, cube_faces), IndexError),
                         (lambda: scene.move([0, 1], np.eye(4)), IndexError),
                         (lambda: scene.set_mask([0, 1], 0), IndexError), (lambda: scene.levels_of(1), IndexError),
                         (lambda: scene.replace(1, tree), IndexError)):
        with pytest.raises(error):
            wrong()
        assert scene.closest(rays).tobytes() == found


def test_answers_have_the_type_of_the_scene():
    scene, floats = scene_of(cube(dtype=wide)), scene_of(cube())
    hits = scene.closest(rays)
    out = np.zeros(len(rays), raylanes.double_scene_hit_dtype)
    assert scene.closest(rays, out=out) is out and out.tobytes() == hits.tobytes()
    heard, active = [], np.arange(len(rays)) % 2 == 0
    some = scene.closest(rays, active=active, progress=heard.append)
    assert np.array_equal(some[active], hits[active]) and not some.hit[~active].any() and heard[-1] == 1
    assert (some.instance[~active] == raylanes.no_part).all()
    points = rays["origin"]
    none = scene.closest_points(points, active=np.zeros(len(points), bool))
    assert (none.distance == np.inf).all() and (none.instance == raylanes.no_part).all()
    for given, dtype in ((scene.crossings(rays).items, raylanes.double_scene_crossing_dtype),
                         (scene.stretches(rays).items, raylanes.double_scene_stretch_dtype),
                         (scene.closest_points(points), raylanes.double_scene_closest_point_dtype)):
        assert given.dtype == dtype and len(given) and (given.instance == 0).all()
    wrong = [lambda: scene.closest(rays, out=floats.closest(rays)), lambda: floats.closest(rays, out=out),
             lambda: scene.closest(rays, after=floats.closest(rays)), lambda: floats.closest(rays, after=hits),
             lambda: scene.closest(rays, after=cube(dtype=wide).closest(rays))]
    for call in wrong:
        with pytest.raises(TypeError, match="^(out|after): "):
            call()
    packed = np.where(hits.hit, hits, hits)  # NumPy drops the padding
    assert packed.dtype.itemsize < hits.dtype.itemsize and np.array_equal(
        scene.closest(rays, after=packed), scene.closest(rays, after=hits))
    with pytest.raises(ValueError, match='^test: float64 has "exact" alone; a tree or scene made with '
                       "dtype=numpy.float32 has the others$"):
        scene.closest(rays, test="watertight")


def test_what_scenes_of_float64_lack():
    scene = scene_of((cube_doubles, cube_faces))
    for call, sentence in [
            (lambda: scene.add(spheres), "^tree: the scene has float64, this SphereTree has float32; put spheres into "
                                         "a scene made with dtype=numpy.float32$"),
            (lambda: scene.replace(0, spheres), "^tree: the scene has float64, this SphereTree has float32"),
            (lambda: scene.add(scene_of(cube())), "^tree: the scene has float64, this Scene has float32; give it a "
                                                  "Scene made with dtype=numpy.float64$"),
            (lambda: scene_of(cube()).add(scene), "^tree: the scene has float32, this Scene has float64; give it")]:
        with pytest.raises(ValueError, match=sentence):
            call()
    assert scene.geometry_count == 1 and scene.closest(rays).hit.any()
    assert scene.add(raylanes.Scene()) == 1 and scene_of(cube()).add(raylanes.Scene()) == 1
    nested = raylanes.Scene()
    assert nested.add(raylanes.Scene()) == 0 and nested.dtype == wide and nested.place(0) == 0


class Boxes:
    """Boxes far away from zero, whose sides are no floats, and points near and on them, all as fractions."""

    def __init__(self, seed):
        random = np.random.default_rng(seed)
        self.middles = far + random.integers(-2**22, 2**22, (12, 3)) * 2.0**-20
        self.halves = random.integers(2**18, 2**21, (12, 3)) * 2.0**-20
        self.points = far + random.integers(-6 * 2**20, 6 * 2**20, (600, 3)) * 2.0**-20
        box = np.arange(600) % 12
        on = self.middles[box] + self.halves[box] * random.integers(-1, 2, (600, 3))
        self.points[::2] = np.where(random.integers(0, 2, (600, 3)), self.points, on)[::2]
        self.masks = 1 << box[:12] % 3
        transforms = np.zeros((12, 3, 4))
        transforms[:, range(3), range(3)], transforms[:, :, 3] = self.halves, self.middles
        self.scene = raylanes.Scene()
        self.scene.place(self.scene.add(cube_doubles, cube_faces), transforms, mask=self.masks)
        self.scene.update()

    def depths(self, point, mask):
        """(instance, how far the point is within each box along its nearest axis; below 0 outside, its distance)."""
        for instance in np.flatnonzero(self.masks & mask).tolist():
            within = [Fraction(h) - abs(Fraction(p) - Fraction(m)) for h, p, m in
                      zip(self.halves[instance].tolist(), point.tolist(), self.middles[instance].tolist())]
            outside = sum(min(w, Fraction(0))**2 for w in within)
            yield instance, min(within), float(outside)**0.5 or abs(float(min(within)))

    def volume(self, instance):
        return Fraction(self.halves[instance, 0]) * Fraction(self.halves[instance, 1]) * Fraction(
            self.halves[instance, 2])


@pytest.mark.parametrize("mask", [0xFFFFFFFF, 0b101])
@pytest.mark.parametrize("path", supported)
def test_points_near_boxes_far_away(path, mask):
    boxes = Boxes(4)
    scene, points = boxes.scene, boxes.points
    with raylanes.use_path(path):
        located, lists = scene.locate(points, mask=mask), scene.containing_parts(points, mask=mask)
        innermost, distances = scene.innermost_parts(points, mask=mask), scene.signed_distances(points, mask=mask)
        windings, closest = scene.winding_numbers(points, mask=mask), scene.closest_points(points, mask=mask)
    assert {distances.dtype, windings.dtype, closest.u.dtype} == {np.dtype(wide)}
    seen = set()
    for i, point in enumerate(points):
        depths = list(boxes.depths(point, mask))
        containing = sorted((boxes.volume(instance), instance) for instance, depth, _ in depths if depth >= 0)
        expected = [instance for _, instance in containing]
        inside = sum(depth > 0 for _, depth, _ in depths)
        assert lists[i].instance.tolist() == expected
        assert innermost.instance[i] == (expected or [raylanes.no_part])[0]
        wanted = raylanes.INSIDE if inside else raylanes.ON if expected else raylanes.OUTSIDE
        assert located[i] == wanted
        near = min(distance for _, _, distance in depths)
        assert abs(closest.distance[i] - near) <= 1e-12 and abs(abs(distances[i]) - near) <= 1e-12
        assert (distances[i] == 0) == (near == 0) and (distances[i] < 0) == bool(inside and near)
        if inside == len(expected):
            assert windings[i] == inside
        seen.add((int(wanted), len(expected) > 1))
    assert seen >= {(0, False), (1, False), (1, True), (2, False)}
