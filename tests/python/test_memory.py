"""Memory that runs out in calls of the module: a MemoryError, and the next call is right."""

import os
import pathlib
import subprocess
import sys

import pytest

folder = pathlib.Path(__file__).parent / "memory"
preloaded = os.environ.get("RAYLANES_FAILING_ALLOCATIONS")


@pytest.mark.skipif(not preloaded, reason="memory that runs out was not tested: only Meson builds what makes it fail")
def test_every_failure_of_every_call_is_clean():
    environment = dict(os.environ, LD_PRELOAD=preloaded, PYTHONMALLOC="malloc")
    done = subprocess.run([sys.executable, str(folder / "every_failure.py")], env=environment, capture_output=True,
                          text=True, timeout=170, check=False)
    assert done.returncode == 0 and "FAULT" not in done.stdout, done.stdout + done.stderr
    failures = dict(line.rpartition(": ")[::2] for line in done.stdout.splitlines())
    assert len(failures) > 110 and int(failures["Bvh(binned_sah)"]) > 20 and int(failures["Bvh.all_hits"]) > 5
