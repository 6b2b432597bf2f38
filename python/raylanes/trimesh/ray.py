"""trimesh.ray: RayMeshIntersector."""

import numpy as np

from .._arrays import RayParts
from .._point_queries import OUTSIDE
from .of_mesh import OfMesh, table


class RayMeshIntersector(OfMesh):
    """Rays against a mesh, as trimesh.ray.ray_pyembree.RayMeshIntersector and ray_triangle have it.

    The tree is made at the first call, and again after the mesh's vertices or faces have changed. Rays: origins and
    directions, (m, 3) floats each; directions need not be normalised. Rays that are not finite hit nothing. Hits lie
    ahead of the origin or on it. Order: by ray, then by distance, then by triangle.
    """

    def __init__(self, mesh=None, scale_to_box=True, *, geometry=None):
        """mesh: anything with `vertices` and `faces`; `geometry` is another name for it. scale_to_box: for trimesh's
        callers; here the mesh is never scaled.
        """
        if (mesh is None) == (geometry is None):
            raise TypeError("RayMeshIntersector: one mesh is needed, as `mesh` or as `geometry`")
        super().__init__(geometry if mesh is None else mesh)

    def intersects_id(self, ray_origins, ray_directions, multiple_hits=True, max_hits=None, return_locations=False):
        """(index_tri, index_ray) and with return_locations also locations: (h,) int64, (h,) int64, (h, 3) float64.

        Each triangle that a ray hits once: at an edge or a vertex all triangles that meet there. max_hits: of each ray
        at most so many, None for all; multiple_hits=False is one.
        """
        of_mesh, rays = self.of_mesh(), _rays(ray_origins, ray_directions)
        if not multiple_hits or max_hits == 1:
            hits = of_mesh.tree.closest(rays)
            index_ray = np.flatnonzero(hits.hit)
            hits = hits[index_ray]
        else:
            found = of_mesh.tree.all_hits(rays, max_count=max_hits)
            index_ray, hits = found.ray, found.items
        index_tri = hits.primitive.astype(np.int64)
        if not return_locations:
            return index_tri, index_ray
        return index_tri, index_ray, locations(of_mesh, hits)

    def intersects_location(self, ray_origins, ray_directions, multiple_hits=True):
        """(locations, index_ray, index_tri): (h, 3) float64, (h,) int64, (h,) int64.

        Unique places: of triangles that a ray hits at one distance, as at an edge, the first.
        """
        of_mesh, rays = self.of_mesh(), _rays(ray_origins, ray_directions)
        found = of_mesh.tree.all_hits(rays, max_count=None if multiple_hits else 1)
        index_ray, hits = found.ray, found.items
        again = np.zeros(len(hits), bool)
        again[1:] = (hits.t[1:] == hits.t[:-1]) & (index_ray[1:] == index_ray[:-1])
        index_ray, hits = index_ray[~again], hits[~again]
        index_tri = hits.primitive.astype(np.int64)
        return locations(of_mesh, hits), index_ray, index_tri

    def intersects_first(self, ray_origins, ray_directions):
        """(m,) int64: the nearest triangle of each ray, -1 if it hits nothing."""
        hits = self.of_mesh().tree.closest(_rays(ray_origins, ray_directions))
        return np.where(hits.hit, hits.primitive.astype(np.int64), -1)

    def intersects_any(self, ray_origins, ray_directions):
        """(m,) bool: whether each ray hits anything."""
        return self.of_mesh().tree.occluded(_rays(ray_origins, ray_directions))

    def contains_points(self, points):
        """(n,) bool: whether each point is inside the mesh or on it, by the number of crossings of a ray. If
        the mesh has holes, see raylanes.closed_report, four of six rays must say so. Bvh.inside has another rule: one
        ray, unless `rule` says otherwise.
        """
        return self.of_mesh().locate(table("points", points)) != OUTSIDE


def _rays(ray_origins, ray_directions):
    origins, directions = table("ray_origins", ray_origins), table("ray_directions", ray_directions)
    if len(origins) != len(directions):
        raise ValueError(f"{len(origins)} ray_origins and {len(directions)} ray_directions")
    return RayParts(origins, near_unit(directions), 0.0, np.inf)


def near_unit(directions):
    """The directions by powers of two that make their greatest component 1 to 2, where no component is rounded: so that
    no t overflows."""
    greatest = np.max(np.abs(directions), axis=1, keepdims=True, initial=0)
    exponent = np.where((greatest > 0) & (greatest < np.inf), np.frexp(greatest)[1] - 1, 0)
    with np.errstate(under="ignore"):
        scaled = np.ldexp(directions, -exponent)
        return np.where((np.ldexp(scaled, exponent) == directions).all(axis=1, keepdims=True), scaled, directions)


def locations(of_mesh, hits):
    """(h, 3) doubles: the point that u and v define on the mesh's own triangle."""
    corners = of_mesh.corners(hits.primitive)
    edges = corners[:, 1:] - corners[:, :1]
    return corners[:, 0] + np.einsum("hk,hkx->hx", np.stack([hits.u, hits.v], axis=1), edges)
