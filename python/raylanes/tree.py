"""Trees over triangles, and what can be asked of them."""

import os
from pickle import PickleBuffer

import numpy as np

from . import _native
from .answer import Answer, overlap
from .arrays import (closest_point_dtype, count_dtype, crossing_dtype, faces_of, hit_dtype, no_primitive, packed,
                     ray_rows, rows, vertices_of)
from .hits import ClosestPoints, Crossings, Hits, Lists
from .paths import chosen
from .scalars import count, flag, real, threads_of, word

OUTSIDE, INSIDE, ON = np.uint8(0), np.uint8(1), np.uint8(2)

_miss = np.array((np.inf, 0, 0, no_primitive), hit_dtype)
_nowhere = np.array((np.inf, 0, 0, 0, no_primitive), closest_point_dtype)


class _Tree:
    """What both trees answer.

    Rays: an array of ray_dtype, as rays() makes, or floats in an axis of six (origin, direction) or eight (origin,
    tmin, direction, tmax); any shape before that. Points: floats (..., 3). Answers have the shape of rays or points.

    active: booleans of that shape, which elements take part; answers of others are left alone in `out`, else those of
    a miss. threads: 0 all cores, n at most n. out: an array of the answers' type and shape to write to.

    TypeError for an array or argument of the wrong type, ValueError for a wrong shape or value, as in NumPy.
    """

    def __init__(self, tree):
        self._tree = tree

    def closest(self, rays, *, out=None, active=None, after=None, test="exact", grade="reproducible", mode="automatic",
                hint="none", threads=0):
        """Hits: the nearest hit of each ray, of equal t the least primitive.

        By the test exact the answers are those of exact arithmetic, t, u and v rounded once (0.5 ULP), the same bytes
        on every path, tree and number of threads. after: Hits; for each ray the hit behind which the next one is asked
        for, in the order of t and then of primitives. test, grade, mode and hint are names of the C++ enumerators
        TriangleTest, Grade, TraversalMode and BatchHint.
        """
        given, shape = ray_rows(rays)
        answer = Answer(out, shape, hit_dtype, (given,), None if active is None else _miss, strided=True)
        self._tree.closest(given, answer.rows, _how(test, grade, mode, hint, threads), packed(active, shape),
                           None if after is None else _after(after, answer, out, shape))
        return answer.finish(Hits)

    def occluded(self, rays, *, out=None, active=None, test="exact", grade="reproducible", mode="automatic",
                 hint="none", threads=0):
        """bool: whether anything lies within each ray's segment."""
        given, shape = ray_rows(rays)
        answer = Answer(out, shape, np.dtype(bool), (given,), None if active is None else False)
        self._tree.occluded(given, answer.rows.view(np.uint8), _how(test, grade, mode, hint, threads),
                            packed(active, shape))
        return answer.finish()

    def occluded_from(self, origin, points, *, start=0.0, end=1 - 2.0**-12, out=None, active=None, test="exact",
                      grade="reproducible", mode="automatic", hint="none", threads=0):
        """bool: whether anything lies between the point `origin`, a light say, and each of the points.

        origin: (3,) floats. start, end: which part of the segment counts, as shares of its length from the origin on;
        by default not what is next to the point, where the surface is that it lies on. Fastest of all shadows.
        """
        given, shape = rows("points", points, 3)
        light = vertices_of("origin", np.reshape(origin, (1, -1)))[0]
        answer = Answer(out, shape, np.dtype(bool), (given,), None if active is None else False)
        self._tree.occluded_from(light, given, answer.rows.view(np.uint8),
                                 (real("start", start), real("end", end)), _how(test, grade, mode, hint, threads),
                                 packed(active, shape))
        return answer.finish()

    def all_hits(self, rays, *, max_count=None, active=None, threads=0):
        """Lists of Hits: every hit of each ray once, in the order of t and then of primitives; `max_count` of them."""
        return self._lists(self._tree.all_hits, Hits, hit_dtype, rays, max_count, active, threads)

    def crossings(self, rays, *, max_count=None, active=None, threads=0):
        """Lists of Crossings: each passage through the surface once, also at edges and vertices, by simulation of
        simplicity (Edelsbrunner, Mücke 1990); a closed mesh is entered as often as it is left."""
        return self._lists(self._tree.crossings, Crossings, crossing_dtype, rays, max_count, active, threads)

    def count_crossings(self, rays, *, out=None, active=None, threads=0):
        """count_dtype: how many crossings each ray has, and the sum of their sides."""
        given, shape = ray_rows(rays)
        answer = Answer(out, shape, count_dtype, (given,), None if active is None else np.zeros((), count_dtype))
        self._tree.count_crossings(given, answer.rows, chosen(), threads_of(threads), packed(active, shape))
        return answer.finish()

    def locate(self, points, *, rule="parity", out=None, active=None, threads=0):
        """uint8: OUTSIDE, INSIDE or ON for each point, exactly.

        rule: "parity", or "nonzero" for solids that overlap or are nested. Of meshes with open edges, see
        closed_report(), their answers depend on the direction that a point's ray takes: "vote" asks six, for up to six
        times the cost. Points that are not finite are outside.
        """
        given, shape = rows("points", points, 3)
        answer = Answer(out, shape, np.dtype(np.uint8), (given,), None if active is None else OUTSIDE)
        self._tree.locate(given, answer.rows, word("rule", rule), chosen(), threads_of(threads), packed(active, shape))
        return answer.finish()

    def inside(self, points, *, rule="parity", threads=0):
        """bool: whether each point is inside or on the surface; see locate()."""
        return self.locate(points, rule=rule, threads=threads) != OUTSIDE

    def closest_points(self, points, *, max_distance=np.inf, out=None, active=None, threads=0):
        """ClosestPoints: the closest point of the triangles to each point, of equal distances the least primitive.

        Distances are computed in double from the floats, the same bytes on every path and tree; with M the distance to
        the triangle's farthest corner distance_squared is off by at most 2^-46 * M^2. Triangles farther away than
        max_distance do not count. Nothing is close to a point that is not finite.
        """
        given, shape = rows("points", points, 3)
        answer = Answer(out, shape, closest_point_dtype, (given,), None if active is None else _nowhere)
        self._tree.closest_points(given, answer.rows, real("max_distance", max_distance), chosen(),
                                  threads_of(threads), packed(active, shape))
        return answer.finish(ClosestPoints)

    def signed_distances(self, points, *, rule="parity", max_distance=np.inf, out=None, active=None, threads=0):
        """float32: how far each point is from the surface, negative inside, rounded once.

        The sign is that of locate(): 0 on a triangle and nowhere else. Infinite, with the sign of its side, where
        nothing is within max_distance, as of an empty mesh.
        """
        given, shape = rows("points", points, 3)
        answer = Answer(out, shape, np.dtype(np.float32), (given,), None if active is None else np.float32(np.inf))
        self._tree.signed_distances(given, answer.rows, word("rule", rule), real("max_distance", max_distance),
                                    chosen(), threads_of(threads), packed(active, shape))
        return answer.finish()

    @property
    def bounds(self):
        """(2, 3) float32: the least and the greatest coordinates; inf and -inf of no triangles."""
        return np.array(self._tree.bounds(), np.float32)

    @property
    def nbytes(self):
        """The bytes of nodes and leaves."""
        return self._tree.nbytes()

    def report(self):
        """dict: nodes, leaves, bytes, depth, sah_cost and seconds of the build, as of the C++ reports."""
        return self._tree.report()

    def save(self, file):
        """Writes the tree to a path or a file opened for bytes; load() reads it on any machine."""
        if hasattr(file, "write"):
            file.write(self._tree.to_bytes())
        else:
            with open(file, "wb") as opened:
                opened.write(self._tree.to_bytes())

    @classmethod
    def load(cls, file):
        """The tree of a path or a file opened for bytes, which is read to its end. ValueError if it is none, was cut or
        damaged; no bytes whatsoever make a tree that faults."""
        if hasattr(file, "read"):
            return cls._of_bytes(file.read())
        return cls._of_bytes(np.fromfile(os.fspath(file), np.uint8))

    @classmethod
    def _of_bytes(cls, data):
        made = cls.__new__(cls)
        _Tree.__init__(made, cls._native_tree.from_bytes(data))
        return made

    def __reduce_ex__(self, protocol):
        data = self._tree.to_bytes()
        return type(self)._of_bytes, (PickleBuffer(data) if protocol >= 5 else data,)

    def __repr__(self):
        report = self.report()
        return (f"<raylanes.{type(self).__name__} of {report['triangles']} triangles, {report['builder']}, "
                f"{report['bytes']} bytes>")

    @staticmethod
    def _lists(query, kind, dtype, rays, max_count, active, threads):
        given, shape = ray_rows(rays)
        if len(shape) != 1:
            raise ValueError(f"rays: lists are of rays in one dimension, the shape is {shape}")
        limit = 0xFFFFFFFF if max_count is None else count("max_count", max_count, 0xFFFFFFFF)
        offsets, items = query(given, limit, chosen(), threads_of(threads), packed(active, shape))
        return Lists(offsets.view(np.int64), items.view(dtype).view(kind))


class Bvh(_Tree):
    """A bounding volume hierarchy over triangles.

    vertices: (n, 3) floats, finite. faces: (m, 3) integers, rows of vertices; row i is the primitive i of hits.
    builder: "binned_sah"; "sweep_sah", "spatial_splits" (many rays, long triangles), "morton" (built fastest),
    "median", "equal_partition"; "auto" takes what suits the mesh and `rays`, the number to come (0: many), and
    report()["choice"] says why. threads: of the build; 0 all cores. optimize: moves parts of the tree to where they
    cost less, for many rays. The hits are the same whatever these say. The tree keeps nothing of the arrays. ValueError
    for an index that is no vertex, a coordinate that is NaN or infinite (as float32), more than 2^28 triangles.

    One tree may be asked by many threads at a time; a refit waits for them.
    """

    _native_tree = _native.Bvh

    def __init__(self, vertices, faces, *, builder="binned_sah", threads=0, optimize=False, rays=0):
        super().__init__(_native.Bvh(vertices_of("vertices", vertices), faces_of(faces), word("builder", builder),
                                     threads_of(threads), flag("optimize", optimize), real("rays", rays, np.float64)))

    def refit(self, vertices, faces, *, threads=0):
        """Makes this the tree of another mesh with as many triangles, as of the same one in motion, far faster than a
        build; see decay()."""
        self._tree.refit(vertices_of("vertices", vertices), faces_of(faces), threads_of(threads))

    def sah_cost(self) -> float:
        """What a line that meets bounds is expected to cost, in visits of nodes."""
        return self._tree.sah_cost()

    def decay(self) -> float:
        """sah_cost() by that of the last build: 1.5 if tracing is expected to take one and a half times as long by now.
        """
        return self._tree.decay()


class KdTree(_Tree):
    """Space divided by planes: the same answers as of Bvh, another tree.

    builder: "sah" or "midpoint"; all else as of Bvh.
    """

    _native_tree = _native.KdTree

    def __init__(self, vertices, faces, *, builder="sah", threads=0):
        super().__init__(_native.KdTree(vertices_of("vertices", vertices), faces_of(faces), word("builder", builder),
                                        threads_of(threads)))


def _how(test, grade, mode, hint, threads):
    """The options of a trace as the native module takes them."""
    names = zip(("test", "grade", "mode", "hint"), (test, grade, mode, hint))
    return *(word(*named) for named in names), chosen(), threads_of(threads)


def _after(after, answer, out, shape):
    """The rows of hits behind which the next are asked for: those of `out` itself, or apart from it."""
    hits = np.asarray(after)
    if hits.dtype != hit_dtype:
        raise TypeError(f"after: records of raylanes.hit_dtype are needed, not {hits.dtype}")
    if hits.shape != shape:
        raise ValueError(f"after: the shape must be {shape}, it is {hits.shape}")
    if after is out:
        return answer.rows
    hits = hits.reshape(-1)
    return hits.copy() if overlap(hits, answer.rows) or hits.size > 1 > hits.strides[0] else hits
