"""Queries while the program ends, while it forks, and while a tree is refitted."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import raylanes
from meshes import random_rays, sphere

begin_queries = """
import threading, time, numpy as np, raylanes
random = np.random.default_rng(1)
tree = raylanes.Bvh(random.uniform(-1, 1, (3000, 3)), np.arange(3000).reshape(1000, 3))
rays = raylanes.rays(random.uniform(-2, 2, (100000, 3)), random.normal(size=(100000, 3)))
def ask():
    while True:
        tree.closest(rays, threads={threads})
threading.Thread(target=ask, daemon=True).start()
time.sleep(0.05)
"""


@pytest.mark.parametrize("threads", [1, 0])
def test_a_program_ends_while_a_thread_asks(threads):
    for _ in range(20 if os.environ.get("RAYLANES_LEVEL") in ("all", "exhaustive") else 8):
        done = subprocess.run([sys.executable, "-c", begin_queries.format(threads=threads)], capture_output=True,
                              text=True, timeout=60, check=False)
        assert (done.returncode, done.stderr) == (0, "")


def status_of_child(work):
    """The exit status of a forked child that does the work, 0 if that is true; negative if it hangs for 20 s."""
    child = os.fork()
    if child == 0:
        try:
            signal.alarm(20)
            os._exit(0 if work() else 1)
        except BaseException:  # pytest runs in the child, too
            os._exit(2)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def statuses_of_children(ask, work, count):
    """The statuses of children that work while two threads of their parent ask again and again."""
    ends = threading.Event()

    def asks():
        while not ends.is_set():
            ask()

    others = [threading.Thread(target=asks) for _ in range(2)]
    for other in others:
        other.start()
    try:
        return [status_of_child(work) for _ in range(count)]
    finally:
        ends.set()
        for other in others:
            other.join()


@pytest.mark.parametrize("threads", [1, 0])
def test_children_of_a_busy_program(threads):
    """The child of a fork has no other thread of its parent, and what these hold locked stays so."""
    vertices, faces = sphere()
    tree, rays = raylanes.Bvh(vertices, faces), random_rays(1, 20000)
    expected = tree.closest(rays).tobytes()

    def ask():
        tree.closest(rays, threads=threads)
        tree.winding_numbers(rays["origin"][:100], threads=threads)

    def work():
        asked = tree.closest(rays).tobytes() == expected
        tree.refit(vertices + np.float32(3), faces)
        new = raylanes.Bvh(vertices + np.float32(3), faces)
        return asked and tree.closest(rays).tobytes() == new.closest(rays, threads=2).tobytes() != expected

    assert statuses_of_children(ask, work, 10) == [0] * 10
    assert tree.closest(rays).tobytes() == expected


def test_a_child_has_threads_if_its_parent_used_none():
    script = """if True:
        import os, sys, numpy as np, raylanes
        vertices = np.random.default_rng(1).uniform(-1, 1, (300000, 3))
        def threads():
            return len(os.listdir("/proc/self/task"))
        def threads_of_a_build():
            before = threads()
            raylanes.Bvh(vertices, np.arange(300000).reshape(100000, 3), threads=2)
            return threads() - before
        if sys.argv[1] == "used":
            threads_of_a_build()
        child = os.fork()
        if child == 0:
            os._exit(threads_of_a_build())
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    """
    threads = {parent: int(subprocess.run([sys.executable, "-c", script, parent], capture_output=True, text=True,
                                          timeout=60, check=True).stdout) for parent in ("used", "unused")}
    assert threads["used"] == 0
    assert threads["unused"] > 0 or os.cpu_count() == 1


def test_a_refit_does_not_wait_for_queries():
    """A query that began before keeps the mesh of before. A machine that is too busy gets two more tries."""
    vertices, faces = sphere()
    moved, rays = vertices * np.float32(1.25), random_rays(2, 1 << 20)
    before, after = (raylanes.Bvh(mesh, faces).closest(rays).tobytes() for mesh in (vertices, moved))

    def refits_first():
        tree, found = raylanes.Bvh(vertices, faces), []
        query = threading.Thread(target=lambda: found.append(tree.closest(rays, threads=1).tobytes()))
        query.start()
        time.sleep(0.02)
        tree.refit(moved, faces)
        is_first = query.is_alive()
        assert tree.closest(rays).tobytes() == after
        query.join()
        assert found[0] in ((before,) if is_first else (before, after))
        return is_first

    assert any(refits_first() for _ in range(3))


def test_a_refit_copies_nothing_that_nobody_shares(tmp_path):
    """By the most memory that a process has had."""
    script = """if True:
        import copy, sys, threading, numpy as np, raylanes
        def peak():
            with open("/proc/self/status") as status:
                return next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) * 1024
        vertices, faces = (np.load(file) for file in sys.argv[2:4])
        with open(sys.argv[1], "rb") as file:
            tree = raylanes.Bvh.load(file)
        other = copy.copy(tree) if sys.argv[4] == "copied" else None
        if sys.argv[4] == "threads":
            threading.Thread(target=threading.Event().wait, daemon=True).start()
        before = peak()
        tree.refit(vertices, faces, threads=1)
        print((peak() - before) / tree.nbytes)
    """
    vertices, faces = sphere(triangles=300000)
    files = [tmp_path / name for name in ("tree", "vertices.npy", "faces.npy")]
    raylanes.Bvh(vertices, faces).save(files[0]), np.save(files[1], vertices), np.save(files[2], faces)
    more = {sharing: float(subprocess.run([sys.executable, "-c", script, *files, sharing], capture_output=True,
                                          text=True, timeout=60, check=True).stdout)
            for sharing in ("alone", "copied", "threads")}
    assert more["alone"] < 0.4 and more["copied"] > 0.6 and more["threads"] > 0.6
