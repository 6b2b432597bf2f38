"""trimesh.proximity: the closest points of a mesh."""

import numpy as np

from ..arrays import no_primitive
from ..tree import OUTSIDE
from .scaled import OfMesh, table


class ProximityQuery(OfMesh):
    """Closest points of a mesh, with a tree that is kept until its vertices or faces change."""

    def on_surface(self, points):
        """(closest, distance, triangle_id): (m, 3) float64, (m,) float64, (m,) int64.

        The triangle is the closest one to the rounded point, of equal ones the least: not farther than the closest one
        by more than 2^-22 * (D + E), see raylanes.trimesh. Point and distance are that triangle's in double. For a
        point that is not finite, or a mesh without triangles: NaN, inf, -1.
        """
        return _closest(self.scaled(), table("points", points))

    def signed_distance(self, points):
        """(m,) float64, as trimesh has it: positive inside, negative outside.

        The sign is that of contains_points: of the rounded point, which may be on the other side where the distance is
        below 2^-22 * (D + E). -inf of a point that is not finite.
        """
        scaled, points = self.scaled(), table("points", points)
        _, distance, _ = _closest(scaled, points)
        return np.where(scaled.locate(points) == OUTSIDE, -distance, distance)


def closest_point(mesh, points):
    """ProximityQuery(mesh).on_surface(points): makes a tree at each call."""
    return ProximityQuery(mesh).on_surface(points)


def signed_distance(mesh, points):
    """ProximityQuery(mesh).signed_distance(points): makes a tree at each call."""
    return ProximityQuery(mesh).signed_distance(points)


def _closest(scaled, points):
    with np.errstate(over="ignore", invalid="ignore"):
        nearest = scaled.tree.closest_points(scaled.to_tree(points)).primitive
    found = nearest != no_primitive
    closest, distance = np.full(points.shape, np.nan), np.full(len(points), np.inf)
    offset = nearest_offsets(scaled.corners(nearest[found]) - points[found, None])
    closest[found] = points[found] + offset
    distance[found] = np.sqrt(np.sum(offset * offset, axis=1))
    return closest, distance, np.where(found, nearest.astype(np.int64), -1)


def nearest_offsets(corners):
    """(n, 3): of each triangle, (n, 3, 3), the point closest to 0.

    As the library has it, see docs/queries.md: the closest points of the edges and the foot of the perpendicular, where
    it is inside, are compared.
    """
    edges = np.roll(corners, -1, axis=1) - corners
    with np.errstate(divide="ignore", invalid="ignore"):
        along = -dot(corners, edges) / dot(edges, edges)  # trees have no triangle with two equal corners
        on_edges = corners + np.clip(along, 0, 1)[..., None] * edges
        ab, ac, a = edges[:, 0], -edges[:, 2], corners[:, 0]
        k = dot(ac, ab) / dot(ab, ab)
        h = ac - k[:, None] * ab
        v = -(dot(a, ac) - k * dot(a, ab)) / dot(h, h)
        u = -dot(a, ab) / dot(ab, ab) - v * k
        foot = a + u[:, None] * ab + v[:, None] * ac
        foot[~((u >= 0) & (v >= 0) & (u + v <= 1))] = np.inf
    candidates = np.concatenate([foot[:, None], on_edges], axis=1)
    best = np.argmin(dot(candidates, candidates), axis=1)
    return candidates[np.arange(len(candidates)), best]


def dot(a, b):
    return np.sum(a * b, axis=-1)
