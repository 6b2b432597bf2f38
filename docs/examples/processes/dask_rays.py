"""A batch of rays, traced by the workers of a Dask cluster, here a local one of two processes.

    python3 dask_rays.py [PATH…]

The tree is built once and scattered; each task traces a part of the rays. The paths are those of the workers, by turns:
whichever they are, the assembled hits have the same bytes as those of one process, which is checked.
"""
import sys
import time
from contextlib import nullcontext

import numpy as np
from dask.distributed import Client, LocalCluster

import raylanes
from waves import rays_from_above, waves


def trace(tree, rays, path):
    with raylanes.use_path(path) if path else nullcontext():
        return tree.closest(rays, threads=1), raylanes.active_path()


def main(paths):
    tree, rays = raylanes.Bvh(*waves(300)), rays_from_above(1 << 18)
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        workers = sorted(client.scheduler_info()["workers"])
        start = time.perf_counter()
        everywhere = client.scatter(tree, broadcast=True)
        broadcast = time.perf_counter()
        parts = [client.scatter(part, workers=workers[i % 2]) for i, part in enumerate(np.array_split(rays, 8))]
        tasks = [client.submit(trace, everywhere, part, paths[i % len(paths)], workers=workers[i % 2], pure=False)
                 for i, part in enumerate(parts)]
        parts = client.gather(tasks)
        end = time.perf_counter()
    same = np.concatenate([hits for hits, _ in parts]).tobytes() == tree.closest(rays).tobytes()
    print(f"2 workers ({', '.join(sorted({path for _, path in parts}))}): {len(rays)} rays, scatter of the tree "
          f"{broadcast - start:.4f} s, rays and hits {end - broadcast:.4f} s")
    print("the same bytes as of one process" if same else "DIFFERENT")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or [None]))
