"""Copies and pickles of trees are those of any Python object, and files hold more than one tree."""

import copy
import io
import os
import pickle
import threading

import numpy as np
import pytest

import raylanes
from meshes import copies, cube, cube_faces, cube_vertices, random_rays, sphere

kinds = [raylanes.Bvh, raylanes.KdTree]


class NamedBvh(raylanes.Bvh):
    """A tree with an attribute in a slot, and one that says how it is pickled."""
    __slots__ = ("colour",)

    def __init__(self, name):
        super().__init__(cube_vertices, cube_faces)
        self.name, self.colour, self.itself = name, "red", self


class Cached(raylanes.KdTree):
    def __getstate__(self):
        return {name: value for name, value in self.__dict__.items() if name != "cache"}


@pytest.mark.parametrize("kind", kinds)
@pytest.mark.parametrize("copied", copies)
def test_attributes_of_trees(kind, copied):
    tree = cube(kind)
    tree.names = ["a", "b"]
    other = copied(tree)
    assert type(other) is kind and other.names == ["a", "b"] and tree.names is not other or copied is copy.copy
    assert (other.names is tree.names) == (copied is copy.copy)
    assert other.closest(random_rays(1, 50)).tobytes() == tree.closest(random_rays(1, 50)).tobytes()


@pytest.mark.parametrize("copied", copies)
def test_members_of_subclasses(copied):
    tree = copied(NamedBvh("box"))
    assert type(tree) is NamedBvh and (tree.name, tree.colour) == ("box", "red")
    assert tree.itself is tree or copied is copy.copy
    cached = cube(Cached)
    cached.cache, cached.name = lambda: 1, "box"
    other = copied(cached)
    assert other.name == "box" and not hasattr(other, "cache") and other.inside([[0, 0, 0]])[0]


@pytest.mark.parametrize("copied", copies)
def test_a_refit_of_a_copy_is_its_own(copied):
    vertices, faces = sphere()
    tree, rays = raylanes.Bvh(vertices, faces), random_rays(1, 500)
    before = tree.closest(rays).tobytes()
    other = copied(tree)
    other.refit(vertices * np.float32(2), faces)
    after = other.closest(rays).tobytes()
    assert tree.closest(rays).tobytes() == before != after
    tree.refit(vertices * np.float32(3), faces)
    assert other.closest(rays).tobytes() == after


@pytest.mark.parametrize("kind", kinds)
def test_copies_share_memory(kind):
    """A copy is made in no time, whatever the size: it has the nodes of the other one."""
    tree = kind(*sphere(triangles=20000))
    assert len(pickle.dumps([tree, tree])) < 1.1 * len(pickle.dumps(tree))
    trees = [copy.deepcopy(tree) for _ in range(1000)]  # 1.4 GB
    assert all(other.nbytes == tree.nbytes for other in trees)


def saved(*trees):
    file = io.BytesIO(b"before")
    file.seek(6)
    for tree in trees:
        tree.save(file)
    file.write(b"behind")
    file.seek(6)
    return file


@pytest.mark.parametrize("kind", kinds)
def test_trees_in_one_file(kind, tmp_path):
    rays, trees = random_rays(1, 200), [kind(*sphere()), cube(kind)]
    expected = [tree.closest(rays).tobytes() for tree in trees]
    memory = saved(*trees)
    (tmp_path / "file").write_bytes(memory.getvalue())
    with open(tmp_path / "file", "rb") as buffered, open(tmp_path / "file", "rb", buffering=0) as raw:
        for file in (memory, buffered, raw):
            file.seek(6)
            assert [kind.load(file).closest(rays).tobytes() for _ in trees] == expected
            assert file.read() == b"behind"


@pytest.mark.parametrize("buffering", [-1, 0])
def test_trees_in_a_pipe(buffering):
    trees = [raylanes.Bvh(*sphere()), cube(raylanes.KdTree)]
    data = saved(*trees).getvalue()[6:]
    reading, writing = os.pipe()

    def write():
        with open(writing, "wb") as file:
            file.write(data)

    writer = threading.Thread(target=write)
    writer.start()
    with open(reading, "rb", buffering) as file:
        assert [kind.load(file).nbytes for kind in kinds] == [tree.nbytes for tree in trees]
        assert file.read() == b"behind"
    writer.join()


def test_files_that_return_less_than_asked_for():
    class Dripping(io.BytesIO):
        def read(self, size=-1):
            return super().read(min(size, 100))

    tree = cube()
    assert raylanes.Bvh.load(Dripping(saved(tree).getvalue()[6:])).nbytes == tree.nbytes


def test_errors_of_files_pass():
    class Failing(io.BytesIO):
        def read(self, size=-1):
            raise TimeoutError("too slow")

    class Greedy(io.BytesIO):
        def read(self, size=-1):
            return super().read()

    with pytest.raises(TimeoutError, match="^too slow$"):
        raylanes.Bvh.load(Failing())
    with pytest.raises(ValueError, match="^file: read\\(\\) returned more bytes than it was asked for$"):
        raylanes.Bvh.load(Greedy(saved(cube()).getvalue()[6:]))
    cut = saved(cube()).getvalue()[6:-200]
    with pytest.raises(ValueError, match="^tree file: it ends before the tree does$"):
        raylanes.Bvh.load(io.BytesIO(cut))


@pytest.mark.parametrize("kind", kinds)
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_vertices_that_no_face_uses_are_any(kind, value):
    vertices = np.insert(cube_vertices, 3, value, axis=0)
    faces = cube_faces + (cube_faces >= 3)
    tree, rays = kind(vertices, faces), random_rays(1, 200)
    assert tree.closest(rays).tobytes() == cube().closest(rays).tobytes()
    assert raylanes.closed_report(vertices, faces)["is_closed"]
    if kind is raylanes.Bvh:
        tree.refit(vertices, faces)
        assert tree.closest(rays).tobytes() == cube().closest(rays).tobytes()
    faces[5, 1] = 3
    with pytest.raises(ValueError, match=f"^vertex 3: coordinate x is {value}, allowed are finite numbers$"):
        kind(vertices, faces)
