"""Sizes and reports of trees, which Bvh and KdTree share."""

import numpy as np

from . import _native
from ._arrays import DOUBLES, FLOATS
from ._stored import Stored


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
