"""Exact, fast rays over NumPy arrays, and square roots by the accuracy asked for.

    >>> import numpy as np, raylanes
    >>> tree = raylanes.Bvh(vertices, faces)                # (n, 3) floats, (m, 3) integers
    >>> hits = tree.closest(origins=origins, directions=directions)  # (..., 3) floats each, broadcast
    >>> hits.t, hits.u, hits.v, hits.primitive, hits.hit    # arrays, one element a ray

A Bvh keeps the vertices that it is given: float64 and integers make a tree of float64, float32 one of float32, and
`dtype` asks for another type. So does a Scene by its first geometry. Rays, points and results have the type of the tree
or scene. Arrays of that type with a contiguous
last axis are read in place, with any positive stride of rows. Other arrays are converted. To float32, numbers are
rounded to nearest (relative error 2^-24), and beyond 3.4e38 they become infinite, with NumPy's RuntimeWarning.

Wrong types raise TypeError, wrong shapes and values raise ValueError, as in NumPy. Calls release the GIL. As with
NumPy, no thread may write to an array while a call reads it.
"""

from ._arrays import (closest_point_dtype, containing_part_dtype, count_dtype, crossing_dtype,
                      double_closest_point_dtype, double_crossing_dtype, double_hit_dtype, double_ray_dtype,
                      double_scene_closest_point_dtype, double_scene_crossing_dtype, double_scene_hit_dtype,
                      double_scene_stretch_dtype, double_stretch_dtype, faces_of as _faces_of, hit_dtype, no_part,
                      no_primitive, ray_dtype, rays, scene_closest_point_dtype, scene_crossing_dtype, scene_hit_dtype,
                      scene_stretch_dtype, stand_ins as _stand_ins, stretch_dtype, volume_of as _volume_of)
from ._meshes import MeshWarning, parts_of as _parts_of
from ._native import __version__, closed_report as _closed_report
from ._point_queries import INSIDE, ON, OUTSIDE
from ._scalars import count as _count
from .hits import ClosestPoint, ClosestPoints, Crossing, Crossings, Hit, Hits, Lists, Stretch, Stretches
from .paths import Path, active_path, paths, use_path
from .roots import reciprocal, rsqrt, sqrt
from .scene import Scene
from .scene_hits import (ContainingPart, ContainingParts, SceneClosestPoint, SceneClosestPoints, SceneCrossing,
                         SceneCrossings, SceneHit, SceneHits, SceneStretch, SceneStretches)
from .sphere_tree import SphereTree
from .tree import Bvh, KdTree

__all__ = [
    "Bvh", "ClosestPoint", "ClosestPoints", "ContainingPart", "ContainingParts", "Crossing", "Crossings", "Hit", "Hits",
    "INSIDE", "KdTree", "Lists", "MeshWarning", "ON", "OUTSIDE", "Path", "Scene", "SceneClosestPoint",
    "SceneClosestPoints", "SceneCrossing", "SceneCrossings", "SceneHit", "SceneHits", "SceneStretch", "SceneStretches",
    "SphereTree", "Stretch", "Stretches",
    "active_path", "closed_report", "closest_point_dtype", "containing_part_dtype", "count_dtype", "crossing_dtype",
    "double_closest_point_dtype", "double_crossing_dtype", "double_hit_dtype", "double_ray_dtype",
    "double_scene_closest_point_dtype", "double_scene_crossing_dtype", "double_scene_hit_dtype",
    "double_scene_stretch_dtype", "double_stretch_dtype", "hit_dtype", "no_part", "no_primitive", "paths", "ray_dtype",
    "rays", "reciprocal", "rsqrt", "scene_closest_point_dtype", "scene_crossing_dtype", "scene_hit_dtype",
    "scene_stretch_dtype", "sqrt", "stretch_dtype", "use_path",
]


def closed_report(vertices, faces=None, max_listed: int = 16) -> dict:
    """Find out whether a mesh is closed, and where it is not. Edges are pairs of positions, not of indices.

    Positions are compared as they are given: float64 is not rounded.

    Parameters
    ----------
    vertices : array of float, shape (n, 3), or a mesh as for a Bvh
    faces : array of int, shape (m, 3)
    max_listed : int, default 16
        How many faulty edges to list.

    Returns
    -------
    dict
        edges, open, inconsistent, shared : int
            The number of edges, and of those with a fault.
        degenerate : int
            The number of triangles with two equal corners.
        doubled : int
            The number of triangles with the three corners of an earlier one. The rule "parity" counts each of them: in
            a box with all faces doubled, every point is OUTSIDE, though has_parity is True. By "nonzero" and "winding"
            it is INSIDE if the copies have the same direction.
        first : list of (fault, triangle, from, to)
            The first faulty edges.
        is_closed, has_parity, has_winding_numbers : bool
            Whether each edge has two triangles in opposite directions; whether the rule "parity" of locate() is well
            defined; whether the rule "nonzero" is.
        volume : float
            The volume within the mesh, if has_winding_numbers; otherwise 0. Negative if normals point inwards.
        is_inside_out : bool
            Whether volume is negative: faces[:, ::-1] turns the mesh over.

    Examples
    --------
    >>> raylanes.closed_report([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])["open"]
    3
    """
    vertices, faces = _parts_of(vertices, faces)
    faces = _faces_of(faces)
    report = _closed_report(_stand_ins("vertices", vertices), faces, _count("max_listed", max_listed, 2**32 - 1))
    volume = _volume_of(vertices, faces) if report["has_winding_numbers"] else 0.0
    return {**report, "volume": volume, "is_inside_out": volume < 0}
