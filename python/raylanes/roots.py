"""Square roots and reciprocals of arrays, by accuracy."""

import numpy as np

from . import _native
from ._answer import Answer
from ._arrays import numbers
from .paths import chosen
from ._scalars import word

_short = {"1ulp": "within_1_ulp", "2^-44": "within_2^-44", "2^-22": "within_2^-22", "2^-16": "within_2^-16",
          "2^-11": "within_2^-11", "2^-4": "within_2^-4"}


def sqrt(x, accuracy: str = "correctly_rounded", out=None):
    """Compute square roots.

    Special values are as in IEEE 754, whatever the accuracy. Runs on one thread.

    Parameters
    ----------
    x : array of float
        float32 and float64 keep their type, float16 becomes float32, integers become float64.
    accuracy : {"correctly_rounded", "1ulp", "2^-44", "2^-22", "2^-16", "2^-11", "2^-4"}, default "correctly_rounded"
        The error bound for normal numbers: 0.5 ULP, 1 ULP, or a relative error. "2^-44" of a float32 is "1ulp".
    out : ndarray, optional
        The array to write to, of the shape and type of the result; x itself is allowed.

    Returns
    -------
    ndarray or scalar
        The results, in the shape of x.

    Examples
    --------
    >>> raylanes.sqrt([4.0, 2.0])
    array([2.        , 1.41421356])
    """
    return _root(_native.sqrt, x, accuracy, out)


def rsqrt(x, accuracy: str = "1ulp", out=None):
    """Compute reciprocal square roots, 1 / sqrt(x).

    Special values are as in IEEE 754, whatever the accuracy. Runs on one thread.
    "correctly_rounded" is not offered for float64: nothing proves it.

    Parameters
    ----------
    x, out
        As in sqrt().
    accuracy : {"correctly_rounded", "1ulp", "2^-44", "2^-22", "2^-16", "2^-11", "2^-4"}, default "1ulp"
        The error bound for normal numbers: 0.5 ULP, 1 ULP, or a relative error. "2^-44" of a float32 is "1ulp".

    Returns
    -------
    ndarray or scalar
        The results, in the shape of x.

    Examples
    --------
    >>> raylanes.rsqrt([4.0, 0.25])
    array([0.5, 2. ])
    """
    return _root(_native.rsqrt, x, accuracy, out)


def reciprocal(x, accuracy: str = "correctly_rounded", out=None):
    """Compute reciprocals, 1 / x.

    Special values are as in IEEE 754, whatever the accuracy. Runs on one thread.
    Error bounds hold if 1 / x is at least 2^-125 (float64: 2^-1021).

    Parameters
    ----------
    x, out
        As in sqrt().
    accuracy : {"correctly_rounded", "1ulp", "2^-44", "2^-22", "2^-16", "2^-11", "2^-4"}, default "correctly_rounded"
        The error bound for normal numbers: 0.5 ULP, 1 ULP, or a relative error. "2^-44" of a float32 is "1ulp".

    Returns
    -------
    ndarray or scalar
        The results, in the shape of x.

    Examples
    --------
    >>> raylanes.reciprocal([4.0, 0.5])
    array([0.25, 2.  ])
    """
    return _root(_native.reciprocal, x, accuracy, out)


def _root(root, x, accuracy, out):
    x, accuracy = numbers("x", x), word("accuracy", accuracy)
    wanted = np.dtype(np.float32 if x.dtype.kind == "f" and x.itemsize <= 4 else np.float64)
    # In place is as good as apart, one element further is not.
    answer = Answer(out, x.shape, wanted, () if out is x else (x,))
    root(np.ascontiguousarray(x, wanted).reshape(-1), answer.rows, _short.get(accuracy, accuracy), chosen())
    return answer.finish()
