"""How scenes change: places, masks, geometries; copies and files; what is refused leaves them unchanged."""

import copy
import io
import pickle
import re
import types

import numpy as np
import pytest

import raylanes
from meshes import copies, cube, cube_faces, cube_vertices, random_rays, sphere
from parts import Parts, nearest, number_types

rays = random_rays(1, 600, reach=4)
typed = pytest.mark.parametrize("dtype", number_types)


def moved_by(x, y=0, z=0):
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z]]


def scene_of_cubes(count=3, dtype=np.float32):
    scene = raylanes.Scene()
    scene.place(scene.add(cube(dtype=dtype)), [moved_by(3 * i) for i in range(count)])
    scene.update()
    return scene


def test_places_are_numbered_and_told():
    scene = raylanes.Scene()
    assert [scene.add(cube()), scene.add(raylanes.SphereTree([[0, 0, 0]], 1))] == [0, 1]
    assert scene.place(1) == 0 and scene.place(0, np.eye(4), mask=6) == 1
    grid = np.zeros((2, 3, 4, 4)) + np.eye(4)
    grid[..., 0, 3] = np.arange(6).reshape(2, 3)
    assert scene.place(0, grid, mask=[1, 2, 3]).tolist() == [[2, 3, 4], [5, 6, 7]]
    assert scene.place(1, np.zeros((0, 3, 4))).shape == (0,)
    assert scene.place(1, moved_by(7), mask=[4, 5]).tolist() == [8, 9]
    assert (scene.geometry_count, scene.instance_count) == (2, 10)
    assert scene.geometry_of(np.arange(10)).tolist() == [1] + [0] * 7 + [1] * 2
    assert scene.mask_of([[0, 1], [2, 9]]).tolist() == [[0xFFFFFFFF, 6], [1, 5]] and scene.mask_of(4) == 3
    assert scene.transform_of(6)[0].tolist() == [1, 0, 0, 4]
    assert scene.transform_of(range(2, 8))[:, 0, 3].tolist() == list(range(6))
    scene.move([8, 9], moved_by(1))
    scene.move(3, np.eye(4) * [[2], [3], [4], [1]])
    scene.set_mask([[2], [3]], 9)
    assert scene.transform_of([3, 8, 9])[:, 0, 0].tolist() == [2, 1, 1]
    assert scene.transform_of(9)[0, 3] == 1 and scene.mask_of([2, 3, 4]).tolist() == [9, 9, 3]
    assert re.fullmatch(r"<raylanes.Scene of 2 geometries of float32 in 10 instances, \d+ bytes without geometries>",
                        repr(scene))
    assert scene.nbytes > 1000


def test_changes_are_those_of_a_new_scene():
    parts = Parts(6)
    scene = raylanes.Scene()
    for tree in parts.trees:
        scene.add(cube())
    for geometry in parts.geometries.tolist():
        scene.place(geometry, mask=8)
    scene.update()
    scene.set_mask(range(7), parts.masks)
    scene.move(range(7), parts.transforms)
    for geometry, tree in enumerate(parts.trees):
        scene.replace(geometry, tree)
    scene.update()
    for mask in (0xFFFFFFFF, 0b10):
        assert [hit.item() for hit in scene.closest(parts.rays, mask=mask)] == nearest(parts.hits(mask))
    assert scene.closest(parts.rays).tobytes() == parts.scene().closest(parts.rays).tobytes()


@pytest.mark.parametrize("change", [
    lambda scene: scene.place(0), lambda scene: scene.move(0, moved_by(1)), lambda scene: scene.replace(0, cube()),
    lambda scene: scene.refit(0, cube_vertices, cube_faces)])
def test_a_query_of_a_changed_scene_says_that_update_is_missing(change):
    scene = scene_of_cubes()
    before = scene.closest(rays)
    change(scene)
    for call in (lambda: scene.closest(rays), lambda: scene.occluded(rays), lambda: scene.closest(rays, after=before),
                 lambda: scene.occluded_from([0, 0, 0], rays["origin"])):
        with pytest.raises(RuntimeError, match=r"^scene: it was changed; update\(\) comes before the next query$"):
            call()
    scene.update()
    assert scene.closest(rays).hit.any()
    scene.set_mask(0, 0)  # at once
    assert (scene.closest(rays).instance != 0).all()


def test_what_is_refused_changes_nothing():
    scene = scene_of_cubes()
    before, hits = scene._tree.to_bytes(), scene.closest(rays).tobytes()
    doubles = raylanes.Bvh(cube_vertices.astype(float), cube_faces)
    wrong = [(IndexError, "there is no geometry 1, it has 1", lambda: scene.place(1)),
             (IndexError, "there is no geometry 7, it has 1", lambda: scene.place(7, np.zeros((3, 3, 4)))),
             (IndexError, "there is no geometry 1", lambda: scene.replace(1, cube())),
             (IndexError, "there is no geometry 1", lambda: scene.refit(1, cube_vertices, cube_faces)),
             (IndexError, "there is no instance 3, it has 3", lambda: scene.move([0, 3], moved_by(9))),
             (IndexError, "there is no instance 3", lambda: scene.set_mask([1, 2, 3], 0)),
             (IndexError, "there is no instance 5", lambda: scene.mask_of([0, 5])),
             (ValueError, "^instance: -1 is out of range", lambda: scene.move(-1, moved_by(9))),
             (ValueError, "^geometry: -1 is negative$", lambda: scene.place(-1)),
             (ValueError, "^mask: 4294967296 is out of range", lambda: scene.set_mask(0, 2**32)),
             (ValueError, "^mask: -1 is negative$", lambda: scene.closest(rays, mask=-1)),
             (TypeError, "^mask: integers are needed, not float64$", lambda: scene.set_mask(0, 1.0)),
             (TypeError, "^instance: integers are needed, not bool$", lambda: scene.set_mask([True], 1)),
             (ValueError, r"^transform: the shape must be .* it is \(3, 3\)$", lambda: scene.place(0, np.eye(3))),
             (ValueError, r"^transform: the shape .* \(4, 3\)$", lambda: scene.move(0, np.eye(4)[:, :3])),
             (ValueError, "^transform: the fourth row must be 0, 0, 0, 1$", lambda: scene.move(0, np.ones((4, 4)))),
             (ValueError, "broadcast", lambda: scene.move([0, 1], np.zeros((3, 3, 4)))),
             (ValueError, "broadcast", lambda: scene.place(0, np.zeros((2, 3, 4)), mask=[1, 2, 3])),
             (ValueError, "^tree: the scene has float32, this Bvh has float64; give it a Bvh made with "
                          "dtype=numpy.float32$", lambda: scene.add(doubles)),
             (ValueError, "^tree: the scene has float32", lambda: scene.replace(0, doubles)),
             (TypeError, "^tree: a Bvh, a SphereTree or a mesh is needed, not KdTree$",
              lambda: scene.add(cube(raylanes.KdTree))),
             (TypeError, "^tree: a Bvh, a SphereTree or a mesh is needed, not Scene$",
              lambda: scene.replace(0, scene)),
             (ValueError, "triangles", lambda: scene.refit(0, cube_vertices, cube_faces[1:])),
             (ValueError, "^vertices: float32 does not hold these float64 numbers; the scene has float32: ",
              lambda: scene.refit(0, cube_vertices.astype(float) / 3, cube_faces)),
             (TypeError, "^after: hits of this tree or scene are needed",
              lambda: scene.closest(rays, after=cube().closest(rays))),
             (ValueError, "^after: the shape", lambda: scene.closest(rays, after=scene.closest(rays[1:]))),
             (TypeError, "^out: ", lambda: scene.closest(rays, out=cube().closest(rays)))]
    for error, sentence, call in wrong:
        with pytest.raises(error, match=sentence):
            call()
        assert scene._tree.to_bytes() == before and scene.closest(rays).tobytes() == hits
    mixed = raylanes.Scene()
    mixed.place(mixed.add(raylanes.SphereTree([[0, 0, 0]], 1)))
    mixed.update()
    with pytest.raises(ValueError, match="facing front is for triangles"):
        mixed.closest(rays, facing="front")
    with pytest.raises(ValueError, match="geometry 0 has no triangles"):
        mixed.refit(0, cube_vertices, cube_faces)


@typed
def test_meshes_that_stand_have_a_tree_in_common(dtype):
    scene = raylanes.Scene()
    for _ in range(8):
        scene.place(scene.add(cube(dtype=dtype)))
    scene.update(threads=1)
    before, report = scene.closest(rays).tobytes(), scene.report()
    assert report["common_instances"] == 8 and report["common_triangles"] == 8 * len(cube_faces)
    assert 1000 < report["common_bytes"] < scene.nbytes
    scene.set_moving([[2], [5]])
    scene.update()
    assert scene.report()["common_instances"] == 6 and scene.closest(rays).tobytes() == before
    scene.set_moving(range(8))
    scene.update()
    assert scene.report()["common_bytes"] == scene.report()["common_instances"] == 0
    assert scene.report()["mesh_triangles"] == 8 * len(cube_faces) and scene.closest(rays).tobytes() == before
    with pytest.raises(IndexError, match="there is no instance 8"):
        scene.set_moving([0, 8], False)


def test_meshes_need_no_tree_of_their_own():
    scene, of_trees = raylanes.Scene(), raylanes.Scene()
    for k in range(6):
        scene.place(scene.add(cube_vertices + np.float32(4 * k), cube_faces))
        of_trees.place(of_trees.add(raylanes.Bvh(cube_vertices + np.float32(4 * k), cube_faces)))
    scene.update(), of_trees.update()
    report = scene.report()
    assert report["common_instances"] == report["meshes_without_tree"] == 6
    assert of_trees.report()["meshes_without_tree"] == 0
    for _ in range(2):
        assert scene.closest(rays).tobytes() == of_trees.closest(rays).tobytes()
        scene.set_moving(range(6)), scene.update()
    assert scene.report()["meshes_without_tree"] == 0
    assert scene.add(types.SimpleNamespace(vertices=cube_vertices, faces=cube_faces)) == 6
    wrong = [(ValueError, "^vertices: ", lambda: scene.add([[0.1, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])),
             (ValueError, "3", lambda: scene.add([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]])),
             (TypeError, "", lambda: scene.add(cube(), cube_faces)), (TypeError, "", lambda: scene.add(None))]
    for error, sentence, call in wrong:
        with pytest.raises(error, match=sentence):
            call()
    assert scene.geometry_count == 7


def test_answers_go_where_they_are_wanted():
    scene, few = scene_of_cubes(), rays[:300]
    for ask, of, dtype in [(scene.closest, few, raylanes.scene_hit_dtype), (scene.occluded, few, bool),
                           (lambda to, **more: scene.occluded_from([9, 9, 9], to, **more), few["origin"], bool)]:
        expected = ask(of)
        for out in (np.zeros(300, dtype), np.zeros(900, dtype)[::3], np.zeros(300, dtype)[::-1]):
            assert ask(of, out=out) is out and out.tobytes() == expected.tobytes()
        active = np.arange(300) % 3 == 0
        out = np.ones(300, dtype)
        ask(of, out=out, active=active)
        assert out[active].tobytes() == expected[active].tobytes() and (out[~active] == np.ones(1, dtype)).all()
        fresh = ask(of, active=active)
        assert fresh[active].tobytes() == expected[active].tobytes()
        assert not (fresh.hit if dtype is raylanes.scene_hit_dtype else fresh)[~active].any()
    hits = scene.closest(few, active=np.zeros(300, bool))
    assert (hits.instance == raylanes.no_part).all() and (hits.geometry == raylanes.no_part).all()
    one = scene.closest(few[0])
    assert one.shape == () and one == scene.closest(few)[0] and isinstance(scene.occluded(few[0]), np.bool_)
    apart = np.zeros(300, [("before", "u1"), ("hit", raylanes.scene_hit_dtype)])
    assert scene.closest(few, out=apart["hit"]).tobytes() == scene.closest(few).tobytes()
    assert not apart["before"].any() and scene.closest([]).shape == (0,)


@typed
def test_a_tree_and_its_scenes_change_alone(dtype):
    vertices, faces = sphere(triangles=500)
    tree, scene, other = raylanes.Bvh(vertices, faces, dtype=dtype), raylanes.Scene(), raylanes.Scene()
    for each in (scene, other):
        each.place(each.add(tree))
        each.update()
    expected = {size: raylanes.Bvh(vertices * np.float32(size), faces, dtype=dtype).closest(rays).t.tobytes()
                for size in (1, 2, 3, 4)}
    tree.refit(vertices * np.float32(2), faces)
    assert tree.closest(rays).t.tobytes() == expected[2]
    assert scene.closest(rays).t.tobytes() == other.closest(rays).t.tobytes() == expected[1]
    for size in (3, 4):
        scene.refit(0, vertices * np.float32(size), faces)
        scene.update()
        assert scene.closest(rays).t.tobytes() == expected[size]
        assert tree.closest(rays).t.tobytes() == expected[2] and other.closest(rays).t.tobytes() == expected[1]
    del tree, other
    assert scene.closest(rays).t.tobytes() == expected[4]


class Named(raylanes.Scene):
    """A scene with an attribute in a slot."""
    __slots__ = ("colour",)


@pytest.mark.parametrize("copied", copies)
@typed
def test_copies_change_alone(copied, dtype):
    scene = Named()
    scene.place(scene.add(cube(dtype=dtype)), [moved_by(0), moved_by(3)])
    scene.update()
    scene.name, scene.colour, scene.itself = "box", "red", scene
    other = copied(scene)
    assert type(other) is Named and (other.name, other.colour) == ("box", "red")
    assert other.itself is other or copied is copy.copy
    before = scene.closest(rays).tobytes()
    assert other.closest(rays).tobytes() == before
    changes = [lambda s: s.move(1, moved_by(-3)), lambda s: s.place(0, moved_by(0, 3)), lambda s: s.set_mask(0, 0),
               lambda s: s.refit(0, cube_vertices / 2, cube_faces), lambda s: s.add(cube(dtype=dtype)),
               lambda s: s.place(1, [moved_by(6), moved_by(9)])]
    for change in changes:
        change(other), other.update()
        assert scene.closest(rays).tobytes() == before != other.closest(rays).tobytes()
        assert (scene.instance_count, scene.geometry_count) == (2, 1)
    after = other.closest(rays).tobytes()
    scene.set_mask([0, 1], 0), scene.refit(0, cube_vertices * 2, cube_faces), scene.update()
    assert other.closest(rays).tobytes() == after and not scene.closest(rays).hit.any()


def test_copies_share_memory():
    scene = raylanes.Scene()
    scene.place(scene.add(raylanes.Bvh(*sphere(triangles=200000))), np.zeros((10, 3, 4)))
    others = [copy.deepcopy(scene) for _ in range(1000)]  # 14 GB of triangles
    for other in others[:100]:
        other.place(0)
    assert {other.instance_count for other in others} == {10, 11}


@typed
def test_files(tmp_path, dtype):
    parts = Parts(7, dtype=dtype)
    scene, rays = parts.scene(), parts.rays
    if dtype == np.float32:
        scene.add(raylanes.SphereTree([[0, 0, 0], [9, 9, 9]], [1, -1]))
    else:
        scene.add(parts.scene())
    scene.place(3, mask=2)
    scene.update()
    expected = scene.closest(rays).tobytes()
    scene.save(tmp_path / "scene")
    memory = io.BytesIO()
    cube(dtype=dtype).save(memory), scene.save(memory), scene.save(memory), memory.write(b"behind"), memory.seek(0)
    raylanes.Bvh.load(memory)
    for other in (raylanes.Scene.load(tmp_path / "scene"), raylanes.Scene.load(memory), raylanes.Scene.load(memory)):
        assert type(other) is raylanes.Scene and other.closest(rays).tobytes() == expected and other.dtype == dtype
        assert other.mask_of(range(8)).tolist() == scene.mask_of(range(8)).tolist()
        assert other.transform_of(range(8)).tobytes() == scene.transform_of(range(8)).tobytes()
    assert memory.read() == b"behind"
    whole = (tmp_path / "scene").read_bytes()
    for data in (b"", whole[:-1], whole[:100], b"x" * 500, whole[:300] + b"\1" + whole[301:]):
        with pytest.raises(ValueError, match="^tree file: "):
            raylanes.Scene.load(io.BytesIO(data))
    with pytest.raises(ValueError, match="^tree file: "):
        raylanes.Bvh.load(tmp_path / "scene")
    scene.place(0, moved_by(50))
    assert pickle.loads(pickle.dumps(scene)).closest(rays).hit.any()  # ready, as after update()


@typed
def test_masks_of_triangles_hide_them_from_rays(dtype):
    scene = scene_of_cubes(dtype=dtype)
    whole = scene.closest(rays)
    masks = np.arange(12) % 3 == 0
    scene.set_triangle_masks(0, np.where(masks, 0b10, 0b01))
    scene.update()
    hidden = scene.closest(rays, mask=0b01)
    assert scene.closest(rays).tobytes() == whole.tobytes() and not masks[hidden.primitive[hidden.hit]].any()
    seen = ~masks[np.where(whole.hit, whole.primitive, 1)]
    assert np.array_equal(hidden[seen], whole[seen]) and (hidden != whole).any()
    assert np.array_equal(scene.all_hits(rays, mask=0b01, max_count=1).items, hidden[hidden.hit])
    for wrong, text in ((np.ones((2, 2), int), r"^masks: the shape must be \(n,\), it is \(2, 2\)$"),
                        ([2**32], "^masks: 4294967296 is out of range")):
        with pytest.raises(ValueError, match=text):
            scene.set_triangle_masks(0, wrong)
    with pytest.raises(IndexError, match="there is no geometry 1"):
        scene.set_triangle_masks(1, [1])
    with pytest.raises(ValueError, match="geometry 0 has masks of triangles"):
        pickle.dumps(scene)
    scene.set_triangle_masks(0, None)
    scene.update()
    assert scene.closest(rays, mask=0b01).tobytes() == whole.tobytes()
