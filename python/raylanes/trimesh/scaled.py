"""Meshes in doubles as trees of floats."""

from functools import cached_property

import numpy as np

from .._arrays import faces_of, numbers
from .._native import closed_report
from ..tree import Bvh
from .ties import Facing


class ScaledTree:
    """The tree of a mesh whose vertices are (vertices - centre) * scale, scale being a power of two."""

    def __init__(self, vertices, faces):
        # Copies: the mesh may change its own.
        self.vertices, self.faces = np.array(vertices), np.array(faces)
        used = self.vertices[self.faces.reshape(-1)] if self._is_whole() else self.vertices
        low, high = (used.min(axis=0), used.max(axis=0)) if len(used) else (np.zeros(3), np.zeros(3))
        self.longest = 2 * np.max(high / 2 - low / 2)
        self.centre, self.scale = np.zeros(3), 1.0
        if 0 < self.longest < np.inf:  # else a point, or numbers that the tree refuses
            self.centre = low / 2 + high / 2
            self.scale = np.ldexp(1.0, min(1 - np.frexp(self.longest)[1], 1000))
        with np.errstate(over="ignore"):
            self._rounded = self.to_tree(self.vertices).astype(np.float32)
        self.tree = Bvh(self._rounded, self.faces)

    def _is_whole(self):
        return self.faces.size == 0 or (self.faces.min() >= 0 and self.faces.max() < len(self.vertices))

    def is_of(self, vertices, faces):
        """Whether the arrays are the same; NaN, in vertices that no face uses, equals itself."""
        same = np.array_equal(self.vertices, vertices) or np.array_equal(self.vertices, vertices, equal_nan=True)
        return same and np.array_equal(self.faces, faces)

    def locate(self, points):
        """OUTSIDE, INSIDE or ON of points of the mesh."""
        with np.errstate(over="ignore", invalid="ignore"):
            return self.tree.locate(self.to_tree(points), rule=self._rule)

    @cached_property
    def _rule(self):
        """Six directions vote where one may go out through a hole."""
        return "parity" if closed_report(self._rounded, self.faces, 0)["has_parity"] else "vote"

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


class OfMesh:
    """Keeps the tree of a mesh, and makes it again when vertices or faces have changed."""

    def __init__(self, mesh):
        self.mesh = mesh
        self._scaled = None

    def scaled(self):
        """The arrays of mesh and tree are compared, which takes a millisecond for a million numbers."""
        vertices = table("vertices", self.mesh.vertices)
        faces = faces_of(np.asarray(self.mesh.faces))
        if self._scaled is None or not self._scaled.is_of(vertices, faces):
            self._scaled = ScaledTree(vertices, faces)
        return self._scaled


def table(name, values):
    """(n, 3) doubles."""
    array = np.asarray(numbers(name, values) if np.size(values) else np.zeros((0, 3)), np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: the shape must be (n, 3), it is {array.shape}")
    return array
