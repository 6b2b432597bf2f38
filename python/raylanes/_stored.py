"""Copies and files of what has a native object, which trees and scenes share."""

import io

import numpy as np

from ._files import write_whole
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
        attributes = {**attributes, "_tree": type(self._tree)(self._tree)}
        state = (attributes, *state[1:]) if isinstance(state, tuple) else attributes
        return *parts[:2], state, *parts[3:]


class Stored(Copied):
    """An object with the native object `self._tree`, which `_native_of` makes from a file."""

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
        return cls._native_tree(source)
