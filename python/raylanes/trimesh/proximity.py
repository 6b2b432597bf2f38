"""trimesh.proximity: the closest points of a mesh."""

import numpy as np

from .._arrays import no_primitive
from .._point_queries import OUTSIDE
from .of_mesh import OfMesh, table
from .ties import COSINE_SLACK

TIE = 2.0**-24
"""Distances whose ratio differs from 1 by less are equal."""


class ProximityQuery(OfMesh):
    """Closest points of a mesh, with a tree that is kept until its vertices or faces change."""

    def on_surface(self, points):
        """(closest, distance, triangle_id): (m, 3) float64, (m,) float64, (m,) int64.

        The triangle is the closest one, as Bvh.closest_points finds it for the mesh's own doubles. Ties go to the
        triangle whose normal points to the query most, as in trimesh, then to the lowest index. A tie is a triangle
        that shares the closest corner or edge, or has the same corners. So is the nearest triangle of another part of
        the surface, within 2^-24 of the distance. Point and distance are that triangle's in double. For a point that
        is not finite, or a mesh without triangles: NaN, inf, -1.
        """
        of_mesh, points = self.of_mesh(), table("points", points)
        near = Nearest(of_mesh, points, points)
        _break_ties(of_mesh, points, near)
        closest = np.full(points.shape, np.nan)
        closest[near.found] = points[near.found] + near.offset[near.found]
        return closest, near.distance, np.where(near.found, near.triangle, -1)

    def signed_distance(self, points):
        """(m,) float64, as trimesh has it: positive inside, negative outside. Bvh.signed_distances has the other sign.

        The sign is that of contains_points, exact for the mesh's own doubles. -inf of a point that is not finite.
        """
        of_mesh, points = self.of_mesh(), table("points", points)
        distance = Nearest(of_mesh, points, points).distance
        return np.where(of_mesh.locate(points) == OUTSIDE, -distance, distance)


def closest_point(mesh, points):
    """ProximityQuery(mesh).on_surface(points): makes a tree at each call."""
    return ProximityQuery(mesh).on_surface(points)


def signed_distance(mesh, points):
    """ProximityQuery(mesh).signed_distance(points): makes a tree at each call.

    Positive inside, negative outside, as in trimesh. Bvh.signed_distances has the other sign.
    """
    return ProximityQuery(mesh).signed_distance(points)


class Nearest:
    """The triangle of the tree that is nearest to each of `asked_points`, and how far it is from `points`.

    found: (n,) bool; triangle: (n,) int64, 0 where there is none; offset: (n, 3) doubles, from the point to the closest
    point of that triangle; distance: (n,) doubles, inf where there is none; features: see nearest_offsets.
    """

    def __init__(self, of_mesh, points, asked_points):
        nearest = of_mesh.tree.closest_points(asked_points).primitive
        self.found = nearest != no_primitive
        self.triangle = np.where(self.found, nearest, 0).astype(np.int64)
        self.offset, self.distance = np.full(points.shape, np.nan), np.full(len(points), np.inf)
        self.features = np.zeros(points.shape, bool)
        if self.found.any():
            corners = of_mesh.corners(nearest[self.found]) - points[self.found, None]
            self.offset[self.found], self.features[self.found] = nearest_offsets(corners)
            self.distance[self.found] = np.sqrt(np.sum(self.offset[self.found]**2, axis=1))

    def towards(self):
        """Unit vectors from the closest points to the queries."""
        return -self.offset / self.distance[:, None]

    def at(self, rows):
        part = object.__new__(Nearest)
        for name, array in vars(self).items():
            setattr(part, name, array[rows])
        return part

    def put(self, rows, other):
        for name, array in vars(self).items():
            array[rows] = getattr(other, name)


def _break_ties(of_mesh, points, near):
    """Replaces triangles of `near` by those that are as near and whose normals point to the query more."""
    rows = np.flatnonzero(near.found & (near.distance > 0) & (near.distance < np.inf))
    if not len(rows):
        return
    first = near.at(rows)
    nearest = first.triangle
    first.triangle, cosines = of_mesh.facing.best(nearest, first.features, first.towards())
    near.put(rows, first)
    # A step away from the nearest part of the surface makes another part the nearest one if it was as near. A long step
    # may meet a third part; a short one does not separate parts in nearly the same direction.
    for step in (2.0**-10, 2.0**-18):
        other = Nearest(of_mesh, points[rows], points[rows] - step * first.offset)
        another = np.flatnonzero(other.found & (other.triangle != nearest) & (other.triangle != first.triangle))
        rows, first, nearest, cosines = rows[another], first.at(another), nearest[another], cosines[another]
        if not len(rows):
            return
        other = other.at(another)
        ties = other.distance <= first.distance * (1 + TIE)
        other.triangle, facing = of_mesh.facing.best(other.triangle, other.features, other.towards())
        better = ties & (facing > cosines + COSINE_SLACK)
        near.put(rows[better], other.at(better))
        rows, first, nearest, cosines = rows[~ties], first.at(~ties), nearest[~ties], cosines[~ties]


def nearest_offsets(corners):
    """(offsets, features): of each triangle, (n, 3, 3), the point closest to 0, and (n, 3) bool, the corners that span
    the corner, edge or whole triangle where it lies.

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
    rows = np.arange(len(corners))
    squared = dot(on_edges, on_edges)
    edge, of_foot = squared.argmin(axis=1), dot(foot, foot)
    offsets = np.where((of_foot <= squared[rows, edge])[:, None], foot, on_edges[rows, edge])
    features = np.zeros((len(corners), 3), bool)
    features[rows, edge] = along[rows, edge] < 1 - 2.0**-40
    features[rows, (edge + 1) % 3] = along[rows, edge] > 2.0**-40
    features[of_foot * (1 + 2.0**-40) < squared[rows, edge]] = True
    return offsets, features


def dot(a, b):
    return np.sum(a * b, axis=-1)
