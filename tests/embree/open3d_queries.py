"""Open3D's queries of a torus: prints the Embree that is loaded and CPU seconds by query, and saves the results.

usage: open3d_queries.py FILE.npz
"""
import sys
import time

import numpy as np
import open3d

RAYS, POINTS = 200_000, 50_000


def torus(rows, columns):
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, rows, False), np.linspace(0, 2 * np.pi, columns, False), indexing='ij')
    radius = 2 + np.cos(b)
    points = np.stack([radius * np.cos(a), radius * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rows), np.arange(columns), indexing='ij')
    corner = [((i + x) % rows * columns + (j + y) % columns).ravel() for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    triangles = [np.stack([corner[k] for k in t], -1) for t in ((0, 1, 2), (0, 2, 3))]
    return points.astype(np.float32), np.concatenate(triangles).astype(np.uint32)


def main():
    scene = open3d.t.geometry.RaycastingScene()
    tensor = open3d.core.Tensor
    scene.add_triangles(*map(tensor, torus(200, 100)))
    random = np.random.default_rng(81)
    origins = random.uniform(-3, 3, (RAYS, 3)).astype(np.float32)
    rays = tensor(np.concatenate([origins, random.normal(size=(RAYS, 3)).astype(np.float32)], 1))
    points = tensor(origins[:POINTS])
    scene.cast_rays(rays[:1])  # commits the scene
    print(next(line.split()[-1] for line in open('/proc/self/maps') if 'libembree3.so' in line))
    results = {}
    for name, of in {'cast_rays': rays, 'test_occlusions': rays, 'count_intersections': rays,
                     'compute_closest_points': points, 'compute_distance': points,
                     'compute_signed_distance': points, 'compute_occupancy': points}.items():
        seconds = []
        for _ in range(3):
            begin = time.process_time()
            result = getattr(scene, name)(of)
            seconds.append(time.process_time() - begin)
        print(name, min(seconds))
        for key, array in (result if isinstance(result, dict) else {'': result}).items():
            results[f'{name} {key}'.strip()] = array.numpy()
    np.savez(sys.argv[1], **results)


main()
