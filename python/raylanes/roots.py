"""Square roots and reciprocals of arrays, by accuracy."""

import numpy as np

from . import _native
from ._answer import Answer
from ._arrays import numbers
from .paths import chosen
from ._scalars import word


def sqrt(x, accuracy="correctly_rounded", out=None, *, where=True):
    """Compute square roots.

    Special values are as in IEEE 754, whatever the accuracy. Runs on one thread.

    Parameters
    ----------
    x : array of float
        float32 and float64 keep their type, float16 becomes float32, integers become float64.
    accuracy : str or float, default "correctly_rounded"
        The error bound for normal numbers: "correctly_rounded" (0.5 ULP), "1 ulp", "2 ulp", "2^-44", "2^-22", "2^-16",
        "2^-11" or "2^-4" (relative errors). "2^-44" of a float32 is "1 ulp". A float, such as 1e-7, is a relative
        error: the loosest bound that keeps it.
    out : ndarray, optional
        The array to write to, of the shape and type of the result; x itself is allowed.
    where : array of bool, default True
        The elements to compute, broadcast to the shape of x. Others leave `out` unchanged; in a new array they are 0.

    Returns
    -------
    ndarray or scalar
        The results, in the shape of x.

    Examples
    --------
    >>> raylanes.sqrt([4.0, 2.0])
    array([2.        , 1.41421356])
    """
    roots = _native.sqrt(x, accuracy, out, chosen()) if where is True else None
    return _root(_native.sqrt, x, accuracy, out, where) if roots is None else roots


def rsqrt(x, accuracy="1 ulp", out=None, *, where=True):
    """Compute reciprocal square roots, 1 / sqrt(x).

    Special values are as in IEEE 754, whatever the accuracy. Runs on one thread.
    "correctly_rounded" is not offered for float64: nothing proves it.

    Parameters
    ----------
    x, out, where
        As in sqrt().
    accuracy : str or float, default "1 ulp"
        The error bound for normal numbers: "correctly_rounded" (0.5 ULP), "1 ulp", "2 ulp", "2^-44", "2^-22", "2^-16",
        "2^-11" or "2^-4" (relative errors). "2^-44" of a float32 is "1 ulp". A float, such as 1e-7, is a relative
        error: the loosest bound that keeps it.

    Returns
    -------
    ndarray or scalar
        The results, in the shape of x.

    Examples
    --------
    >>> raylanes.rsqrt([4.0, 0.25])
    array([0.5, 2. ])
    """
    roots = _native.rsqrt(x, accuracy, out, chosen()) if where is True else None
    return _root(_native.rsqrt, x, accuracy, out, where) if roots is None else roots


def reciprocal(x, accuracy="correctly_rounded", out=None, *, where=True):
    """Compute reciprocals, 1 / x.

    Special values are as in IEEE 754, whatever the accuracy. Runs on one thread.
    Error bounds hold if 1 / x is at least 2^-125 (float64: 2^-1021).

    Parameters
    ----------
    x, out, where
        As in sqrt().
    accuracy : str or float, default "correctly_rounded"
        The error bound for normal numbers: "correctly_rounded" (0.5 ULP), "1 ulp", "2 ulp", "2^-44", "2^-22", "2^-16",
        "2^-11" or "2^-4" (relative errors). "2^-44" of a float32 is "1 ulp". A float, such as 1e-7, is a relative
        error: the loosest bound that keeps it.

    Returns
    -------
    ndarray or scalar
        The results, in the shape of x.

    Examples
    --------
    >>> raylanes.reciprocal([4.0, 0.5])
    array([0.25, 2.  ])
    """
    roots = _native.reciprocal(x, accuracy, out, chosen()) if where is True else None
    return _root(_native.reciprocal, x, accuracy, out, where) if roots is None else roots


def _root(root, x, accuracy, out, where):
    """The same for other arrays than dense ones of float32 or float64, for some elements, and for wrong arguments."""
    x = numbers("x", x)
    if not isinstance(accuracy, float):
        accuracy = _native.accuracy(word("accuracy", accuracy))
    wanted = np.dtype(np.float32 if x.dtype.kind == "f" and x.itemsize <= 4 else np.float64)
    if where is not True:
        return _roots_of_some(root, x, accuracy, out, where, wanted)
    # In place is as good as apart, one element further is not.
    answer = Answer(out, x.shape, wanted, () if out is x else (x,))
    root(np.require(x, wanted, "CA").reshape(-1), accuracy, answer.rows, chosen())
    return answer.finish()


def _roots_of_some(root, x, accuracy, out, where, wanted):
    mask = np.asarray(where)
    if mask.dtype != np.bool_:
        raise TypeError(f"where: booleans are needed, not {mask.dtype}")
    if mask.shape != x.shape:
        try:
            mask = np.broadcast_to(mask, x.shape)
        except ValueError:
            raise ValueError(f"where: the shape must be that of x, {x.shape}, or be broadcast to it; it is "
                             f"{mask.shape}") from None
    answer = Answer(out, x.shape, wanted, (), 0)
    some = np.require(x[mask], wanted, "CA")
    root(some, accuracy, some, chosen())
    answer.array[mask] = some
    return answer.finish()
