"""Exact, fast rays over NumPy arrays, and square roots by the accuracy asked for.

    import numpy as np, raylanes
    tree = raylanes.Bvh(vertices, faces)                # (n, 3) floats, (m, 3) integers
    hits = tree.closest(raylanes.rays(origins, directions))
    hits.t, hits.u, hits.v, hits.primitive, hits.hit    # arrays, one element a ray

Numbers are float32. Arrays of float32 whose last axis is contiguous are read where they are, with any positive
stride of rows; all others are converted: float64 is rounded to nearest (relative error 2^-24), and what is beyond
3.4e38 becomes infinite, with NumPy's RuntimeWarning. raylanes.trimesh is for coordinates in float64.

Wrong types are a TypeError, wrong shapes and values a ValueError, as in NumPy. The GIL is released; as with NumPy, no
thread may write to an array while a call reads it.
"""

from ._native import __version__
from ._native import closed_report as _closed_report
from .arrays import closest_point_dtype, count_dtype, crossing_dtype, faces_of, hit_dtype, no_primitive, ray_dtype, rays
from .arrays import vertices_of
from .hits import ClosestPoint, ClosestPoints, Crossing, Crossings, Hit, Hits, Lists
from .paths import Path, active_path, paths, use_path
from .roots import reciprocal, rsqrt, sqrt
from .scalars import count as _count
from .tree import INSIDE, ON, OUTSIDE, Bvh, KdTree

__all__ = [
    "Bvh", "ClosestPoint", "ClosestPoints", "Crossing", "Crossings", "Hit", "Hits", "INSIDE", "KdTree", "Lists", "ON",
    "OUTSIDE", "Path", "active_path", "closed_report", "closest_point_dtype", "count_dtype", "crossing_dtype",
    "hit_dtype", "no_primitive", "paths", "ray_dtype", "rays", "reciprocal", "rsqrt", "sqrt", "use_path",
]


def closed_report(vertices, faces, max_listed: int = 16) -> dict:
    """Whether a mesh encloses a volume, and where it does not.

    vertices: (n, 3) floats; faces: (m, 3) integers. Edges are pairs of positions, not of indices. The answer has the
    numbers of `edges`, `open`, `inconsistent` and `shared` ones, of `degenerate` triangles, the `first` faulty edges as
    (fault, triangle, from, to), and whether the mesh `is_closed`, `has_parity` (what inside() needs) and
    `has_winding_numbers` (what its rule "nonzero" needs).
    """
    return _closed_report(vertices_of("vertices", vertices), faces_of(faces),
                          _count("max_listed", max_listed, 2**32 - 1))
