"""Trees in several threads and processes, in files, and on paths of one's choice."""

import copy
import io
import multiprocessing
import os
import pickle
import resource
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import raylanes
from meshes import cube_faces, cube_vertices, random_rays, sphere, supported
from raylanes import _native

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


def test_files_stay_until_the_new_ones_are_complete(tmp_path):
    tree, file, link, pipe = raylanes.Bvh(cube_vertices, cube_faces), *(tmp_path / n for n in ("file", "link", "pipe"))
    file.write_bytes(b"old"), file.chmod(0o640), link.symlink_to("file"), os.mkfifo(pipe)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (16, limits[1]))  # Python ignores SIGXFSZ
    try:
        for name in (file, link, tmp_path / "new"):
            with pytest.raises(OSError):
                tree.save(name)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    with pytest.raises(FileNotFoundError):
        tree.save(tmp_path / "missing" / "file")
    assert file.read_bytes() == b"old" and sorted(p.name for p in tmp_path.iterdir()) == ["file", "link", "pipe"]
    tree.save(os.fsencode(link))
    assert link.is_symlink() and file.stat().st_mode & 0o777 == 0o640
    assert raylanes.Bvh.load(file).nbytes == tree.nbytes
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    tree.save(pipe)
    assert os.read(reader, 1 << 20) == file.read_bytes() and pipe.is_fifo()
    os.close(reader)


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


@pytest.mark.parametrize("kind", kinds)
def test_bytes_of_trees_are_released(kind):
    """A bytearray that something still uses cannot change its size."""
    native = getattr(_native, kind.__name__)
    data = bytearray(kind(cube_vertices, cube_faces)._tree.to_bytes())
    native(data)
    del data[-1:]
    with pytest.raises(ValueError, match="^tree file: "):
        native(data)
    data.append(0)
    with pytest.raises(BufferError):
        native(memoryview(data)[::2])


def test_threads_at_once():
    """Each query of many threads, while others refit: the bytes that one thread alone gets from one of the states."""
    vertices, faces = sphere()
    rays = random_rays(2, 4000)
    points = rays["origin"]
    queries = [lambda tree, threads: tree.closest(rays, threads=threads).tobytes(),
               lambda tree, threads: tree.occluded(rays, threads=threads).tobytes(),
               lambda tree, threads: tree.all_hits(rays, threads=threads).items.tobytes(),
               lambda tree, threads: tree.count_crossings(rays, threads=threads).tobytes(),
               lambda tree, threads: tree.locate(points, threads=threads).tobytes(),
               lambda tree, threads: tree.closest_points(points, threads=threads).tobytes(),
               lambda tree, threads: tree.signed_distances(points, threads=threads).tobytes(),
               lambda tree, threads: tree.winding_numbers(points, threads=threads).tobytes(),
               lambda tree, threads: tree.bounds.tobytes()]
    states = [vertices * np.float32(s) for s in (1, 1.25)]
    alone = [raylanes.Bvh(state, faces) for state in states]
    expected = [{query(tree, 1) for tree in alone} for query in queries]
    assert all(len(answers) == 2 for answers in expected)
    shared = raylanes.Bvh(vertices, faces)

    def ask(i):
        if i % 12 == 0:
            shared.refit(states[i // 12 % 2], faces)
        return queries[i % 9](shared, i % 3) in expected[i % 9]

    with ThreadPoolExecutor(16) as pool:
        assert all(pool.map(ask, range(120)))


def turns_during(work):
    """How often this thread runs in the middle half of the time that work takes in another one."""
    times, turns = [], []

    def timed():
        times.append(time.perf_counter())
        work()
        times.append(time.perf_counter())

    other = threading.Thread(target=timed)
    other.start()
    while other.is_alive():
        time.sleep(0.0005)
        turns.append(time.perf_counter())
    begin, end = times
    return sum(abs(turn - (begin + end) / 2) < (end - begin) / 4 for turn in turns)


def test_others_run_while_the_library_works():
    """A call that keeps the GIL lets no other thread of Python run before it ends. Each call here takes a hundred turns
    of this thread; a machine that is too busy for one of them gets two more tries."""
    vertices, faces = sphere(triangles=100000)
    tree, rays = raylanes.Bvh(vertices, faces), random_rays(5, 1 << 19)
    for work in [lambda: raylanes.Bvh(vertices, faces, builder="sweep_sah", threads=1),
                 lambda: tree.closest(rays, threads=1)]:
        assert any(turns_during(work) > 0 for _ in range(3))


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


def test_a_path_reaches_the_kernels():
    """The fast grade rounds as its path does: with and without fused operations some t differ in their last bits."""
    fused = [path for path in supported if path in ("avx2", "avx512", "neon")]
    if not fused:
        pytest.skip("paths with fused operations were not tested: this processor has none")
    tree, rays = raylanes.Bvh(*sphere()), random_rays(9, 20000)
    traced = {}
    for path in ("scalar", fused[0]):
        with raylanes.use_path(path):
            traced[path] = tree.closest(rays, test="moller_trumbore", grade="fast")
    apart = np.count_nonzero(traced["scalar"].t != traced[fused[0]].t)
    assert 0 < apart < len(rays) / 2


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
