"""The docstrings of the package: each public name has one that is complete, and examples print what they say."""

import doctest
import inspect
import pathlib

import numpy as np
import pytest

import raylanes

tree_kinds = (raylanes.Bvh, raylanes.KdTree)
public = {name: getattr(raylanes, name) for name in raylanes.__all__}
documented = {name: item for name, item in public.items() if inspect.isclass(item) or inspect.isfunction(item)}


def methods_of(kind):
    """The methods and properties that raylanes defines, those of base classes included."""
    for name, member in inspect.getmembers(kind):
        is_ours = isinstance(member, property) or (getattr(member, "__module__", None) or "").startswith("raylanes")
        if not name.startswith("_") and is_ours:
            yield f"{kind.__name__}.{name}", member


members = dict(row for kind in documented.values() if inspect.isclass(kind) and kind is not raylanes.Path
               for row in methods_of(kind))
items = documented | members
functions = {name: item for name, item in items.items() if callable(item) and not inspect.isclass(item)}


def test_all_are_looked_at():
    assert len(functions) > 40 and {"sqrt", "rays", "Bvh.closest", "KdTree.locate", "Hits.positions", "Scene.place",
                                    "SphereTree.closest", "SceneHits.normals"} <= set(functions)


@pytest.mark.parametrize("name", items)
def test_summary(name):
    first, *rest = items[name].__doc__.splitlines()
    assert first.strip() and (not rest or not rest[0].strip() or name not in functions)


@pytest.mark.parametrize("name", functions)
def test_sections(name):
    function = functions[name]
    text, signature = inspect.getdoc(function), inspect.signature(inspect.unwrap(function))
    sections = {line for line in text.splitlines() if set(line) == {"-"}}
    assert "Returns\n-------" in text and sections
    parameters = [p for p in signature.parameters if p not in ("self", "cls")]
    assert ("Parameters\n----------" in text) == bool(parameters)
    listed = text.partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    for parameter in parameters:
        assert parameter in listed, f"{name} says nothing of {parameter}"


@pytest.mark.parametrize("kind", [*tree_kinds, raylanes.SphereTree])
def test_parameters_of_trees(kind):
    for parameter in inspect.signature(kind).parameters:
        assert f"\n{parameter} : " in inspect.getdoc(kind)


@pytest.mark.parametrize("name", items)
def test_examples(name):
    kind = getattr(raylanes, name.split(".")[0])
    corners = np.array([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], np.float32)
    tree = kind(corners, [[0, 1, 2]]) if kind in tree_kinds else None
    names = {"np": np, "raylanes": raylanes, "tree": tree}
    if kind is raylanes.Scene:
        names["scene"] = raylanes.Scene()
        names["scene"].place(names["scene"].add(raylanes.Bvh(corners, [[0, 1, 2]])))
        names["scene"].update()
    item = items[name]
    test = doctest.DocTestParser().get_doctest(inspect.getdoc(item), names, name, None, None)
    runner = doctest.DocTestRunner()
    assert runner.run(test, clear_globs=False).failed == 0
    without = ("save", "load", "refit", "replace", "sah_cost", "decay", "positions", "active_path")
    wants_example = name in functions and name.split(".")[-1] not in without
    assert not wants_example or test.examples


def test_the_version_is_that_of_the_package():
    package = (pathlib.Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8")
    assert f'\nversion = "{raylanes.__version__}"' in package
