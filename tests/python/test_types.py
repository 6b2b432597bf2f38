"""The type stubs say what the package has."""

import importlib.util
import os
import pathlib
import subprocess
import sys

import pytest

import raylanes

# Modules behind the public ones have no stubs of their own.
inner = r"raylanes\.(trimesh\.)?(_native|answer|arrays|hits|paths|proximity|ray|roots|scalars|scaled|ties|tree)\..*"


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None,
                    reason="type stubs were not tested: mypy is not installed")
def test_stubs_are_those_of_the_package(tmp_path):
    (tmp_path / "allowed").write_text(inner + "\n")
    use = "import raylanes\nprint(raylanes.Bvh([], []).closest([]).t.shape, raylanes.sqrt(2))\n"
    (tmp_path / "use.py").write_text(use)
    folder = str(pathlib.Path(raylanes.__file__).parents[1])
    environment = dict(os.environ, MYPYPATH=folder, MYPY_CACHE_DIR=str(tmp_path / "cache"))
    for command in (["mypy.stubtest", "raylanes", "--allowlist", "allowed", "--ignore-unused-allowlist"],
                    ["mypy", "--strict", "use.py"]):
        done = subprocess.run([sys.executable, "-m", *command], cwd=tmp_path, env=environment, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
