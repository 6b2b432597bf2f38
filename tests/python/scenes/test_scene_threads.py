"""Scenes in several threads and processes."""

import multiprocessing
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import raylanes
from meshes import cube_faces, cube_vertices, random_rays, sphere
from parts import number_types
from test_processes import statuses_of_children
from test_sharing import turns_during

rays = random_rays(1, 3000, reach=4)


def moved_by(x):
    return [[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, 0]]


def scene_of(size=1, places=(0, 3), dtype=np.float32):
    scene = raylanes.Scene()
    scene.place(scene.add(cube_vertices.astype(dtype) * dtype(size), cube_faces), [moved_by(x) for x in places])
    scene.update()
    return scene


def test_queries_see_each_change_whole():
    """Scenes with two masks, of which one thread changes both again and again."""
    scene = scene_of(places=(0, 0))
    scene.set_mask([0, 1], [1, 2])
    ends, wrong = threading.Event(), []

    def ask():
        while not ends.is_set():
            first, second = scene.closest(rays[:500], threads=1), scene.mask_of([0, 1])
            if not first.hit.any() or sorted(second) != [1, 2]:
                wrong.append(second)

    others = [threading.Thread(target=ask) for _ in range(3)]
    for other in others:
        other.start()
    for i in range(300):
        scene.set_mask([0, 1], [1, 2] if i % 2 else [2, 1])
    ends.set()
    for other in others:
        other.join()
    assert not wrong


@pytest.mark.parametrize("dtype", number_types)
def test_no_change_is_lost(dtype):
    """Each thread places instances and gives them its mask, while others update and ask. A copy of so many instances
    takes long enough for other threads to change the scene meanwhile."""
    scene, before = scene_of(places=np.arange(4000), dtype=dtype), 4000

    def change(number):
        mine = []
        for _ in range(30):
            one = scene.place(0, moved_by(9 * number))
            mine += [one, *scene.place(0, [moved_by(9 * number)] * 2).tolist()]
            scene.set_mask(mine[-3:], number)
            scene.update()
        return mine

    def ask(_):
        for _ in range(30):
            try:
                scene.closest(rays, threads=1)
            except RuntimeError as error:  # between another thread's change and its update()
                assert "update()" in str(error)

    with ThreadPoolExecutor(8) as pool:
        asked, placed = [pool.submit(ask, i) for i in range(3)], list(pool.map(change, range(1, 6)))
        for each in asked:
            each.result()
    assert scene.instance_count == before + 5 * 90 == len(set(sum(placed, []))) + before
    for number, mine in enumerate(placed, 1):
        assert (scene.mask_of(mine) == number).all() and (scene.transform_of(mine)[:, 0, 3] == 9 * number).all()


def test_changes_do_not_wait_for_queries():
    """A query keeps the scene that it began with. Machines differ in when it has begun, and not yet ended."""
    many = random_rays(2, 1 << 21, reach=4)
    before = scene_of().closest(many).tobytes()

    def changes_first(seconds):
        scene, found = scene_of(), []

        def ask():
            try:
                found.append(scene.closest(many, threads=1).tobytes())
            except RuntimeError:  # it began after the change
                found.append(None)

        query = threading.Thread(target=ask)
        query.start()
        time.sleep(seconds)
        scene.move(0, moved_by(0.5)), scene.replace(0, raylanes.SphereTree([[0, 0, 0]], 1))
        is_first = query.is_alive()
        query.join()
        assert found[0] in (before, None)
        return is_first and found[0] == before

    assert any(changes_first(seconds) for seconds in (0.02, 0.01, 0.005, 0.02, 0.04, 0.08))


def test_others_run_while_the_library_works():
    """Calls that take long release the GIL. A machine that is too busy gets two more tries."""
    scene, many = raylanes.Scene(), random_rays(3, 1 << 19)
    part = scene.add(raylanes.Bvh(*sphere(triangles=100000)))
    scene.place(part, np.eye(4) * np.ones((200000, 1, 1)))
    scene.update()
    few, cubes = scene_of(), [scene_of(dtype=dtype) for dtype in number_types]
    for each in cubes:
        each.place(0, np.zeros((200000, 3, 4)) + moved_by(1))
    for work in (scene.update, lambda: few.closest(many, threads=1), lambda: raylanes.SphereTree(many["origin"], 1),
                 *(each.update for each in cubes)):
        assert any(turns_during(work) > 0 for _ in range(3))


def test_children_of_a_busy_program():
    scene, spheres = scene_of(), raylanes.SphereTree([[0, 0, 0]], 1)
    expected, of_spheres = scene.closest(rays).tobytes(), spheres.closest(rays).tobytes()

    def work():
        asked = scene.closest(rays).tobytes() == expected and spheres.closest(rays).tobytes() == of_spheres
        scene.place(scene.add(raylanes.SphereTree(rays["origin"][:100], 0.5)))
        scene.refit(0, cube_vertices * np.float32(2), cube_faces)
        scene.update()
        return asked and scene.closest(rays, threads=2).tobytes() != expected

    assert statuses_of_children(lambda: (scene.closest(rays), spheres.closest(rays)), work, 5) == [0] * 5
    assert scene.closest(rays).tobytes() == expected


def _traced(arguments):
    scene, spheres, some = arguments
    return scene.closest(some).tobytes() + spheres.closest(some).tobytes()


@pytest.mark.parametrize("method", ["fork", "spawn"])
@pytest.mark.parametrize("dtype", number_types)
def test_processes(method, dtype):
    scene, spheres = scene_of(dtype=dtype), raylanes.SphereTree([[0, 0, 0]], 1)
    expected = [_traced((scene, spheres, part)) for part in np.array_split(rays, 4)]
    with multiprocessing.get_context(method).Pool(2) as pool:
        arguments = [(scene, spheres, part) for part in np.array_split(rays, 4)]
        assert pool.map_async(_traced, arguments).get(60) == expected
