"""Arrays given as out= whose elements overlap each other."""

import numpy as np
import pytest

import raylanes
from meshes import random_rays, sphere
from numpy.lib.stride_tricks import as_strided
from raylanes._answer import overlaps_itself


@pytest.fixture(scope="module")
def calls():
    """(call, argument, dtype of its results) of every method with out=."""
    tree, rays = raylanes.Bvh(*sphere(triangles=200)), random_rays(1, 60)
    scene, spheres = raylanes.Scene(), raylanes.SphereTree([[0, 0, 0]], 1)
    scene.place(scene.add(tree)), scene.place(scene.add(spheres)), scene.update()
    points, numbers = rays["origin"], np.arange(1, 61, dtype=np.float32)
    return [(tree.closest, rays, raylanes.hit_dtype), (tree.occluded, rays, np.dtype(bool)),
            (lambda to, out: tree.occluded_from(points[0], to, out=out), points, np.dtype(bool)),
            (tree.count_crossings, rays, raylanes.count_dtype), (tree.locate, points, np.dtype(np.uint8)),
            (tree.winding_numbers, points, np.dtype(np.float32)),
            (tree.closest_points, points, raylanes.closest_point_dtype),
            *((of_scene, rays, dtype) for of_scene, dtype in ((scene.closest, raylanes.scene_hit_dtype),
                                                              (scene.occluded, np.dtype(bool)))),
            (spheres.closest, rays, raylanes.hit_dtype), (spheres.occluded, rays, np.dtype(bool)),
            (tree.signed_distances, points, np.dtype(np.float32)),
            *((root, numbers, numbers.dtype) for root in (raylanes.sqrt, raylanes.rsqrt, raylanes.reciprocal))]


def test_elements_that_overlap_are_refused(calls):
    for call, argument, dtype in calls:
        memory = np.zeros(200 * dtype.itemsize, np.uint8)
        middle = memory[100 * dtype.itemsize:101 * dtype.itemsize].view(dtype)
        for step in {0, dtype.itemsize // 2, dtype.itemsize - 1, 1 - dtype.itemsize}:
            with pytest.raises(ValueError, match=r"^out: elements must not overlap, .* strides \(-?\d+,\)$"):
                call(argument, out=as_strided(middle, (60,), (step,)))
            assert not memory.any()
        table = argument.reshape(6, 10, *argument.shape[1:])
        rows = as_strided(memory[:dtype.itemsize].view(dtype), (6, 10), (9 * dtype.itemsize, dtype.itemsize))
        with pytest.raises(ValueError, match="^out: elements must not overlap"):
            call(table, out=rows)


def test_elements_apart_are_written(calls):
    for call, argument, dtype in calls:
        expected = call(argument, out=np.zeros(60, dtype))
        fields = np.zeros(60, [("before", "u1"), ("result", dtype), ("after", "u1")])
        memory = np.zeros(40 * 60 * dtype.itemsize, np.uint8).view(dtype)
        for out in (fields["result"], memory[:60][::-1], memory[:420:7]):
            call(argument, out=out)
            assert out.tobytes() == expected.tobytes()
        table = argument.reshape(6, 10, *argument.shape[1:])
        interleaved = as_strided(memory, (6, 10), (35 * dtype.itemsize, 4 * dtype.itemsize))  # no 35 i = 4 j
        for out in (memory[:60].reshape(10, 6).T, memory[:2400].reshape(24, 100)[::-4, ::10], interleaved):
            call(table, out=out)
            assert out.tobytes() == expected.tobytes()


def test_overlaps_are_those_of_addresses():
    random = np.random.default_rng(1)
    for _ in range(2000):
        shape = random.integers(0, 4, random.integers(1, 4))
        array = as_strided(np.zeros(200, np.int8)[100:104].view(np.int32), shape,
                           random.integers(-12, 13, len(shape)))
        starts = [sum(i * step for i, step in zip(index, array.strides)) for index in np.ndindex(*shape)]
        places = [start + byte for start in starts for byte in range(4)]
        assert overlaps_itself(array) == (len(set(places)) < len(places))
