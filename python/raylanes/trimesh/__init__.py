"""The queries of trimesh, with its own interface; trimesh itself is not needed.

    mesh.ray = raylanes.trimesh.RayMeshIntersector(mesh)
    closest, distance, triangle = raylanes.trimesh.closest_point(mesh, points)

A mesh is anything with `vertices`, (n, 3) floats, and `faces`, (m, 3) integers.

Coordinates are doubles, and so are the tree's: nothing is moved, scaled or rounded. Hits, and inside and outside, are
decided exactly for the mesh's own doubles: no hit is lost between two triangles, whatever the scale, and all methods
agree.

The nearest triangle to a point is looked for among triangles that are rounded to float32, in a frame of the mesh. E is
the longest side of the mesh's box, D the distance of the point from its middle: a triangle that is farther by up to
2^-22 * (D + E) may be taken. Point and distance are then computed in double on the mesh's own triangle.
"""

from .proximity import ProximityQuery, closest_point, signed_distance
from .ray import RayMeshIntersector

__all__ = ["ProximityQuery", "RayMeshIntersector", "closest_point", "signed_distance"]
