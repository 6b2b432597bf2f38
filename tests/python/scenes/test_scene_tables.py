"""Names of instances, and records as columns of tables."""

import copy
import io
import pickle

import numpy as np
import pytest

import raylanes
from meshes import cube, cube_faces, cube_vertices, random_rays
from parts import Parts, number_types

pandas = None
try:
    import pandas
except ImportError:
    pass


def scene_of_names(dtype=np.float32):
    scene = raylanes.Scene()
    scene.add(cube_vertices.astype(dtype), cube_faces)
    shifts = np.zeros((3, 3, 4)) + np.eye(4)[:3]
    shifts[:, 0, 3] = [0, 5, 10]
    scene.place(0, shifts, name=["left", "middle", "left"])
    scene.place(0, [[1, 0, 0, 0], [0, 1, 0, 9], [0, 0, 1, 0]])
    assert scene.place(0, [[1, 0, 0, 5], [0, 1, 0, 9], [0, 0, 1, 0]], name="behind") == 4
    scene.update()
    return scene


@pytest.mark.parametrize("dtype", number_types)
def test_hits_have_the_names_of_their_instances(dtype):
    scene = scene_of_names(dtype)
    names = np.array(["left", "middle", "left", "", "behind", ""])
    rays = random_rays(5, 2000, reach=6)
    rays["origin"][:, 0] += 5
    hits = scene.closest(rays)
    assert len(np.unique(hits.instance)) == 6  # and misses
    assert (scene.name_of(hits.instance) == names[np.minimum(hits.instance, 5)]).all()
    lists = scene.all_hits(rays)
    assert (scene.name_of(lists.items.instance) == names[lists.items.instance]).all()
    assert scene.name_of(1) == "middle" and type(scene.name_of(1)) is str
    assert scene.name_of([[0, 1], [3, raylanes.no_part]]).tolist() == [["left", "middle"], ["", ""]]
    assert scene.name_of([]).shape == (0,) and scene.name_of(np.zeros((2, 0), int)).shape == (2, 0)
    assert scene.instances_named("left").tolist() == [0, 2] and scene.instances_named("").tolist() == []
    assert scene.instances_named("left").dtype == np.int64


@pytest.mark.parametrize("dtype", number_types)
def test_names_are_those_of_a_copy_alone(dtype):
    scene = scene_of_names(dtype)
    others = copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))
    assert scene.place(0, name="first") == 5
    for number, other in enumerate(others):
        assert other.name_of(range(5)).tolist() == ["left", "middle", "left", "", "behind"]
        assert other.place(0, name=str(number)) == 5
    assert [other.name_of(5) for other in (scene, *others)] == ["first", "0", "1", "2"]
    file = io.BytesIO()
    scene.save(file)
    file.seek(0)
    loaded = raylanes.Scene.load(file)
    assert loaded.name_of(range(6)).tolist() == [""] * 6  # which files do not keep
    loaded.place(0, name="new")
    assert loaded.name_of(6) == "new" and raylanes.Scene().instances_named("new").size == 0


def test_wrong_names_are_refused():
    scene = scene_of_names()
    for name in (1, [1, 2], [["a"], [None]], b"a"):
        with pytest.raises(TypeError, match="^name: strings are needed"):
            scene.place(0, name=name)
    with pytest.raises(ValueError, match="broadcast"):
        scene.place(0, np.zeros((3, 3, 4)), name=["a", "b"])
    with pytest.raises(IndexError, match="there is no instance 5"):
        scene.name_of([0, 5])
    with pytest.raises(IndexError, match="there is no geometry 3"):
        scene.place(3, name="a")
    assert scene.instance_count == 5 and scene.instances_named("a").size == 0


@pytest.mark.parametrize("dtype", number_types)
def test_a_mesh_replaces_a_geometry(dtype):
    scene = scene_of_names(dtype)
    rays = random_rays(6, 500, reach=5)
    vertices = cube_vertices * np.float32(0.5)
    scene.replace(0, vertices, cube_faces, threads=1)
    scene.update()
    other = scene_of_names(dtype)
    other.replace(0, raylanes.Bvh(vertices, cube_faces, dtype=dtype))
    other.update()
    assert scene.closest(rays).tobytes() == other.closest(rays).tobytes() and scene.closest(rays).hit.any()
    if dtype == np.float64:
        return
    with pytest.raises(ValueError, match="float32 does not hold"):
        scene.replace(0, cube_vertices.astype(float) / 3, cube_faces)


def tables():
    tree, doubles, site = cube(), raylanes.Bvh(cube_vertices.astype(float), cube_faces), scene_of_names(float)
    rays = random_rays(7, 300, reach=3)
    for scene in (Parts(3).scene(), site):
        yield scene.closest(rays), ["t", "u", "v", "primitive", "geometry", "instance"]
        yield scene.crossings(rays).items, ["t", "primitive", "side", "geometry", "instance"]
    yield site.stretches(rays).items, ["entry", "exit", "entered_by", "left_by", "winding", "geometry", "instance"]
    yield site.closest_points(rays["origin"]), ["distance_squared", "distance", "point_x", "point_y", "point_z", "u",
                                                "v", "primitive", "geometry", "instance"]
    yield tree.closest(rays.reshape(20, 15)), ["t", "u", "v", "primitive"]
    yield doubles.closest(rays), ["t", "u", "v", "primitive"]
    yield doubles.stretches(rays).items, ["entry", "exit", "entered_by", "left_by", "winding"]
    yield tree.closest_points(rays["origin"]), ["distance_squared", "point_x", "point_y", "point_z", "u", "v",
                                                "primitive"]
    yield doubles.closest_points(rays["origin"]), ["distance_squared", "distance", "point_x", "point_y", "point_z", "u",
                                                   "v", "primitive"]


@pytest.mark.parametrize("number", range(11))
def test_records_are_columns(number):
    records, names = list(tables())[number]
    columns = records.columns()
    assert list(columns) == names and len(records) > 5
    for name, column in columns.items():
        field = records[name] if name in records.dtype.names else records["point"][..., "xyz".index(name[-1])]
        assert type(column) is np.ndarray and column.flags.c_contiguous and column.shape == (records.size,)
        assert column.dtype == field.dtype and column.tobytes() == np.ascontiguousarray(field).tobytes()
        column[:] = 0
    assert records.columns()[names[0]].any()  # no views
    assert records[:0].columns()[names[0]].shape == (0,)


def test_lists_are_columns_with_their_rays():
    rays = random_rays(8, 100, reach=3)
    lists = cube().all_hits(rays)
    columns = lists.columns()
    assert list(columns) == ["ray", "t", "u", "v", "primitive"]
    assert columns["ray"].tolist() == [ray for ray, items in enumerate(lists) for _ in items]
    assert columns["t"].tolist() == lists.items.t.tolist()


@pytest.mark.skipif(pandas is None, reason="tables were not tested: pandas is not installed")
def test_columns_are_tables_of_pandas():
    scene = scene_of_names()
    hits = scene.closest(random_rays(9, 300, reach=6))
    table = pandas.DataFrame({**hits.columns(), "name": scene.name_of(hits.instance)})
    assert len(table) == 300 and (table.groupby("name").size().sum() == 300)
    assert (table[table.name == "middle"].instance == 1).all()
