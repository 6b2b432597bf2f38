"""Roots of arrays."""

import inspect

import numpy as np
import pytest

import raylanes
from meshes import any_bits, supported

functions = {raylanes.sqrt: lambda x: np.sqrt(x), raylanes.rsqrt: lambda x: 1 / np.sqrt(x),
             raylanes.reciprocal: lambda x: 1 / x}
bounds = {"1ulp": 2.0**-23, "within_1_ulp": 2.0**-23, "2^-22": 2.0**-22, "2^-16": 2.0**-16, "2^-11": 2.0**-11,
          "2^-4": 2.0**-4}


@pytest.mark.parametrize("path", supported)
@pytest.mark.parametrize("root", functions)
def test_floats_keep_their_bounds(root, path):
    x = np.concatenate([np.ldexp(np.random.default_rng(1).uniform(1, 2, 4001), e) for e in (-60, -3, 0, 40)])
    x = x.astype(np.float32)
    exact = functions[root](x.astype(np.float64))
    with raylanes.use_path(path):
        for accuracy, bound in bounds.items():
            y = root(x, accuracy)
            assert y.dtype == np.float32 and np.abs(y / exact - 1).max() <= bound
        y = root(x, "correctly_rounded")
        assert (y == exact.astype(np.float32)).all()  # a double is far from a tie


@pytest.mark.parametrize("root", functions)
def test_doubles_keep_their_bounds(root):
    x = np.random.default_rng(2).uniform(1e-3, 1e3, 3001)
    exact = functions[root](x.astype(np.longdouble))
    for accuracy, bound in {"1ulp": 2.0**-52, "2^-44": 2.0**-44, "2^-22": 2.0**-22}.items():
        y = root(x, accuracy)
        assert y.dtype == np.float64 and np.abs(y / exact - 1).max() <= bound
    assert root(np.array(4)).dtype == np.float64 and root(np.float16([4])).dtype == np.float32


def test_any_bits():
    x = any_bits(3, 10000, np.dtype("f4"))
    with np.errstate(all="ignore"):
        expected = np.sqrt(x)
        assert np.array_equal(raylanes.sqrt(x, "correctly_rounded"), expected, equal_nan=True)
        assert np.array_equal(raylanes.reciprocal(x, "correctly_rounded"), 1 / x, equal_nan=True)
    special = np.float32([0, -0.0, np.inf, -np.inf, np.nan, -1])
    for accuracy in bounds:
        assert raylanes.sqrt(special, accuracy).tobytes()[:12] == np.float32([0, -0.0, np.inf]).tobytes()
        assert np.isnan(raylanes.sqrt(special, accuracy)[3:]).all()


@pytest.mark.parametrize("root, accuracy", [(raylanes.sqrt, "correctly_rounded"), (raylanes.rsqrt, "1 ulp"),
                                            (raylanes.reciprocal, "correctly_rounded")])
def test_defaults_are_those_of_cpp(root, accuracy):
    """Correctly rounded where float32 and float64 both offer that. Few bytes tell 1 ULP from it: hence the default."""
    assert inspect.signature(root).parameters["accuracy"].default == accuracy
    for dtype in ("f4", "f8"):
        x = any_bits(5, 4000, np.dtype(dtype))
        assert root(x).tobytes() == root(x, accuracy).tobytes()


@pytest.mark.parametrize("root", functions)
def test_accuracies_have_names_and_numbers(root):
    for dtype in ("f4", "f8"):
        x = any_bits(6, 500, np.dtype(dtype))
        for names in (["1 ulp", "1ulp", "within_1_ulp", "within 1 ulp", "1_ulp"], ["2 ulp", "within_2_ulp"],
                      ["2^-11", "within_2^-11", 2.0**-11, np.float64(0.0005)]):
            assert len({root(x, name).tobytes() for name in names}) == 1
    x = np.random.default_rng(9).uniform(1, 4, 3000)
    exact = functions[root](x.astype(np.longdouble))
    for bound in (1e-15, 1e-12, 1e-7, 1e-3):
        assert np.abs(root(x, bound) / exact - 1).max() <= bound
    for wrong in (1e-20, np.nan, -1.0):
        with pytest.raises(ValueError, match="accuracy: a relative error of"):
            root(x, wrong)
    with pytest.raises(ValueError, match='no "3 ulp", but correctly_rounded, 1 ulp, 2 ulp, 2\\^-44, .*such as 1e-7'):
        root(x, "3 ulp")


def test_layouts_and_out():
    x = np.random.default_rng(4).uniform(1, 9, (12, 14)).astype(np.float32)
    expected = raylanes.sqrt(x, "correctly_rounded")
    assert expected.shape == x.shape and (expected == np.sqrt(x)).all()
    for laid in (x[::2], x[:, ::3], x.T, x[::-1], np.broadcast_to(x[0], (5, 14)), x[:0], x.astype(">f4")):
        assert (raylanes.sqrt(laid, "correctly_rounded") == np.sqrt(laid)).all()
    for out in (np.zeros((12, 14), "f4"), np.zeros((14, 12), "f4").T, np.zeros((12, 28), "f4")[:, ::2]):
        assert raylanes.sqrt(x, "correctly_rounded", out) is out and (out == expected).all()
    y = x.copy()
    assert raylanes.sqrt(y, "correctly_rounded", out=y) is y and (y == expected).all()
    y = x.reshape(-1).copy()
    raylanes.sqrt(y[:-1], "correctly_rounded", out=y[1:])  # overlapping, as NumPy has it
    assert (y[1:] == expected.reshape(-1)[:-1]).all()
    assert isinstance(raylanes.rsqrt(4.0), np.float64) and raylanes.rsqrt(4.0) == 0.5
    out = np.zeros((), np.float32)
    assert raylanes.sqrt(np.float32(9), out=out) is out and out == 3


@pytest.mark.parametrize("root", functions)
def test_some_elements(root):
    """As NumPy's where=, but that a new array holds zeros elsewhere."""
    x = np.random.default_rng(6).uniform(1, 9, (5, 7)).astype(np.float32)
    best, row = "correctly_rounded", np.arange(7) % 3 == 0
    all_roots = root(x, best)
    for mask in (x > 4, row, np.array(True), False, np.zeros((5, 7), bool)):
        expected = np.where(mask, all_roots, np.float32(0))
        assert root(x, best, where=mask).tobytes() == expected.tobytes()
        assert root(x.T, best, where=np.broadcast_to(mask, x.shape).T).tobytes() == expected.T.tobytes()
        for out in (np.full((5, 7), 8, "f4"), np.full((5, 14), 8, "f4")[:, ::2], x.copy()):
            before = out.copy()
            given = out if np.array_equal(out, x) else x
            assert root(given, best, out, where=mask) is out and (out == np.where(mask, all_roots, before)).all()
    assert root(4.0, where=True) == root(4.0) and root(4.0, where=False) == 0
    with pytest.raises(TypeError, match="^where: booleans are needed, not int64"):
        root(x, where=np.ones((5, 7), int))
    with pytest.raises(ValueError, match="^where: the shape must be that of x, \\(5, 7\\)"):
        root(x, where=np.ones(5, bool))


def test_wrong_arguments():
    x = np.ones(4, np.float32)
    for wrong, sentence in [(lambda: raylanes.sqrt(x, "best"), 'no "best", but correctly_rounded'),
                            (lambda: raylanes.rsqrt(x.astype(float), "correctly_rounded"), "not offered"),
                            (lambda: raylanes.sqrt(x, out=np.zeros(3, np.float32)), "out")]:
        with pytest.raises(ValueError, match=sentence):
            wrong()
    for wrong, sentence in [(lambda: raylanes.sqrt(x, out=np.zeros(4)), "^out: an array of float32"),
                            (lambda: raylanes.sqrt(x, out=[1.0] * 4), "^out: an array of float32"),
                            (lambda: raylanes.sqrt(x, 3), "^accuracy: a string"),
                            (lambda: raylanes.sqrt(x, x), "^accuracy: a string")]:
        with pytest.raises(TypeError, match=sentence):
            wrong()
