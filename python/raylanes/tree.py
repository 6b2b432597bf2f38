"""Trees over triangles."""

import numpy as np

from . import _native
from ._arrays import (DOUBLES, FLOATS, changes, equal_corners, faces_of, numbers, numbers_for, require_kept,
                      vertices_of)
from ._meshes import parts_of, warn
from ._point_queries import PointQueries
from ._ray_queries import RayQueries
from ._scalars import flag, function, real, threads_of, word
from ._stored import StoredTree


class _Tree(RayQueries, PointQueries, StoredTree):
    """The base of Bvh and KdTree."""

    # given: the vertices of the caller; vertices: the same as numbers of the tree. This is no docstring, because help()
    # would show that under the constructors of Bvh and KdTree.
    def __init__(self, tree, given, vertices, faces):
        self._tree = tree
        left_out = tree.left_out()
        if left_out:
            self._look_for_lost(given, vertices, faces)
            lost = self._rounded_away
            kept = not changes(np.asarray(given), np.asarray(given, np.float64))
            warn(f"{left_out} of {len(faces)} triangles have two equal corners"
                 + (f", {lost} of them by rounding to {vertices.dtype}," if lost else "")
                 + " and are left out: nothing hits them"
                 + ("; a Bvh with dtype=numpy.float64 keeps those" if lost and kept else ""))

    def _look_for_lost(self, given, vertices, faces):
        """Counts triangles whose corners became equal by rounding."""
        given = np.asarray(given)
        self._rounded_away = 0
        if len(faces) and changes(given, vertices):
            lost = equal_corners(vertices, faces)
            self._rounded_away = max(0, lost and lost - equal_corners(given.reshape(vertices.shape), faces))


class Bvh(_Tree):
    """A bounding volume hierarchy over triangles.

    Results do not depend on the builder, on optimize or on threads. The tree keeps nothing of the arrays. Many threads
    may query one tree at the same time, also during refit(): a query keeps the mesh that it began with. A tree is
    copied and pickled with its attributes, like any object; copies share memory until one of them is refitted.

    In a process that was forked after its parent had used several threads, calls use one.

    The tree keeps the vertices that it is given: vertices of float64 or integers make a tree of float64, vertices of
    float32 or float16 one of float32. `dtype` asks for another type, and tree.dtype says which one the tree has. Rays
    and points are converted to that type, and t, u, v and positions have it.

    Rays and points may have any shape before their last axis; results have that shape. Arrays and options of a wrong
    type raise TypeError, wrong shapes and values raise ValueError. If memory runs out, calls raise MemoryError.
    Elements of `out` must not overlap each other. `out` may overlap the input.

    Ctrl-C, or another signal whose handler raises, ends a build or a query on the main thread within about 0.2 s. The
    tree of a query stays as it is. Active elements of `out` hold their result or what they held before, each of them.

    A tree of float64 has no test but "exact", and is not built by "spatial_splits": these raise ValueError.
    dtype=numpy.float32 makes a tree that has them.

    Parameters
    ----------
    vertices : array of float, shape (n, 3), or a mesh
        Finite coordinates in vertices that a face uses. A mesh in place of vertices and faces is any object with
        `vertices` and `faces`, such as trimesh's, or a triangle mesh of Open3D.
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
    dtype : {numpy.float32, numpy.float64}, optional
        The type of the tree's numbers. By default the type that keeps the vertices. float32 rounds each coordinate to
        nearest, with a relative error of at most 2^-24.
    progress : function, optional
        Called with the share of the build that is done, from 0 to 1. An exception ends the build.

    Raises
    ------
    ValueError
        If a face has an index that is no vertex or a vertex that is not finite in the tree's type. If there are more
        than 2^28 triangles. If a tree of float64 should have the builder "spatial_splits".

    Warns
    -----
    MeshWarning
        If triangles have two equal corners, also by rounding to float32: they are left out, and nothing hits them.
        If float64 does not hold the vertices, such as integers beyond 2^53, and dtype is not given.

    Examples
    --------
    >>> import numpy as np, raylanes
    >>> tree = raylanes.Bvh([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> tree.closest(raylanes.rays([[0, 0, 5]], [[0, 0, -1]])).t
    array([5.])
    """

    _native_tree, _natives = _native.Bvh, {b"raylanes doub": _native.BvhD}
    _rounds = False  # whether dtype asked for the rounding of vertices

    def __init__(self, vertices, faces=None, *, builder="binned_sah", threads=0, optimize=False, rays=0, dtype=None,
                 progress=None):
        vertices, faces = parts_of(vertices, faces)
        faces, given = faces_of(faces), numbers("vertices", vertices)
        kind = numbers_for(dtype, given)
        self._rounds = dtype is not None
        if kind is DOUBLES and builder == "spatial_splits":
            raise ValueError('builder: "spatial_splits" is for trees of dtype=numpy.float32, this one has float64')
        of_tree = vertices_of("vertices", given, kind.real)
        self._warn_of_rounding(given, of_tree)
        native = _native.Bvh if kind is FLOATS else _native.BvhD
        super().__init__(native(of_tree, faces, word("builder", builder), threads_of(threads),
                                flag("optimize", optimize), real("rays", rays, np.float64),
                                function("progress", progress)), given, of_tree, faces)

    def _warn_of_rounding(self, given, of_tree):
        """Warns if integers or long doubles are rounded to float64, and nobody asked for that."""
        if not self._rounds and of_tree.dtype == np.float64 and changes(given.reshape(of_tree.shape), of_tree):
            warn(f"vertices: float64 does not hold these {given.dtype} numbers, and rounds them to nearest. Subtract a "
                 "point near the mesh first, or pass dtype=numpy.float64 if rounding is welcome")

    def refit(self, vertices, faces=None, *, threads=0):
        """Make this the tree of another mesh with as many triangles, such as the same mesh in motion.

        This is far faster than a build; decay() says when to build again. If it raises, the tree is unchanged. It
        waits for no query. It works in place if no copy shares the tree's memory and the program has one thread;
        otherwise it takes the memory of another tree until the last query of the old one ends.

        Parameters
        ----------
        vertices, faces, threads
            As in the constructor; the tree keeps its dtype.

        Returns
        -------
        None

        Raises
        ------
        ValueError
            If the number of triangles differs, the constructor would raise it, or a tree of float32 would round the
            vertices and was not made with dtype=numpy.float32.
        """
        vertices, faces = parts_of(vertices, faces)
        faces, given = faces_of(faces), numbers("vertices", vertices)
        of_tree = vertices_of("vertices", given, self.dtype)
        if not self._rounds and self.dtype == np.float32:
            require_kept("vertices", given, of_tree, "the tree has float32: give it vertices of float32")
        self._warn_of_rounding(given, of_tree)
        self._tree.refit(of_tree, faces, threads_of(threads))
        self._look_for_lost(given, of_tree, faces)

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
    vertices : array of float, shape (n, 3), or a mesh
        Finite coordinates in vertices that a face uses; or a mesh as for a Bvh.
    faces : array of int, shape (m, 3)
        Indices of vertices; row i is primitive i of hits.
    builder : {"sah", "midpoint"}, default "sah"
        How space is divided; "midpoint" is the textbook form, for comparison.
    threads : int, default 0
        At most so many threads; 0: all cores.
    dtype : numpy.float32, optional
        Asks for the rounding of vertices to float32, the type of every KdTree. Without it, vertices that float32 does
        not hold raise ValueError.
    progress : function, optional
        Called with the share of the build that is done, from 0 to 1. An exception ends the build.

    Examples
    --------
    >>> import numpy as np, raylanes
    >>> tree = raylanes.KdTree([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> tree.closest(raylanes.rays([[0, 0, 5]], [[0, 0, -1]])).t
    array([5.], dtype=float32)
    """

    _native_tree = _native.KdTree

    def __init__(self, vertices, faces=None, *, builder="sah", threads=0, dtype=None, progress=None):
        vertices, faces = parts_of(vertices, faces)
        faces, given = faces_of(faces), numbers("vertices", vertices)
        if dtype is not None and numbers_for(dtype) is DOUBLES:
            raise ValueError("dtype: a KdTree has float32; a Bvh may have float64")
        of_tree = vertices_of("vertices", given, np.float32)
        if dtype is None:
            require_kept("vertices", given, of_tree, "a KdTree has float32: pass dtype=numpy.float32 to round them")
        super().__init__(_native.KdTree(of_tree, faces, word("builder", builder), threads_of(threads),
                                        function("progress", progress)), given, of_tree, faces)
