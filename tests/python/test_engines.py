"""Examples that trace on engines for many machines. They check themselves that the bytes are those of one process."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

from meshes import supported

examples = pathlib.Path(__file__).parents[2] / "docs/examples/processes"
slow, fast = ("sse2" if "sse2" in supported else "scalar"), ("avx2" if "avx2" in supported else supported[-1])


def has(module):
    return importlib.util.find_spec(module) is not None


def run(*command):
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    done = subprocess.run(command, capture_output=True, text=True, timeout=100, env=environment, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.skipif(not (has("mpi4py") and shutil.which("mpirun")),
                    reason="MPI was not tested: python3-mpi4py or openmpi-bin is not installed")
def test_ranks_of_mpi_on_different_paths():
    ranks = [["-n", "1", "-x", "RAYLANES_PATH=" + path, sys.executable, str(examples / "mpi_rays.py"), "20000"]
             for path in (slow, fast, slow)]
    said = run("mpirun", "--oversubscribe", *ranks[0], ":", *ranks[1], ":", *ranks[2])
    assert f"3 ranks ({slow}, {fast}, {slow}): 20000 rays" in said and "the same bytes as of one process" in said
    assert "DIFFERENT" not in said


@pytest.mark.skipif(not has("distributed"), reason="Dask was not tested: python3-distributed is not installed")
def test_workers_of_dask_on_different_paths():
    said = run(sys.executable, str(examples / "dask_rays.py"), slow, fast)
    assert f"2 workers ({', '.join(sorted({slow, fast}))})" in said and "the same bytes as of one process" in said
