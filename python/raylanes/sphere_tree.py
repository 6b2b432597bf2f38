"""Trees over spheres."""

import numpy as np

from . import _native
from ._arrays import DOUBLES, FLOATS, given_rays, numbers, numbers_for, require_kept, vertices_of
from ._scalars import threads_of, word
from ._stored import Copied
from ._traces import filter_of, hits_after, how, nearest, shadows, shadows_from, shadows_towards, skipped
from .hits import Hits


class SphereTree(Copied):
    """A tree over the surfaces of spheres.

    Arrays, threads and exceptions are as in Bvh. The tree has float32, and a copy of its spheres, 16 bytes each. It
    never changes: copies share its memory. A pickle holds the spheres, and builds the tree again where it is loaded.

    The following spheres are never hit: those with a NaN, a negative radius, or a radius whose square overflows, and
    those that reach beyond the largest float. report()["left_out"] counts them.

    Parameters
    ----------
    centres : array of float, shape (n, 3)
        Row i is primitive i of hits.
    radii : array of float, shape (n,), or float
        A radius for each sphere, or one for all of them.
    builder : {"binned_sah", "sweep_sah", "spatial_splits", "morton", "median", "equal_partition"}
        How the tree is built; hits do not depend on it. "spatial_splits" builds as "binned_sah". Default "binned_sah".
    threads : int, default 0
        At most so many threads; 0: all cores.
    dtype : numpy.float32, optional
        Asks for the rounding of centres and radii to float32. Without it, numbers that float32 does not hold raise
        ValueError.

    Examples
    --------
    >>> import numpy as np, raylanes
    >>> spheres = raylanes.SphereTree([[0, 0, 0], [4, 0, 0]], radii=1)
    >>> spheres.closest(raylanes.rays([[4, 0, 5]], [[0, 0, -1]])).t
    array([4.], dtype=float32)
    """

    def __init__(self, centres, radii, *, builder="binned_sah", threads=0, dtype=None):
        given, given_radii = numbers("centres", centres), numbers("radii", radii)
        if dtype is not None and numbers_for(dtype) is DOUBLES:
            raise ValueError("dtype: a SphereTree has float32")
        rows = vertices_of("centres", given, np.float32)
        if given_radii.shape not in ((), (len(rows),)):
            raise ValueError(f"radii: one number or the shape {(len(rows),)} is needed, it is {given_radii.shape}")
        spheres = np.empty((len(rows), 4), np.float32)
        spheres[:, :3], spheres[:, 3] = rows, given_radii
        if dtype is None:
            advice = "a SphereTree has float32: pass dtype=numpy.float32 to round them"
            require_kept("centres", given, rows, advice)
            require_kept("radii", np.broadcast_to(given_radii, (len(rows),)), spheres[:, 3], advice)
        self._tree = _native.SphereTree(spheres, word("builder", builder), threads_of(threads))

    def __len__(self):
        return len(self._spheres)

    @property
    def _spheres(self):
        spheres = self._tree.spheres().view(np.float32).reshape(-1, 4)
        spheres.flags.writeable = False
        return spheres

    @property
    def centres(self):
        """ndarray of float32, shape (n, 3): the centres, read-only."""
        return self._spheres[:, :3]

    @property
    def radii(self):
        """ndarray of float32, shape (n,): the radii, read-only."""
        return self._spheres[:, 3]

    @property
    def bounds(self):
        """ndarray of float32, shape (2, 3): corners of a box around all spheres; inf and -inf without spheres."""
        return np.array(self._tree.bounds(), np.float32)

    @property
    def nbytes(self):
        """int: the bytes of nodes and spheres."""
        return self._tree.nbytes()

    def report(self):
        """Describe the tree.

        Returns
        -------
        dict
            builder; spheres: how many there are; left_out: how many of them are never hit; bytes.

        Examples
        --------
        >>> raylanes.SphereTree([[0, 0, 0], [4, 0, 0]], [1, -1]).report()["left_out"]
        1
        """
        return {"builder": self._tree.builder(), "spheres": len(self), "left_out": self._tree.left_out(),
                "bytes": self.nbytes}

    def closest(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, filter=None, out=None,
                active=None, after=None, skip=None, threads=0, progress=None):
        """Find the nearest surface that each ray meets.

        A ray that begins inside a sphere hits it where it leaves. A sphere has two hits, where a ray enters and leaves
        it: `after` finds one behind the other. Ties in t go to the lowest primitive. The bytes do
        not depend on builder, ISA path or number of threads.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, filter, after, progress
            As in Bvh.closest().
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are misses.
        skip : array of uint32, or hits, optional
            A sphere for each ray, given as in Bvh.closest(). Its hit nearer to tmin is not there, so a ray that begins
            on the sphere and goes inwards hits it where it leaves.
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        Hits
            One hit for each ray, in the shape of rays. `primitive` is the row of the sphere, and u and v are 0.

        Examples
        --------
        >>> spheres = raylanes.SphereTree([[0, 0, 0], [4, 0, 0]], radii=1)
        >>> spheres.closest(raylanes.rays([[0, 0, 5], [4, 0, 0]], [0, 0, -1])).t
        array([4., 1.], dtype=float32)
        >>> spheres.closest(raylanes.rays([[0, 0, 1]], [0, 0, -1]), skip=[0]).t  # from a sphere inwards
        array([2.], dtype=float32)
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = _asked(threads, progress, skip)
        return nearest(FLOATS, Hits, rays, out, active, lambda given, answer, bits: self._tree.closest(
            given, answer.rows, asked, bits, hits_after(after, answer), filter_of(filter, Hits, FLOATS.hit)))

    def occluded(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, filter=None, out=None,
                 active=None, skip=None, threads=0, progress=None):
        """Find out whether the segment of each ray meets the surface of a sphere.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, filter, out, skip, threads, progress
            As in closest().
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each ray that meets a surface with tmin <= t <= tmax, in the shape of rays. A ray that begins and
            ends inside a sphere does not.

        Examples
        --------
        >>> raylanes.SphereTree([[0, 0, 0]], 1).occluded(raylanes.rays([0, 0, 5], [0, 0, -1], tmax=[3, 5]))
        array([False,  True])
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = _asked(threads, progress, skip)
        return shadows(FLOATS, rays, out, active, lambda given, answers, bits: self._tree.occluded(
            given, answers, asked, bits, filter_of(filter, Hits, FLOATS.hit)))

    def occluded_from(self, origin, points, *, start=0.0, end=1.0, filter=None, out=None, active=None, skip=None,
                      threads=0, progress=None):
        """Find out whether the surface of a sphere lies between one point, such as a light, and each of many points.

        Parameters
        ----------
        origin : array of float, shape (3,)
            The point that all segments share.
        points : array of float, shape (..., 3)
            The other ends.
        start, end : float
            As in Bvh.occluded_from(): 0 and 1 by default.
        filter, out, skip, threads, progress
            As in closest().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each point in shadow, in the shape of points without their last axis.

        Examples
        --------
        >>> raylanes.SphereTree([[0, 0, 0]], 1).occluded_from([0, 0, 5], [[0, 0, -5], [9, 0, -5]])
        array([ True, False])
        """
        asked = _asked(threads, progress, skip)
        return shadows_from(FLOATS, origin, points, (start, end), out, active, lambda *given: self._tree.occluded_from(
            *given[:-1], asked, given[-1], filter_of(filter, Hits, FLOATS.hit)))

    def occluded_towards(self, direction, points, *, filter=None, out=None, active=None, skip=None, threads=0,
                         progress=None):
        """Find out whether the surface of a sphere lies in one direction from each of many points.

        Parameters
        ----------
        direction : array of float, shape (3,)
            The direction in which all rays go, of any length, such as that towards the sun.
        points : array of float, shape (..., 3)
            The points where rays begin.
        filter, out, skip, threads, progress
            As in closest().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each point in shadow, in the shape of points without their last axis.

        Examples
        --------
        >>> raylanes.SphereTree([[0, 0, 0]], 1).occluded_towards([0, 0, 1], [[0, 0, -5], [9, 0, -5]])
        array([ True, False])
        """
        asked = _asked(threads, progress, skip)
        return shadows_towards(FLOATS, direction, points, out, active, lambda *given: self._tree.occluded_from(
            *given[:-1], asked, given[-1], filter_of(filter, Hits, FLOATS.hit)))

    def __repr__(self):
        left_out = self._tree.left_out()
        more = f", {left_out} of them never hit" if left_out else ""
        return f"<raylanes.{type(self).__name__} of {len(self)} spheres{more}, {self.nbytes} bytes>"


def _asked(threads, progress, skip):
    return how("exact", "reproducible", "automatic", "none", "any", threads, progress, skipped(skip))
