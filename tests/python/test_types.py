"""The type stubs say what the package has."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import raylanes

# Modules behind the public ones have no stubs of their own.
inner = (r"raylanes\.(trimesh\.)?(_\w+|hits|of_mesh|paths|proximity|ray|roots|scene|scene_hits|sphere_tree|ties|tree)"
         r"\..*")


# What mypy must take, and what it must refuse, with a word of its reason.
good = """import numpy as np
import raylanes
import raylanes.trimesh
tree = raylanes.Bvh([], [], builder="morton")
print(tree.closest([], mode="stream").t.shape, raylanes.sqrt(2, "2^-11"), tree.report()["overlap"])
print(raylanes.KdTree([], []).report()["wide_nodes"], raylanes.closed_report([], [])["open"])
for layer in tree.all_hits([]):
    print(layer.t.shape, layer.positions([]).shape)
crossings: raylanes.Lists[raylanes.Crossings] = tree.crossings([])
print(crossings[0].side.shape, crossings.items.side.shape, tree.stretches([]).items.winding.shape)
doubles = raylanes.Bvh([], [], dtype=np.float64)
print(doubles.dtype == np.float64, doubles.report()["rounded_away"], raylanes.rays([], [], dtype=np.float32).dtype)
print(tree.closest(origins=[0, 0, 1], directions=[[0, 0, 1]], tmax=2).positions(origins=[0, 0, 1], directions=[]).shape)
print(raylanes.KdTree([], [], dtype=np.float32).dtype, doubles.closest([]).t.dtype)
scene, spheres = raylanes.Scene(), raylanes.SphereTree([], 1, builder="morton")
places = scene.place(scene.add(spheres), np.eye(4), mask=[1, 2])
scene.update()
hits = scene.closest([], mask=3)
print(places, hits.instance.dtype, hits.normals(scene, {0: spheres}, []).shape, scene.closest([], after=hits).geometry)
print(scene.occluded([], filter=lambda indices, hits: hits.instance == indices), spheres.closest([], after=[]).t)
print(tree.closest([], filter=lambda indices, hits: hits.primitive == indices).t, spheres.occluded_from([], []))
print(hits.interpolate([[1.0]], [[[0, 0, 0]]]).shape, spheres.report()["left_out"], raylanes.Scene.load("file").bounds)
print(scene.name_of(hits.instance), scene.instances_named("a").dtype, scene.place(0, name="a"))
print(raylanes.Scene(dtype=np.float64).dtype, raylanes.Scene(dtype=np.float32).transform_of(0).dtype)
print(hits.columns()["t"].shape, tree.all_hits([]).columns()["ray"].dtype)
print(raylanes.trimesh.RayMeshIntersector(geometry=None, scale_to_box=False).intersects_first([], []).shape)
"""
bad = {"raylanes.sqrt(2, '3ulp')": "3ulp", "raylanes.Bvh([], [], dtype=int)": "dtype",
       "raylanes.KdTree([], [], dtype=float)": "dtype", "raylanes.Bvh([], [], builder='sah')": "builder",
       "raylanes.Bvh([], []).locate([], rule='odd')": "rule",
       "raylanes.Bvh([], []).closest(origins=[], direction=[])": "direction",
       "raylanes.Bvh([], []).closest([], [])": "positional",
       "raylanes.Bvh([], []).report()['wide_nodes']": "wide_nodes",
       "[layer.side for layer in raylanes.Bvh([], []).all_hits([])]": "side",
       "raylanes.Scene().add(raylanes.KdTree([], []))": "KdTree",
       "raylanes.SphereTree([], [], builder='auto')": "builder", "raylanes.Scene().instances_named(0)": "int",
       "raylanes.Scene().closest([]).normals([], [])": "normals", "raylanes.Scene(dtype=int)": "dtype",
       "raylanes.trimesh.RayMeshIntersector(None).intersects_any([], [], multiple_hit=1)": "multiple_hit"}


folder = pathlib.Path(raylanes.__file__).parent
stubs = "\n\n".join((folder / name).read_text(encoding="utf-8") for name in ("__init__.pyi", "sphere_tree.pyi"))


@pytest.mark.parametrize("option,alias", [("test", "_Test"), ("grade", "_Grade"), ("mode", "_Mode"), ("hint", "_Hint"),
                                          ("facing", "_Facing"), ("rule", "_Rule")])
def test_words_are_those_of_docstrings_and_library(option, alias):
    query = raylanes.Bvh.locate if option == "rule" else raylanes.Bvh.closest
    listed = re.search(rf"^ *{option} : {{(.*?)}}", query.__doc__, re.M | re.S)[1]
    typed = re.search(rf"^{alias} = Literal\[(.*?)\]", stubs, re.M | re.S)[1]
    with pytest.raises(ValueError) as refused:
        query(raylanes.Bvh([], []), np.zeros((0, 3 if option == "rule" else 8)), **{option: "none of them"})
    known = set(str(refused.value).partition(", but ")[2].split(", ")) - {"directional"}  # for arrays alone
    assert set(re.findall(r'"(.*?)"', listed)) == set(re.findall(r'"(.*?)"', typed)) == known


def test_reports_are_those_of_the_stubs():

    def keys(name):
        if typed := re.search(rf'^{name} = TypedDict\("{name}", {{(.*?)}}\)', stubs, re.M | re.S):
            return set(re.findall(r'"(\w+)":', typed[1]))
        body = stubs.partition(f"class {name}(")[2].partition("\n\n")[0]
        return {line.split(":")[0].strip() for line in body.splitlines()[1:]}

    mesh = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    assert set(raylanes.Bvh(*mesh).report()) == keys("_Report") | keys("_TreeReport")
    assert set(raylanes.KdTree(*mesh).report()) == keys("_Report") | keys("_KdReport")
    assert set(raylanes.SphereTree([], []).report()) == keys("_SphereReport")
    assert set(raylanes.closed_report(*mesh)) == keys("_ClosedReport")


@pytest.mark.skipif(importlib.util.find_spec("mypy") is None,
                    reason="type stubs were not tested: mypy is not installed")
def test_stubs_are_those_of_the_package(tmp_path):
    (tmp_path / "allowed").write_text(inner + "\n")
    (tmp_path / "use.py").write_text(good)
    (tmp_path / "wrong.py").write_text("import raylanes, raylanes.trimesh\n" + "\n".join(bad) + "\n")
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
