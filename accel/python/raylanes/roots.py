"""Square roots and reciprocals of arrays by the accuracy that they must keep."""

import numpy as np

from . import _native
from .answer import Answer
from .arrays import numbers
from .paths import chosen

_short = {"1ulp": "within_1_ulp", "2^-44": "within_2^-44", "2^-22": "within_2^-22", "2^-16": "within_2^-16",
          "2^-11": "within_2^-11", "2^-4": "within_2^-4"}


def sqrt(x, accuracy: str = "1ulp", out=None):
    """Square roots.

    x: floats of any shape: float32 and float64 stay what they are, float16 becomes float32, integers become float64.
    accuracy: "correctly_rounded" (0.5 ULP), "1ulp", or the relative error "2^-44", "2^-22", "2^-16", "2^-11", "2^-4"; a
    float32 asked for 2^-44 keeps 1 ULP. Bounds are those of normal numbers; special values are as in IEEE 754 in all.
    out: an array of the type and shape of the answer, x itself among them. One thread.
    """
    return _root(_native.sqrt, x, accuracy, out)


def rsqrt(x, accuracy: str = "1ulp", out=None):
    """1 / sqrt(x), otherwise as sqrt(); float64 are not offered correctly rounded."""
    return _root(_native.rsqrt, x, accuracy, out)


def reciprocal(x, accuracy: str = "1ulp", out=None):
    """1 / x, otherwise as sqrt(); the bounds are for x whose reciprocal is a normal number by a wide margin."""
    return _root(_native.reciprocal, x, accuracy, out)


def _root(root, x, accuracy, out):
    x = numbers("x", x)
    wanted = np.float32 if x.dtype in (np.float16, np.float32) else np.float64
    x = np.ascontiguousarray(x.astype(wanted, copy=False)).reshape(x.shape)
    # In place is as good as apart, one element further is not.
    is_same = out is not None and x.__array_interface__["data"] == out.__array_interface__["data"]
    answer = Answer(out, x.shape, np.dtype(wanted), () if is_same else (x,))
    root(x.reshape(-1), answer.rows, _short.get(accuracy, accuracy), chosen())
    return answer.finish()[()] if out is None else answer.finish()
