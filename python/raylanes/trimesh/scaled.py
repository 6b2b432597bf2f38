"""Meshes in doubles as trees of floats, for closest points."""

from functools import cached_property

import numpy as np

from .. import _native
from .._warn import warn
from ..tree import Bvh
from .ties import Facing


class ScaledTree:
    """The tree of floats of a mesh whose vertices are (vertices - centre) * scale, scale being a power of two.

    left_out: how many triangles of the mesh have two equal corners.
    """

    def __init__(self, vertices, faces, left_out):
        self.vertices, self.faces = vertices, faces
        used = vertices[faces.reshape(-1)]
        low, high = (used.min(axis=0), used.max(axis=0)) if len(used) else (np.zeros(3), np.zeros(3))
        longest = 2 * np.max(high / 2 - low / 2)
        self.centre, self.scale = np.zeros(3), 1.0
        if longest > 0:  # else a point
            self.centre = low / 2 + high / 2
            self.scale = np.ldexp(1.0, min(1 - np.frexp(longest)[1], 1000))
        with np.errstate(over="ignore"):
            rounded = self.to_tree(vertices).astype(np.float32)
        self.tree = Bvh.__new__(Bvh)
        self.tree._tree = _native.Bvh(rounded, faces, "binned_sah", 0, False, 0.0)
        lost = self.tree._tree.left_out() - left_out
        if lost > 0:
            warn(f"{lost} of {len(faces)} triangles are smaller than the rounding of closest points to float32: no "
                 "closest point is on them")

    @cached_property
    def facing(self):
        """Normals, and which triangles meet."""
        return Facing(self.to_tree(self.vertices), self.faces)

    def to_tree(self, points):
        """In double."""
        return (points - self.centre) * self.scale

    def corners(self, triangles):
        """(n, 3, 3) doubles: the mesh's own."""
        return self.vertices[self.faces[triangles]]
