"""trimesh.ray: RayMeshIntersector."""

import numpy as np

from .._arrays import rays
from .._point_queries import OUTSIDE
from .scaled import OfMesh, table


class RayMeshIntersector(OfMesh):
    """Rays against a mesh, as trimesh.ray.ray_pyembree.RayMeshIntersector and ray_triangle have it.

    The tree is made at the first call, and again after the mesh's vertices or faces have changed. Rays: origins and
    directions, (m, 3) floats each; directions need not be normalised. Rays that are not finite hit nothing. Hits lie
    ahead of the origin or on it. Order: by ray, then by distance, then by triangle.
    """

    def __init__(self, mesh=None, scale_to_box=True, *, geometry=None):
        """mesh: anything with `vertices` and `faces`; `geometry` is another name for it. scale_to_box: for trimesh's
        callers; here the mesh is centred and scaled in any case.
        """
        if (mesh is None) == (geometry is None):
            raise TypeError("RayMeshIntersector: one mesh is needed, as `mesh` or as `geometry`")
        super().__init__(geometry if mesh is None else mesh)

    def intersects_id(self, ray_origins, ray_directions, multiple_hits=True, max_hits=None, return_locations=False):
        """(index_tri, index_ray) and with return_locations also locations: (h,) int64, (h,) int64, (h, 3) float64.

        Each triangle that a ray hits once: at an edge or a vertex all triangles that meet there. max_hits: of each ray
        at most so many, None for all; multiple_hits=False is one.
        """
        scaled, made, origins, directions = self._rays(ray_origins, ray_directions)
        if not multiple_hits or max_hits == 1:
            hits = scaled.tree.closest(made)
            index_ray = np.flatnonzero(hits.hit)
            hits = hits[index_ray]
        else:
            found = scaled.tree.all_hits(made, max_count=max_hits)
            index_ray, hits = found.ray, found.items
        index_tri = hits.primitive.astype(np.int64)
        if not return_locations:
            return index_tri, index_ray
        return index_tri, index_ray, locations(scaled, hits, origins[index_ray], directions[index_ray])

    def intersects_location(self, ray_origins, ray_directions, multiple_hits=True):
        """(locations, index_ray, index_tri): (h, 3) float64, (h,) int64, (h,) int64.

        Unique places: of triangles that a ray hits at one distance, as at an edge, the first.
        """
        scaled, made, origins, directions = self._rays(ray_origins, ray_directions)
        found = scaled.tree.all_hits(made, max_count=None if multiple_hits else 1)
        index_ray, hits = found.ray, found.items
        again = np.zeros(len(hits), bool)
        again[1:] = (hits.t[1:] == hits.t[:-1]) & (index_ray[1:] == index_ray[:-1])
        index_ray, hits = index_ray[~again], hits[~again]
        index_tri = hits.primitive.astype(np.int64)
        return locations(scaled, hits, origins[index_ray], directions[index_ray]), index_ray, index_tri

    def intersects_first(self, ray_origins, ray_directions):
        """(m,) int64: the nearest triangle of each ray, -1 if it hits nothing."""
        scaled, made, _, _ = self._rays(ray_origins, ray_directions)
        hits = scaled.tree.closest(made)
        return np.where(hits.hit, hits.primitive.astype(np.int64), -1)

    def intersects_any(self, ray_origins, ray_directions):
        """(m,) bool: whether each ray hits anything."""
        scaled, made, _, _ = self._rays(ray_origins, ray_directions)
        return scaled.tree.occluded(made)

    def contains_points(self, points):
        """(n,) bool: whether each point is inside the mesh or on it, by the number of crossings of a ray. If
        the mesh has holes, see raylanes.closed_report, four of six rays must say so. Bvh.inside has another rule: one
        ray, unless `rule` says otherwise.
        """
        return self.scaled().locate(table("points", points)) != OUTSIDE

    def _rays(self, ray_origins, ray_directions):
        scaled = self.scaled()
        origins, directions = table("ray_origins", ray_origins), table("ray_directions", ray_directions)
        if len(origins) != len(directions):
            raise ValueError(f"{len(origins)} ray_origins and {len(directions)} ray_directions")
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            unit = near_unit(directions)
            return scaled, rays(moved_near(scaled.to_tree(origins), unit), unit), origins, unit


def near_unit(directions):
    """The directions by powers of two that make their greatest component 1 to 2; others stay as they are."""
    greatest = np.max(np.abs(directions), axis=1, keepdims=True, initial=0)
    exponent = np.where((greatest > 0) & (greatest < np.inf), np.frexp(greatest)[1] - 1, 0)
    return np.ldexp(directions, -exponent)


def moved_near(origins, directions):
    """Origins nearer to the mesh, which lies in the cube from -1 to 1, but still before it.

    By a whole number of directions: origins and directions of a few bits stay exact.
    """
    squared = np.sum(directions * directions, axis=1)
    # The sphere of radius 2 holds the cube.
    steps = np.floor(-np.sum(origins * directions, axis=1) / squared - 2 / np.sqrt(squared))
    return np.where((steps > 0)[:, None], origins + np.where(steps > 0, steps, 0)[:, None] * directions, origins)


def locations(scaled, hits, origins, directions):
    """(h, 3) doubles on the mesh's own triangles: where the ray meets the plane. For rays nearly in the plane that
    may be off by more than 2^-18 of the mesh's longest side; then it is the point that u and v define."""
    corners = scaled.corners(hits.primitive)
    edges = corners[:, 1:] - corners[:, :1]
    named = corners[:, 0] + np.einsum("hk,hkx->hx", np.stack([hits.u, hits.v], axis=1).astype(np.float64), edges)
    normals = np.cross(edges[:, 0], edges[:, 1])
    with np.errstate(all="ignore"):
        t = np.sum(normals * (corners[:, 0] - origins), axis=1) / np.sum(normals * directions, axis=1)
        met = origins + t[:, None] * directions
        near = np.max(np.abs(met - named), axis=1) <= scaled.longest * 2.0**-18
    return np.where(near[:, None], met, named)
