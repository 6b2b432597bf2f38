"""Trees over triangles and their queries."""

import io
from pickle import PickleBuffer

import numpy as np

from . import _native
from .answer import Answer, overlap
from .arrays import (closest_point_dtype, count_dtype, crossing_dtype, faces_of, hit_dtype, no_primitive, packed,
                     ray_rows, rows, vertices_of)
from .files import write_whole
from .hits import ClosestPoints, Crossings, Hits, Lists
from .paths import chosen
from .scalars import bytes_of, count, flag, path_of, real, threads_of, word

OUTSIDE, INSIDE, ON = np.uint8(0), np.uint8(1), np.uint8(2)

_miss = np.array((np.inf, 0, 0, no_primitive), hit_dtype)
_nowhere = np.array((np.inf, 0, 0, 0, no_primitive), closest_point_dtype)


class _Tree:
    """The queries that Bvh and KdTree share."""

    def __init__(self, tree):
        self._tree = tree

    def closest(self, rays, *, out=None, active=None, after=None, test="exact", grade="reproducible", mode="automatic",
                hint="none", facing="any", threads=0):
        """Find the nearest hit of each ray.

        Ties in t go to the lowest primitive. By the test "exact" the result is that of exact arithmetic, with t, u and
        v rounded once (0.5 ULP). Its bytes do not depend on tree, ISA path, mode or number of threads.

        Parameters
        ----------
        rays : array
            Records of ray_dtype, as rays() makes; or floats (..., 6): origin, direction; or floats (..., 8): origin,
            tmin, direction, tmax.
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are misses.
        after : Hits, optional
            For each ray a hit: the result is the next one behind it, in the order of t, then of primitives.
        test : {"exact", "watertight", "moller_trumbore", "plane_edges", "plane_edges_plain"}, default "exact"
            How a ray is tested against a triangle; see TriangleTest of the C++ headers.
        grade : {"reproducible", "fast"}, default "reproducible"
            The promise of tests other than "exact" about their bits.
        mode : {"automatic", "single", "packet", "stream"}, default "automatic"
            How rays share vectors. Hits by "exact" do not depend on it.
        hint : {"none", "shared_origin", "shared_end", "coherent", "incoherent"}, default "none"
            Your knowledge about the batch. A wrong hint costs time, not hits.
        facing : {"any", "front", "back"}, default "any"
            The sides of triangles that count, by the test "exact". From the front the corners run counter-clockwise: a
            ray enters a solid whose normals point outwards. At the back it leaves such a solid.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        Hits
            One hit for each ray, in the shape of rays.

        Raises
        ------
        TypeError, ValueError
            If an array or option has a wrong type; if it has a wrong shape or value.

        Examples
        --------
        >>> hits = tree.closest(raylanes.rays([[0, 0, 5], [9, 0, 5]], [0, 0, -2]))
        >>> hits.hit, hits.t
        (array([ True, False]), array([2.5, inf], dtype=float32))
        """
        given, shape = ray_rows(rays)
        answer = Answer(out, shape, hit_dtype, (given,), None if active is None else _miss, strided=True)
        self._tree.closest(given, answer.rows, _how(test, grade, mode, hint, facing, threads), packed(active, shape),
                           None if after is None else _after(after, answer, out, shape))
        return answer.finish(Hits)

    def occluded(self, rays, *, out=None, active=None, test="exact", grade="reproducible", mode="automatic",
                 hint="none", facing="any", threads=0):
        """Find out whether the segment of each ray hits anything.

        Parameters
        ----------
        rays : array
            As in closest().
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.
        test : {"exact", "watertight", "moller_trumbore", "plane_edges", "plane_edges_plain"}, default "exact"
            How a ray is tested against a triangle; see TriangleTest of the C++ headers.
        grade : {"reproducible", "fast"}, default "reproducible"
            The promise of tests other than "exact" about their bits.
        mode : {"automatic", "single", "packet", "stream"}, default "automatic"
            How rays share vectors. Hits by "exact" do not depend on it.
        hint : {"none", "shared_origin", "shared_end", "coherent", "incoherent"}, default "none"
            Your knowledge about the batch. A wrong hint costs time, not hits.
        facing : {"any", "front", "back"}, default "any"
            The sides of triangles that count, by the test "exact". From the front the corners run counter-clockwise: a
            ray enters a solid whose normals point outwards. At the back it leaves such a solid.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ndarray of bool
            True for each ray that hits a triangle with tmin <= t <= tmax, in the shape of rays.

        Examples
        --------
        >>> tree.occluded(raylanes.rays([0, 0, 5], [0, 0, -1], tmax=[4, 5]))
        array([False,  True])
        """
        given, shape = ray_rows(rays)
        answer = Answer(out, shape, np.dtype(bool), (given,), None if active is None else False)
        self._tree.occluded(given, answer.rows.view(np.uint8), _how(test, grade, mode, hint, facing, threads),
                            packed(active, shape))
        return answer.finish()

    def occluded_from(self, origin, points, *, start=0.0, end=1 - 2.0**-12, out=None, active=None, test="exact",
                      grade="reproducible", mode="automatic", hint="none", facing="any", threads=0):
        """Find out whether anything lies between one point, such as a light, and each of many points.

        This is the fastest way to trace shadows.

        Parameters
        ----------
        origin : array of float, shape (3,)
            The point that all segments share.
        points : array of float, shape (..., 3)
            The other ends.
        start, end : float
            The part of each segment to test, as shares of its length from `origin` on. By default it ends just before
            the point, which usually lies on a surface.
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.
        test : {"exact", "watertight", "moller_trumbore", "plane_edges", "plane_edges_plain"}, default "exact"
            How a ray is tested against a triangle; see TriangleTest of the C++ headers.
        grade : {"reproducible", "fast"}, default "reproducible"
            The promise of tests other than "exact" about their bits.
        mode : {"automatic", "single", "packet", "stream"}, default "automatic"
            How rays share vectors. Hits by "exact" do not depend on it.
        hint : {"none", "shared_origin", "shared_end", "coherent", "incoherent"}, default "none"
            Your knowledge about the batch. A wrong hint costs time, not hits.
        facing : {"any", "front", "back"}, default "any"
            The sides of triangles that count, by the test "exact". From the front the corners run counter-clockwise: a
            ray enters a solid whose normals point outwards. At the back it leaves such a solid.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ndarray of bool
            True for each point in shadow, in the shape of points without their last axis.

        Examples
        --------
        >>> tree.occluded_from([0, 0, 5], [[0, 0, -5], [9, 0, -5]])
        array([ True, False])
        """
        given, shape = rows("points", points, 3)
        light = vertices_of("origin", np.reshape(origin, (1, -1)))[0]
        answer = Answer(out, shape, np.dtype(bool), (given,), None if active is None else False)
        self._tree.occluded_from(light, given, answer.rows.view(np.uint8),
                                 (real("start", start), real("end", end)),
                                 _how(test, grade, mode, hint, facing, threads), packed(active, shape))
        return answer.finish()

    def all_hits(self, rays, *, max_count=None, facing="any", active=None, threads=0):
        """Find every hit of each ray, once, in the order of t, then of primitives.

        Parameters
        ----------
        rays : array
            As in closest(), in one dimension.
        max_count : int, optional
            Keep the first so many hits of each ray.
        facing : {"any", "front", "back"}, default "any"
            Keep the hits of these sides only, as in closest().
        active : array of bool, optional
            The active rays; the others have no hits.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        Lists
            The Hits of each ray.

        Examples
        --------
        >>> lists = tree.all_hits(raylanes.rays([[0, 0, 5], [9, 0, 5]], [0, 0, -2]))
        >>> len(lists), lists.counts
        (2, array([1, 0]))
        >>> lists[0].t
        array([2.5], dtype=float32)
        """
        return self._lists(self._tree.all_hits, Hits, hit_dtype, rays, max_count, facing, active, threads)

    def crossings(self, rays, *, max_count=None, facing="any", active=None, threads=0):
        """Find each crossing of a ray and the surface, once, also at edges and vertices.

        Simulation of simplicity decides there (Edelsbrunner, Mücke 1990): a ray leaves a closed mesh as often as it
        enters it.

        Parameters
        ----------
        rays, max_count, active, threads
            As in all_hits().
        facing : {"any", "front", "back"}, default "any"
            Keep crossings of these sides only: of the front, side is -1; of the back, 1.

        Returns
        -------
        Lists
            The Crossings of each ray, in the order of t, then of primitives.

        Examples
        --------
        >>> tree.crossings(raylanes.rays([[0, 0, 5]], [0, 0, -1]))[0].side
        array([-1], dtype=int32)
        """
        return self._lists(self._tree.crossings, Crossings, crossing_dtype, rays, max_count, facing, active, threads)

    def count_crossings(self, rays, *, facing="any", out=None, active=None, threads=0):
        """Count the crossings of each ray, and add up their sides.

        Parameters
        ----------
        rays : array
            As in closest().
        facing : {"any", "front", "back"}, default "any"
            Count crossings of these sides only, as in crossings().
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array their counts are 0.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ndarray of count_dtype
            The fields crossings and winding, in the shape of rays.

        Examples
        --------
        >>> tree.count_crossings(raylanes.rays([[0, 0, 5]], [0, 0, -1]))["winding"]
        array([-1], dtype=int32)
        """
        given, shape = ray_rows(rays)
        answer = Answer(out, shape, count_dtype, (given,), None if active is None else np.zeros((), count_dtype))
        self._tree.count_crossings(given, answer.rows, word("facing", facing), chosen(), threads_of(threads),
                                   packed(active, shape))
        return answer.finish()

    def locate(self, points, *, rule="parity", out=None, active=None, threads=0):
        """Find out whether each point is inside, outside or on the surface, exactly.

        Parameters
        ----------
        points : array of float, shape (..., 3)
            Points that are not finite are outside.
        rule : {"parity", "nonzero", "vote", "winding"}, default "parity"
            "parity": a ray from the point crosses the surface an odd number of times. "nonzero": the sides of the
            crossings do not add up to 0, for solids that overlap or are nested. "winding": the winding number is 1/2
            or more, for meshes with holes or faces turned over; see winding_numbers(). "vote": four of six rays agree,
            in up to six times the time. See closed_report().
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are OUTSIDE.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ndarray of uint8
            OUTSIDE, INSIDE or ON for each point.

        Examples
        --------
        >>> tree.locate([[0, 0, 0], [0, 0, 1]])
        array([2, 0], dtype=uint8)
        """
        given, shape = rows("points", points, 3)
        answer = Answer(out, shape, np.dtype(np.uint8), (given,), None if active is None else OUTSIDE)
        self._tree.locate(given, answer.rows, word("rule", rule), chosen(), threads_of(threads), packed(active, shape))
        return answer.finish()

    def inside(self, points, *, rule="parity", threads=0):
        """Find out whether each point is inside or on the surface.

        Parameters
        ----------
        points, rule, threads
            As in locate().

        Returns
        -------
        ndarray of bool
            True for each point that is INSIDE or ON.

        Examples
        --------
        >>> tree.inside([[0, 0, 0], [0, 0, 1]])
        array([ True, False])
        """
        return self.locate(points, rule=rule, threads=threads) != OUTSIDE

    def winding_numbers(self, points, *, accuracy=1e-6, out=None, active=None, threads=0):
        """Compute the generalised winding number of each point: how often the mesh winds around it.

        It is the sum of the solid angles of all triangles, seen from the point, over 4 pi. Closed meshes have whole
        numbers, exactly: 1 inside and 0 outside. Meshes with holes have numbers between, without a jump at the hole.

        Parameters
        ----------
        points : array of float, shape (..., 3)
            Points that are not finite have 0.
        accuracy : float, default 1e-6
            The greatest error of expansions of far parts of the boundary; 0: no expansions. The larger, the faster.
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are 0.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ndarray of float32
            One number for each point.

        Notes
        -----
        Jacobson, Kavan, Sorkine-Hornung, 2013: Robust inside-outside segmentation using generalized winding numbers.

        Examples
        --------
        >>> tree.winding_numbers([[0, 0, -0.25], [0, 0, 0.25]]).round(3)
        array([ 0.324, -0.324], dtype=float32)
        """
        given, shape = rows("points", points, 3)
        answer = Answer(out, shape, np.dtype(np.float32), (given,), None if active is None else np.float32(0))
        self._tree.winding_numbers(given, answer.rows, real("accuracy", accuracy, np.float64), chosen(),
                                   threads_of(threads), packed(active, shape))
        return answer.finish()

    def closest_points(self, points, *, max_distance=np.inf, out=None, active=None, threads=0):
        """Find the closest point of the triangles to each point.

        Ties go to the lowest primitive. Distances are computed in double, with the same bytes on every ISA path and in
        every tree. With M the distance to the triangle's farthest corner, distance_squared is off by at most
        2^-46 * M^2.

        Parameters
        ----------
        points : array of float, shape (..., 3)
            If a point is not finite, there is no closest point.
        max_distance : float, default inf
            Triangles farther away are ignored.
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array
            there is no closest point.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ClosestPoints
            One for each point.

        Examples
        --------
        >>> closest = tree.closest_points([[0, 0, 3]])
        >>> closest.distance, closest.point
        (array([3.]), array([[0., 0., 0.]], dtype=float32))
        """
        given, shape = rows("points", points, 3)
        answer = Answer(out, shape, closest_point_dtype, (given,), None if active is None else _nowhere)
        self._tree.closest_points(given, answer.rows, real("max_distance", max_distance), chosen(),
                                  threads_of(threads), packed(active, shape))
        return answer.finish(ClosestPoints)

    def signed_distances(self, points, *, rule="parity", max_distance=np.inf, out=None, active=None, threads=0):
        """Compute how far each point is from the surface, negative inside.

        The sign is exact, as in locate(): the distance is 0 if and only if the point is on a triangle.

        Parameters
        ----------
        points, rule
            As in locate().
        max_distance : float, default inf
            Points farther away get an infinity with the sign of their side: the smaller, the faster.
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are inf.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ndarray of float32
            One distance for each point, rounded once.

        Examples
        --------
        >>> tree.signed_distances([[0, 0, 3], [0, 0, 0]])
        array([3., 0.], dtype=float32)
        """
        given, shape = rows("points", points, 3)
        answer = Answer(out, shape, np.dtype(np.float32), (given,), None if active is None else np.float32(np.inf))
        self._tree.signed_distances(given, answer.rows, word("rule", rule), real("max_distance", max_distance),
                                    chosen(), threads_of(threads), packed(active, shape))
        return answer.finish()

    @property
    def bounds(self):
        """ndarray of float32, shape (2, 3): the least and greatest coordinates; inf and -inf without triangles."""
        return np.array(self._tree.bounds(), np.float32)

    @property
    def nbytes(self):
        """int: the bytes of nodes and leaves."""
        return self._tree.nbytes()

    def report(self):
        """Describe the tree and its build.

        Returns
        -------
        dict
            nodes, leaves, bytes, depth, sah_cost, seconds of each part of the build and more: the members of the C++
            structures TreeReport and KdReport.

        Examples
        --------
        >>> tree.report()["triangles"]
        1
        """
        return self._tree.report()

    def save(self, file):
        """Write the tree to a file; load() reads it on any machine.

        A file at a path is replaced when the new one is complete: if this raises, the old file is unchanged.

        Parameters
        ----------
        file : str, os.PathLike or file object
            A path, or a file opened for writing bytes.

        Returns
        -------
        None
        """
        if hasattr(file, "write"):
            if isinstance(file, io.TextIOBase):
                raise TypeError(f"file: a file opened for writing bytes is needed, not {type(file).__name__}")
            file.write(self._tree.to_bytes())
        else:
            write_whole(path_of("file", file), self._tree.to_bytes())

    @classmethod
    def load(cls, file):
        """Read a tree that save() wrote. No bytes make a tree that faults.

        Parameters
        ----------
        file : str, os.PathLike or file object
            A path, or a file opened for reading bytes, which is read to its end.

        Returns
        -------
        Bvh or KdTree
            The tree, of the class that load() is called on.

        Raises
        ------
        ValueError
            If the bytes are no such tree, cut or damaged.
        TypeError
            If `file` is neither a path nor a file opened for reading bytes.
        """
        if hasattr(file, "read"):
            return cls._of_bytes(file.read())
        return cls._of_bytes(np.fromfile(path_of("file", file), np.uint8))

    @classmethod
    def _of_bytes(cls, data):
        made = cls.__new__(cls)
        _Tree.__init__(made, cls._native_tree(bytes_of("file", data)))
        return made

    def __reduce_ex__(self, protocol):
        data = self._tree.to_bytes()
        return type(self)._of_bytes, (PickleBuffer(data) if protocol >= 5 else data,)

    def __repr__(self):
        report = self.report()
        return (f"<raylanes.{type(self).__name__} of {report['triangles']} triangles, {report['builder']}, "
                f"{report['bytes']} bytes>")

    @staticmethod
    def _lists(query, kind, dtype, rays, max_count, facing, active, threads):
        given, shape = ray_rows(rays)
        if len(shape) != 1:
            raise ValueError(f"rays: lists are of rays in one dimension, the shape is {shape}")
        limit = 0xFFFFFFFF if max_count is None else count("max_count", max_count, 0xFFFFFFFF)
        offsets, items = query(given, limit, word("facing", facing), chosen(), threads_of(threads),
                               packed(active, shape))
        return Lists(offsets.view(np.int64), items.view(dtype).view(kind))


class Bvh(_Tree):
    """A bounding volume hierarchy over triangles.

    Results do not depend on the builder, on optimize or on threads. The tree keeps nothing of the arrays. Many threads
    may query one tree at the same time; refit() waits for them.

    Rays and points may have any shape before their last axis; results have that shape. Numbers are float32: other types
    are converted. Arrays and options of a wrong type raise TypeError, wrong shapes and values raise ValueError. If
    memory runs out, calls raise MemoryError. Elements of `out` must not overlap each other. `out` may overlap the
    input.

    Parameters
    ----------
    vertices : array of float, shape (n, 3)
        Finite coordinates.
    faces : array of int, shape (m, 3)
        Indices of vertices; row i is primitive i of hits.
    builder : {"binned_sah", "sweep_sah", "spatial_splits", "morton", "median", "equal_partition", "auto"}
        How the tree is built. "morton" builds fastest; "spatial_splits" is for many rays and long triangles; "auto"
        chooses by the mesh and `rays`, and report()["choice"] says why. Default "binned_sah".
    threads : int, default 0
        At most so many threads; 0: all cores.
    optimize : bool, default False
        Whether to move subtrees to where they cost less, for many rays.
    rays : float, default 0
        For "auto": about how many rays the tree will trace; 0: many.

    Raises
    ------
    ValueError
        If a face has an index that is no vertex, a coordinate is not finite as a float32, or there are more than 2^28
        triangles.

    Examples
    --------
    >>> import numpy as np, raylanes
    >>> tree = raylanes.Bvh([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> tree.closest(raylanes.rays([[0, 0, 5]], [[0, 0, -1]])).t
    array([5.], dtype=float32)
    """

    _native_tree = _native.Bvh

    def __init__(self, vertices, faces, *, builder="binned_sah", threads=0, optimize=False, rays=0):
        super().__init__(_native.Bvh(vertices_of("vertices", vertices), faces_of(faces), word("builder", builder),
                                     threads_of(threads), flag("optimize", optimize), real("rays", rays, np.float64)))

    def refit(self, vertices, faces, *, threads=0):
        """Make this the tree of another mesh with as many triangles, such as the same mesh in motion.

        This is far faster than a build; decay() says when to build again. If it raises, the tree is unchanged.

        Parameters
        ----------
        vertices, faces, threads
            As in the constructor.

        Returns
        -------
        None

        Raises
        ------
        ValueError
            If the number of triangles differs, or the constructor would raise it.
        """
        self._tree.refit(vertices_of("vertices", vertices), faces_of(faces), threads_of(threads))

    def sah_cost(self) -> float:
        """Compute the cost of the tree by the surface area heuristic.

        Returns
        -------
        float
            The node visits expected for a line that meets the bounds; a leaf counts as 0.9 of one.
        """
        return self._tree.sah_cost()

    def decay(self) -> float:
        """Compute how much worse refits have made the tree.

        Returns
        -------
        float
            sah_cost() divided by that after the last build: 1.5 if tracing is expected to take 1.5 times as long now.
        """
        return self._tree.decay()


class KdTree(_Tree):
    """A k-d tree over triangles: space divided by planes. It returns what a Bvh returns.

    Arrays, threads and exceptions are as in Bvh.

    Parameters
    ----------
    vertices : array of float, shape (n, 3)
        Finite coordinates.
    faces : array of int, shape (m, 3)
        Indices of vertices; row i is primitive i of hits.
    builder : {"sah", "midpoint"}, default "sah"
        How space is divided; "midpoint" is the textbook form, for comparison.
    threads : int, default 0
        At most so many threads; 0: all cores.

    Examples
    --------
    >>> import numpy as np, raylanes
    >>> tree = raylanes.KdTree([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> tree.closest(raylanes.rays([[0, 0, 5]], [[0, 0, -1]])).t
    array([5.], dtype=float32)
    """

    _native_tree = _native.KdTree

    def __init__(self, vertices, faces, *, builder="sah", threads=0):
        super().__init__(_native.KdTree(vertices_of("vertices", vertices), faces_of(faces), word("builder", builder),
                                        threads_of(threads)))


def _how(test, grade, mode, hint, facing, threads):
    """The options of a trace as the native module takes them."""
    names = zip(("test", "grade", "mode", "hint"), (test, grade, mode, hint))
    return *(word(*named) for named in names), chosen(), threads_of(threads), word("facing", facing)


def _after(after, answer, out, shape):
    """The rows of hits behind which the next are asked for: rows of `out` itself, or a copy."""
    hits = np.asarray(after)
    if hits.dtype != hit_dtype:
        raise TypeError(f"after: records of raylanes.hit_dtype are needed, not {hits.dtype}")
    if hits.shape != shape:
        raise ValueError(f"after: the shape must be {shape}, it is {hits.shape}")
    if after is out:
        return answer.rows
    hits = hits.reshape(-1)
    return hits.copy() if overlap(hits, answer.rows) or hits.size > 1 > hits.strides[0] else hits
