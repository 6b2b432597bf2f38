"""Checks of arguments that are not arrays."""

import operator
import os

import numpy as np

from ._arrays import numbers


def real(name, value, dtype):
    """A number, rounded to the nearest of `dtype`; infinite beyond its range, with NumPy's RuntimeWarning."""
    number = numbers(name, value)
    if number.ndim != 0:
        raise TypeError(f"{name}: one number is needed, not an array of the shape {number.shape}")
    return float(number.astype(dtype))


def whole(name, value, most):
    """An integer of at most `most`, not below -most - 1."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: an integer is needed, not {type(value).__name__}") from None
    if not -most - 1 <= number <= most:
        raise ValueError(f"{name}: {number} is out of range, the largest is {most}")
    return number


def count(name, value, most):
    """An integer from 0 to `most`."""
    number = whole(name, value, most)
    if number < 0:
        raise ValueError(f"{name}: {number} is negative")
    return number


def threads_of(value):
    """The number of threads; the library refuses negative ones."""
    return whole("threads", value, 2**31 - 1)


def word(name, value):
    """The name of an enumerator; the library refuses unknown ones."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: a string is needed, not {type(value).__name__}")
    # A lone surrogate has no UTF-8, a null ends what the library reads, a line break makes two lines of its message.
    return value if value.isprintable() else ascii(value)[1:-1]


def function(name, value):
    """A function, or None."""
    if value is not None and not callable(value):
        raise TypeError(f"{name}: a function is needed, not {type(value).__name__}")
    return value


def flag(name, value):
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name}: True or False is needed, not {type(value).__name__}")
    return bool(value)


def path_of(name, value):
    """A path as open() takes it; no number of an open file."""
    try:
        return os.fspath(value)
    except TypeError:
        raise TypeError(f"{name}: a path or a file object is needed, not {type(value).__name__}") from None
