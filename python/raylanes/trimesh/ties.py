"""Ties of distance: the triangle whose normal points to the query, as trimesh chooses it."""

import numpy as np

from .._arrays import positions_of

COSINE_SLACK = 2.0**-40
"""Cosines that differ by less are equal: coplanar triangles have normals that differ by rounding."""


class Facing:
    """Unit normals of a mesh's triangles, and the triangles at each corner; corners are equal if their positions are.

    vertices: (n, 3) doubles; faces: (m, 3) integers.
    """

    def __init__(self, vertices, faces):
        self._position = positions_of(vertices)[faces]
        corners = vertices[faces]
        with np.errstate(invalid="ignore", over="ignore"):
            edges = corners[:, 1:] - corners[:, :1]
            # By a power of two, so that products neither overflow nor vanish.
            edges = np.ldexp(edges, -np.frexp(np.max(np.abs(edges), axis=(1, 2), keepdims=True, initial=0))[1])
            normals = np.cross(edges[:, 0], edges[:, 1])
            # A sliver without area has no normal.
            self._normals = normals / np.sqrt(np.sum(normals * normals, axis=1, keepdims=True))
        flat = self._position.reshape(-1)
        self._triangles = np.argsort(flat, kind="stable") // 3  # in the order of positions
        self._starts = np.concatenate([[0], np.cumsum(np.bincount(flat, minlength=1))])
        self._doubled = np.zeros(len(faces), bool)
        same = positions_of(np.sort(self._position, axis=1))
        self._doubled[:] = np.bincount(same, minlength=1)[same] > 1

    def best(self, triangles, features, towards):
        """(triangles, cosines): of all triangles that share the feature, the one whose normal has the largest cosine
        with `towards`; of equal ones the least.

        features: (n, 3) bool, which corners of each triangle span it: a corner, an edge or all. towards: unit vectors.
        """
        chosen, cosines = np.empty_like(triangles), np.empty(len(triangles))
        counts = self._counts(triangles, features)
        part = (np.cumsum(counts) - 1) // 2**20  # bounds the memory
        for of in np.split(np.arange(len(triangles)), np.flatnonzero(np.diff(part)) + 1):
            if len(of):
                chosen[of], cosines[of] = self._best(triangles[of], features[of], towards[of], counts[of])
        return chosen, cosines

    def _counts(self, triangles, features):
        at = self._position[triangles, features.argmax(axis=1)]
        single = features.all(axis=1) & ~self._doubled[triangles]
        return np.where(single, 0, self._starts[at + 1] - self._starts[at])

    def _best(self, triangles, features, towards, counts):
        """counts: of candidates besides the triangle itself."""
        begin = np.cumsum(counts + 1) - (counts + 1)
        row = np.repeat(np.arange(len(triangles)), counts + 1)
        place = np.arange(len(row)) - begin[row] - 1  # -1: the triangle itself
        start = self._starts[self._position[triangles, features.argmax(axis=1)]]
        candidates = np.where(place < 0, triangles[row], self._triangles[np.maximum(start[row] + place, 0)])
        wanted = self._position[triangles]
        shares = np.ones(len(row), bool)
        for corner in range(3):
            has = (self._position[candidates] == wanted[row, corner, None]).any(axis=1)
            shares &= has | ~features[row, corner]
        cosines = np.sum(self._normals[candidates] * towards[row], axis=1)
        cosines[~shares | np.isnan(cosines)] = -np.inf
        largest = np.maximum.reduceat(cosines, begin)
        equal = shares & (cosines >= largest[row] - COSINE_SLACK)
        return np.minimum.reduceat(np.where(equal, candidates, np.iinfo(candidates.dtype).max), begin), largest
