"""The tree of a mesh, kept until the mesh changes."""

from functools import cached_property

import numpy as np

from .._arrays import faces_of, numbers, stand_ins
from .._native import closed_report
from ..tree import Bvh
from .ties import Facing


class MeshTree:
    """The tree over a mesh's own doubles."""

    def __init__(self, vertices, faces):
        # Copies: the mesh may change its own.
        self.vertices, self.faces = np.array(vertices), np.array(faces)
        self.tree = Bvh(self.vertices, self.faces)

    def is_of(self, vertices, faces):
        """Whether the arrays are the same; NaN, in vertices that no face uses, equals itself."""
        same = np.array_equal(self.vertices, vertices) or np.array_equal(self.vertices, vertices, equal_nan=True)
        return same and np.array_equal(self.faces, faces)

    def locate(self, points):
        """OUTSIDE, INSIDE or ON of points of the mesh."""
        return self.tree.locate(points, rule=self._rule)

    @cached_property
    def _rule(self):
        """Six directions vote where one may go out through a hole."""
        report = closed_report(stand_ins("vertices", self.vertices), self.faces, 0)
        return "parity" if report["has_parity"] else "vote"

    @cached_property
    def facing(self):
        """Normals, and which triangles meet."""
        return Facing(self.vertices, self.faces)

    def corners(self, triangles):
        """(n, 3, 3) doubles: the mesh's own."""
        return self.vertices[self.faces[triangles]]


class OfMesh:
    """Keeps the tree of a mesh, and makes it again when vertices or faces have changed."""

    def __init__(self, mesh):
        self.mesh = mesh
        self._made = None

    def of_mesh(self):
        """The arrays of mesh and tree are compared, which takes a millisecond for a million numbers."""
        vertices = table("vertices", self.mesh.vertices)
        faces = faces_of(np.asarray(self.mesh.faces))
        if self._made is None or not self._made.is_of(vertices, faces):
            self._made = MeshTree(vertices, faces)
        return self._made


def table(name, values):
    """(n, 3) doubles."""
    array = np.asarray(numbers(name, values) if np.size(values) else np.zeros((0, 3)), np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: the shape must be (n, 3), it is {array.shape}")
    return array
