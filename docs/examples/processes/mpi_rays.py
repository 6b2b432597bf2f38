"""A batch of rays, traced by several MPI ranks: the tree is built once and broadcast, rays and hits are sent in parts.

    mpirun -n 4 python3 mpi_rays.py [RAYS]
    mpirun -n 1 -x RAYLANES_PATH=sse2 python3 mpi_rays.py : -n 1 -x RAYLANES_PATH=avx2 python3 mpi_rays.py

Ranks may have other processors: the assembled hits have the same bytes as those of one process, which is checked.
"""
import sys
import time

import numpy as np
from mpi4py import MPI
from mpi4py.util import pkl5  # buffers are sent as they are, without a copy into the pickle

import raylanes
from waves import rays_from_above, waves

comm = pkl5.Intracomm(MPI.COMM_WORLD)
tree = rays = None
if comm.rank == 0:
    tree, rays = raylanes.Bvh(*waves(300)), rays_from_above(int(sys.argv[1]) if len(sys.argv) > 1 else 1 << 18)
paths = comm.gather(raylanes.active_path())

start = time.perf_counter()
tree = comm.bcast(tree)
broadcast = time.perf_counter()
part = comm.scatter(np.array_split(rays, comm.size) if comm.rank == 0 else None)
hits = tree.closest(part, threads=1)
parts = comm.gather(hits)
end = time.perf_counter()

if comm.rank == 0:
    assembled = np.concatenate(parts)
    alone = time.perf_counter()
    expected = tree.closest(rays, threads=1)
    alone = time.perf_counter() - alone
    same = assembled.tobytes() == expected.tobytes()
    print(f"{comm.size} ranks ({', '.join(paths)}): {len(rays)} rays of {rays.itemsize} bytes, "
          f"hits of {hits.itemsize}, tree {tree.nbytes} bytes")
    print(f"broadcast {broadcast - start:.4f} s, rays and hits {end - broadcast:.4f} s, one process {alone:.4f} s")
    print("the same bytes" if same else "DIFFERENT", "as of one process,", f"{expected.hit.mean():.0%} of the rays hit")
    comm.Abort(1) if not same else None
