"""Arrays that results are written to."""

import numpy as np


class Answer:
    """A new array, the caller's, or where that cannot be written in place one that is copied to it at the end.

    dtype, shape: of the answers. read: arrays that the call reads. initial: what answers of elements hold that take no
    part; None if all do. strided: whether rows may lie apart.
    """

    def __init__(self, out, shape, dtype, read, initial=None, strided=False):
        self.out = out
        if out is None:
            self.array = np.empty(shape, dtype) if initial is None else np.full(shape, initial, dtype)
            self.rows = self.array.reshape(-1)
            return
        if not isinstance(out, np.ndarray) or out.dtype != dtype:
            has = out.dtype if isinstance(out, np.ndarray) else type(out).__name__
            raise TypeError(f"out: an array of {dtype} is needed, not {has}")
        if out.shape != shape:
            raise ValueError(f"out: the shape must be {shape}, it is {out.shape}")
        if not out.flags.writeable:
            raise ValueError("out: the array is read-only")
        fits = out.flags.c_contiguous or (strided and out.ndim == 1 and out.strides[0] >= out.itemsize)
        in_place = fits and out.flags.aligned and not any(overlap(out, array) for array in read)
        self.array = out if in_place else out.copy()
        self.rows = self.array if out.ndim == 1 else self.array.reshape(-1)

    def finish(self, kind=np.ndarray):
        """The answers; a new array becomes one of `kind`, a new number a scalar."""
        if self.out is None:
            return self.array[()] if kind is np.ndarray else self.array.view(kind)
        if self.array is not self.out:
            self.out[...] = self.array
        return self.out


def overlap(a, b):
    """Whether a byte belongs to both; true also where that is hard to tell."""
    return np.may_share_memory(a, b, max_work=10000)
