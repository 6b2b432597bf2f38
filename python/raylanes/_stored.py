"""Copies and files of what has a native object, which trees and scenes share, and reports of trees."""

import io

import numpy as np

from . import _native
from ._arrays import DOUBLES, FLOATS
from ._files import Headed, write_whole
from ._scalars import path_of


class Copied:
    """An object with the native object `self._tree`, whose copies share memory."""

    def __reduce_ex__(self, protocol):
        """Pickle and copy as any object. A copy has a native object of its own; both share memory until one changes."""
        parts = super().__reduce_ex__(protocol)
        state = parts[2] if len(parts) > 2 else None
        attributes = state[0] if isinstance(state, tuple) and state else state
        if not isinstance(attributes, dict) or attributes.get("_tree") is not self._tree:
            return parts
        attributes = {**attributes, **self._parts_of_copy()}
        state = (attributes, *state[1:]) if isinstance(state, tuple) else attributes
        return *parts[:2], state, *parts[3:]

    def _parts_of_copy(self):
        return {"_tree": type(self._tree)(self._tree)}


class Stored(Copied):
    """An object with the native object `self._tree`, which `_native_of` makes from a file."""

    _natives: dict = {}  # the other native classes than `_native_tree`, by how their files begin

    def save(self, file):
        """Write this to a file; load() reads it on any machine.

        A file at a path is replaced when the new one is complete: if this raises, the old file is unchanged.

        Parameters
        ----------
        file : str, os.PathLike or file object
            A path, or a file opened for writing bytes.

        Returns
        -------
        None
        """
        if hasattr(file, "write"):
            if isinstance(file, io.TextIOBase):
                raise TypeError(f"file: a file opened for writing bytes is needed, not {type(file).__name__}")
            file.write(self._tree.to_bytes())
        else:
            write_whole(path_of("file", file), self._tree.to_bytes())

    @classmethod
    def load(cls, file):
        """Read what save() wrote. No bytes make an object that faults.

        Parameters
        ----------
        file : str, os.PathLike or file object
            A path, or a file opened for reading bytes, also one that cannot seek. Nothing behind the object is read.

        Returns
        -------
        Bvh, KdTree or Scene
            The object, of the class that load() is called on.

        Raises
        ------
        ValueError
            If the bytes are no such object, cut or damaged.
        TypeError
            If `file` is neither a path nor a file opened for reading bytes.
        """
        read = getattr(file, "read", None)
        made = cls.__new__(cls)
        made._tree = cls._native_of(np.fromfile(path_of("file", file), np.uint8) if read is None else read)
        return made

    @classmethod
    def _native_of(cls, source):
        """The native object of a file's bytes, or of the function that reads them."""
        source = Headed(source) if callable(source) else source
        head = source.head if isinstance(source, Headed) else source[:16].tobytes()
        return cls._natives.get(head[:13], cls._native_tree)(source)


class StoredTree(Stored):
    """A tree `self._tree` of the native class `_native_tree`, or of _native.BvhD."""

    _rounded_away = 0  # triangles with two equal corners that the rounding to float32 made equal

    @property
    def _numbers(self):
        return DOUBLES if isinstance(self._tree, _native.BvhD) else FLOATS

    @property
    def dtype(self):
        """dtype: the type of coordinates, t, u and v: float32 or float64."""
        return self._numbers.real

    @property
    def bounds(self):
        """ndarray of self.dtype, shape (2, 3): the least and greatest coordinates; inf and -inf without triangles."""
        return np.array(self._tree.bounds(), self.dtype)

    @property
    def nbytes(self):
        """int: the bytes of nodes and leaves."""
        return self._tree.nbytes()

    def report(self):
        """Describe the tree and its build.

        Returns
        -------
        dict
            nodes, leaves, bytes, depth, sah_cost, seconds of each part of the build and more: the members of the C++
            structures TreeReport and KdReport. left_out: triangles that the build left out, because two corners are
            equal. rounded_away: triangles whose corners became equal by rounding to float32.

        Examples
        --------
        >>> tree.report()["triangles"]
        1
        """
        return {**self._tree.report(), "rounded_away": self._rounded_away}

    def __repr__(self):
        report = self.report()
        parts = [f"{report['triangles']} triangles of {self.dtype}", report["builder"], f"{report['bytes']} bytes"]
        if report["left_out"]:
            parts.append(f"{report['left_out']} left out for two equal corners")
        if report["rounded_away"]:
            parts.append(f"{report['rounded_away']} lost by rounding to float32")
        return f"<raylanes.{type(self).__name__} of {', '.join(parts)}>"
