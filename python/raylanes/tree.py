"""Trees over triangles."""

import numpy as np

from . import _native
from ._arrays import faces_of, vertices_of
from ._point_queries import PointQueries
from ._ray_queries import RayQueries
from ._scalars import flag, real, threads_of, word
from ._stored_tree import StoredTree
from ._warn import warn


class _Tree(RayQueries, PointQueries, StoredTree):
    """The base of Bvh and KdTree."""

    def __init__(self, tree, faces):
        self._tree = tree
        left_out = tree.left_out()
        if left_out:
            warn(f"{left_out} of {len(faces)} triangles have two equal corners and are left out: nothing hits them")


class Bvh(_Tree):
    """A bounding volume hierarchy over triangles.

    Results do not depend on the builder, on optimize or on threads. The tree keeps nothing of the arrays. Many threads
    may query one tree at the same time, also during refit(): a query keeps the mesh that it began with. A tree is
    copied and pickled with its attributes, like any object; copies share memory until one of them is refitted.

    In a process that was forked after its parent had used several threads, calls use one.

    Rays and points may have any shape before their last axis; results have that shape. Numbers are float32: other types
    are converted. Arrays and options of a wrong type raise TypeError, wrong shapes and values raise ValueError. If
    memory runs out, calls raise MemoryError. Elements of `out` must not overlap each other. `out` may overlap the
    input.

    Parameters
    ----------
    vertices : array of float, shape (n, 3)
        Finite coordinates in vertices that a face uses.
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
        If a face has an index that is no vertex or a vertex that is not finite as a float32, or there are more than
        2^28 triangles.

    Warns
    -----
    MeshWarning
        If triangles have two equal corners: they are left out, and nothing hits them.

    Examples
    --------
    >>> import numpy as np, raylanes
    >>> tree = raylanes.Bvh([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> tree.closest(raylanes.rays([[0, 0, 5]], [[0, 0, -1]])).t
    array([5.], dtype=float32)
    """

    _native_tree = _native.Bvh

    def __init__(self, vertices, faces, *, builder="binned_sah", threads=0, optimize=False, rays=0):
        faces = faces_of(faces)
        super().__init__(_native.Bvh(vertices_of("vertices", vertices), faces, word("builder", builder),
                                     threads_of(threads), flag("optimize", optimize), real("rays", rays, np.float64)),
                         faces)

    def refit(self, vertices, faces, *, threads=0):
        """Make this the tree of another mesh with as many triangles, such as the same mesh in motion.

        This is far faster than a build; decay() says when to build again. If it raises, the tree is unchanged. It
        waits for no query. It works in place if no copy shares the tree's memory and the program has one thread;
        otherwise it takes the memory of another tree until the last query of the old one ends.

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
        Finite coordinates in vertices that a face uses.
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
        faces = faces_of(faces)
        super().__init__(_native.KdTree(vertices_of("vertices", vertices), faces, word("builder", builder),
                                        threads_of(threads)), faces)
