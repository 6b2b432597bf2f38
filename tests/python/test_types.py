"""The type stubs say what the package has."""

import importlib.util
import os
import pathlib
import subprocess
import sys

import pytest

import raylanes

# Modules behind the public ones have no stubs of their own.
inner = r"raylanes\.(trimesh\.)?(_\w+|hits|paths|proximity|ray|roots|scaled|ties|tree)\..*"


# What mypy must take, and what it must refuse, with a word of its reason.
good = """import raylanes
tree = raylanes.Bvh([], [], builder="morton")
print(tree.closest([], mode="stream").t.shape, raylanes.sqrt(2, "2^-11"), tree.report()["overlap"])
print(raylanes.KdTree([], []).report()["wide_nodes"], raylanes.closed_report([], [])["open"])
"""
bad = {"raylanes.sqrt(2, '3ulp')": "3ulp", "raylanes.Bvh([], [], builder='sah')": "builder",
       "raylanes.Bvh([], []).locate([], rule='odd')": "rule",
       "raylanes.Bvh([], []).report()['wide_nodes']": "wide_nodes"}


def test_reports_are_those_of_the_stubs():
    stubs = (pathlib.Path(raylanes.__file__).parent / "__init__.pyi").read_text(encoding="utf-8")

    def keys(name):
        body = stubs.partition(f"class {name}(")[2].partition("\n\n")[0]
        return {line.split(":")[0].strip() for line in body.splitlines()[1:]}

    mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    assert set(raylanes.Bvh(*mesh).report()) == keys("_Report") | keys("_TreeReport")
    assert set(raylanes.KdTree(*mesh).report()) == keys("_Report") | keys("_KdReport")
    assert set(raylanes.closed_report(*mesh)) == keys("_ClosedReport")


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None,
                    reason="type stubs were not tested: mypy is not installed")
def test_stubs_are_those_of_the_package(tmp_path):
    (tmp_path / "allowed").write_text(inner + "\n")
    (tmp_path / "use.py").write_text(good)
    (tmp_path / "wrong.py").write_text("import raylanes\n" + "\n".join(bad) + "\n")
    folder = str(pathlib.Path(raylanes.__file__).parents[1])
    environment = dict(os.environ, MYPYPATH=folder, MYPY_CACHE_DIR=str(tmp_path / "cache"))
    for command in (["mypy.stubtest", "raylanes", "--allowlist", "allowed", "--ignore-unused-allowlist"],
                    ["mypy", "--strict", "use.py"]):
        done = subprocess.run([sys.executable, "-m", *command], cwd=tmp_path, env=environment, capture_output=True,
                              text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "wrong.py"], cwd=tmp_path, env=environment,
                          capture_output=True, text=True, check=False)
    errors = [line for line in done.stdout.splitlines() if ": error: " in line]
    assert len(errors) == len(bad)
    for error, reason in zip(errors, bad.values()):
        assert reason in error, done.stdout
