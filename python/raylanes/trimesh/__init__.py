"""The queries of trimesh, with its own interface; trimesh itself is not needed.

    mesh.ray = raylanes.trimesh.RayMeshIntersector(mesh)
    closest, distance, triangle = raylanes.trimesh.closest_point(mesh, points)

A mesh is anything with `vertices`, (n, 3) floats, and `faces`, (m, 3) integers.

Coordinates are doubles, and so are the tree's: nothing is moved, scaled or rounded. Hits, and inside and outside, are
decided exactly for the mesh's own doubles: no hit is lost between two triangles, whatever the scale, and all methods
agree. Bvh.closest_points has the bound of the error of distances.
"""

from .proximity import ProximityQuery, closest_point, signed_distance
from .ray import RayMeshIntersector

__all__ = ["ProximityQuery", "RayMeshIntersector", "closest_point", "signed_distance"]
