"""The queries of trimesh, with its own interface; trimesh itself is not needed.

    mesh.ray = raylanes.trimesh.RayMeshIntersector(mesh)
    closest, distance, triangle = raylanes.trimesh.closest_point(mesh, points)

A mesh is anything with `vertices`, (n, 3) floats, and `faces`, (m, 3) integers.

Coordinates are doubles, the tree has floats: vertices less the middle of their box, by a power of two that makes half
of the box's longest side 0.5 to 1. So a vertex moves by at most 2^-25 of the longest side E along each axis, wherever
the mesh lies. It does not move if its coordinates have few bits. Rays that begin far away are first followed, in
double, to where the mesh is: there a ray is off by at most 2^-20 * E along each axis. Hits are decided exactly
for the rounded rays and triangles: no hit is lost between two triangles, whatever the scale, and all methods agree.
Points at a distance D from the middle are off by at most 2^-24 * (D + E).
"""

from .proximity import ProximityQuery, closest_point, signed_distance
from .ray import RayMeshIntersector

__all__ = ["ProximityQuery", "RayMeshIntersector", "closest_point", "signed_distance"]
