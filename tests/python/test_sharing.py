"""Trees in several threads and processes, in files, and on paths of one's choice."""

import copy
import io
import multiprocessing
import pickle
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import raylanes
from meshes import cube_faces, cube_vertices, random_rays, sphere, supported

kinds = [raylanes.Bvh, raylanes.KdTree]


@pytest.mark.parametrize("kind", kinds)
def test_files_and_pickles(kind, tmp_path):
    tree, rays = kind(*sphere()), random_rays(1, 500)
    expected = tree.closest(rays).tobytes()
    tree.save(tmp_path / "tree")
    file = io.BytesIO()
    tree.save(file)
    file.seek(0)
    buffers = []
    apart = pickle.dumps(tree, 5, buffer_callback=buffers.append)
    assert len(apart) < 200 and len(buffers) == 1
    others = [kind.load(tmp_path / "tree"), kind.load(str(tmp_path / "tree")), kind.load(file), copy.deepcopy(tree),
              pickle.loads(apart, buffers=buffers)]
    others += [pickle.loads(pickle.dumps(tree, protocol)) for protocol in range(2, 6)]
    for other in others:
        assert type(other) is kind and other.closest(rays).tobytes() == expected
        assert other.report()["bytes"] == tree.report()["bytes"] == tree.nbytes


@pytest.mark.parametrize("kind", kinds)
def test_bytes_that_are_no_tree(kind):
    file = io.BytesIO()
    kind(cube_vertices, cube_faces).save(file)
    whole = file.getvalue()
    wrong = [b"", b"x" * 1000, *(whole[:n] for n in range(0, len(whole), 97))]
    for place in range(0, len(whole), 61):
        damaged = bytearray(whole)
        damaged[place] ^= 0x10
        wrong.append(bytes(damaged))
    for data in wrong:
        with pytest.raises(ValueError, match="^tree file: "):
            kind.load(io.BytesIO(data))
    other = kinds[1 - kinds.index(kind)]
    with pytest.raises(ValueError, match="^tree file: "):
        other.load(io.BytesIO(whole))
    with pytest.raises(FileNotFoundError):
        kind.load("/nowhere/at/all")


def test_threads_at_once():
    vertices, faces = sphere()
    tree, rays = raylanes.Bvh(vertices, faces), random_rays(2, 4000)
    states = [vertices * np.float32(s) for s in (1, 1.25)]
    expected = {raylanes.Bvh(state, faces).closest(rays).tobytes() for state in states}
    assert len(expected) == 2

    def ask(i):
        if i % 4 == 0:
            tree.refit(states[i // 4 % 2], faces)
        return tree.closest(rays, threads=i % 3).tobytes()

    with ThreadPoolExecutor(8) as pool:
        assert set(pool.map(ask, range(64))) <= expected


def test_others_run_while_a_tree_is_built():
    vertices, faces = sphere(triangles=150000)
    builder = threading.Thread(target=lambda: raylanes.Bvh(vertices, faces, builder="sweep_sah", threads=1))
    builder.start()
    turns = 0
    while builder.is_alive():
        time.sleep(0.001)
        turns += 1
    assert turns > 20


def test_a_path_is_that_of_one_thread():
    tree, rays = raylanes.Bvh(*sphere(triangles=200)), random_rays(3, 100)
    expected = tree.closest(rays).tobytes()
    best = raylanes.active_path()
    assert best in supported
    for path in supported:
        with raylanes.use_path(path):
            assert raylanes.active_path() == path and tree.closest(rays).tobytes() == expected
            with raylanes.use_path("scalar"):
                assert raylanes.active_path() == "scalar"
            with ThreadPoolExecutor(1) as pool:
                assert pool.submit(raylanes.active_path).result() == best
            assert raylanes.active_path() == path
    assert raylanes.active_path() == best
    with pytest.raises(ZeroDivisionError), raylanes.use_path("scalar"):
        1 / 0
    assert raylanes.active_path() == best
    assert [p.name for p in raylanes.paths()][0] == "scalar" and raylanes.paths()[0].lanes == 1


def _traced(arguments):
    tree, rays = arguments
    return tree.closest(rays).tobytes()


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes(method):
    tree, rays = raylanes.Bvh(*sphere()), random_rays(4, 20000)
    expected = tree.closest(rays).tobytes()  # with threads, which a fork does not have
    with multiprocessing.get_context(method).Pool(2) as pool:
        parts = pool.map_async(_traced, [(tree, part) for part in np.array_split(rays, 4)]).get(60)
    assert b"".join(parts) == expected
