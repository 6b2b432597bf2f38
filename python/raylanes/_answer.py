"""Arrays that results are written to."""

import numpy as np


class Answer:
    """A new array, the caller's, or where that cannot be written in place one that is copied to it at the end.

    dtype, shape: of the answers. read: an array that the call reads, or a tuple of them. initial: what answers of
    elements hold that take no part; None if all do. strided: whether rows may lie apart.
    """

    def __init__(self, out, shape, dtype, read, initial=None, strided=False):
        self.out = out
        if out is None:
            self.array = np.empty(shape, dtype) if initial is None else np.zeros(shape, dtype)  # also between fields
            if initial is not None:
                self.array[...] = initial
            self.rows = self.array if len(shape) == 1 else self.array.reshape(-1)
            return
        if not isinstance(out, np.ndarray) or out.dtype != dtype:
            has = out.dtype if isinstance(out, np.ndarray) else type(out).__name__
            raise TypeError(f"out: an array of {dtype} is needed, not {has}")
        if out.shape != shape:
            raise ValueError(f"out: the shape must be {shape}, it is {out.shape}")
        if not out.flags.writeable:
            raise ValueError("out: the array is read-only")
        if overlaps_itself(out):
            raise ValueError(f"out: elements must not overlap, they do with the strides {out.strides}")
        fits = out.flags.c_contiguous or (strided and out.ndim == 1 and out.strides[0] >= out.itemsize)
        arrays = read if isinstance(read, tuple) else (read,)
        in_place = fits and out.flags.aligned and not any(overlap(out, array) for array in arrays)
        self.array = out if in_place else out.copy()
        self.rows = self.array if out.ndim == 1 else self.array.reshape(-1)

    def finish(self, kind=np.ndarray):
        """The answers; a new array becomes one of `kind`, a new number a scalar."""
        if self.out is None:
            return self.array[()] if kind is np.ndarray else self.array.view(kind)
        if self.array is not self.out:
            self.out[...] = self.array
        return self.out


def overlaps_itself(array):
    """Whether a byte belongs to two elements."""
    if array.size < 2 or array.flags.c_contiguous:
        return False
    axes = sorted((abs(step), length) for step, length in zip(array.strides, array.shape) if length > 1)
    reach = array.itemsize
    for step, length in axes:
        if step < reach:
            return _elements_meet(axes, array.itemsize)
        reach += step * (length - 1)
    return False


def _elements_meet(axes, itemsize):
    """The same where axes are interleaved, by the address of each element."""
    if axes[0][0] == 0:
        return True
    addresses = np.zeros(1, np.int64)
    for step, length in axes:
        addresses = np.add.outer(addresses, step * np.arange(length)).reshape(-1)
    addresses.sort()
    return bool((np.diff(addresses) < itemsize).any())


def overlap(a, b):
    """Whether a byte belongs to both; true also where that is hard to tell."""
    return np.may_share_memory(a, b, max_work=10000)
