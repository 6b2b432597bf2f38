"""Square roots and reciprocals of arrays by the accuracy that they must keep."""

import numpy as np

from . import _native
from .answer import Answer
from .arrays import numbers
from .paths import chosen
from .scalars import word

_short = {"1ulp": "within_1_ulp", "2^-44": "within_2^-44", "2^-22": "within_2^-22", "2^-16": "within_2^-16",
          "2^-11": "within_2^-11", "2^-4": "within_2^-4"}


def sqrt(x, accuracy: str = "correctly_rounded", out=None):
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


def reciprocal(x, accuracy: str = "correctly_rounded", out=None):
    """1 / x, otherwise as sqrt(); the bounds are for x whose reciprocal is a normal number by a wide margin."""
    return _root(_native.reciprocal, x, accuracy, out)


def _root(root, x, accuracy, out):
    x, accuracy = numbers("x", x), word("accuracy", accuracy)
    wanted = np.dtype(np.float32 if x.dtype.kind == "f" and x.itemsize <= 4 else np.float64)
    # In place is as good as apart, one element further is not.
    answer = Answer(out, x.shape, wanted, () if out is x else (x,))
    root(np.ascontiguousarray(x, wanted).reshape(-1), answer.rows, _short.get(accuracy, accuracy), chosen())
    return answer.finish()
