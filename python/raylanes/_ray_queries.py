"""Queries of rays, which Bvh and KdTree share."""

import numpy as np

from ._arrays import given_rays
from ._meshes import warn_of_sides
from ._traces import (EVERY_BIT, counted, filter_of, hits_after, how, listed, masked, nearest, shadows, shadows_from,
                      shadows_towards, skipped)
from .hits import Crossings, Hits, Stretches


class RayQueries:
    """Queries of rays over `self._tree`, which has `self._numbers`."""

    def _corners_of(self, primitive):
        """(..., 3, 3) float64: the corners of triangles of any shape, NaN for a miss."""
        names = np.ascontiguousarray(primitive, np.uint32).reshape(-1)
        made = np.empty(np.shape(primitive) + (3, 3), self._numbers.real)
        self._tree.corners(names, made.reshape(-1))
        return made.astype(np.float64)

    def _sides(self, facing):
        """The name of the sides that count. Warns if some count, and the mesh is inside out."""
        if isinstance(facing, str) and facing in ("front", "back"):
            warn_of_sides(self._tree, 'a ray enters the solid at "back" and leaves it at "front"')
        return facing

    def _filter(self, filter):
        return filter_of(filter, Hits, self._numbers.hit)

    def closest(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, filter=None, out=None,
                active=None, after=None, test="exact", grade="reproducible", mode="automatic", hint="none",
                facing="any", skip=None, mask=EVERY_BIT, masks=None, filter_mask=EVERY_BIT, threads=0, progress=None):
        """Find the nearest hit of each ray.

        Ties in t go to the lowest primitive. By the test "exact" the result is that of exact arithmetic, with t, u and
        v rounded once (0.5 ULP). Its bytes do not depend on tree, ISA path, mode or number of threads.

        Parameters
        ----------
        rays : array, optional
            Records, as rays() makes; or floats (..., 6): origin, direction; or floats (..., 8): origin,
            tmin, direction, tmax.
        origins, directions : array of float, shape (..., 3), optional
            Rays without records, in place of `rays`. Shapes are broadcast: a shared origin may have the shape (3,).
        tmin, tmax : float or array of float, shape (...), optional
            The ends of these rays, broadcast with them; 0 and inf by default.
        filter : function, optional
            filter(indices, hits) returns a bool for each hit: True rejects it, and its ray goes on behind it. indices
            are rows of the flattened rays, hits are Hits. It is called with batches of hits, on the calling thread.
            The test must be "exact".
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are misses.
        after : Hits, optional
            For each ray a hit: the result is the next one behind it, in the order of t, then of primitives.
        test : {"exact", "watertight", "moller_trumbore"}, default "exact"
            How a ray is tested against a triangle; see TriangleTest of the C++ headers. A tree of float64 has "exact"
            alone.
        grade : {"reproducible", "fast"}, default "reproducible"
            The promise of tests other than "exact" about their bits.
        mode : {"automatic", "single", "packet", "stream"}, default "automatic"
            How rays share vectors. Hits by "exact" do not depend on it.
        hint : {"none", "shared_origin", "shared_end", "coherent", "incoherent"}, default "none"
            Your knowledge about the batch. A wrong hint costs time, not hits.
        facing : {"any", "front", "back"}, default "any"
            The sides of triangles that count, by the test "exact". From the front the corners run counter-clockwise: a
            ray enters a solid whose normals point outwards. At the back it leaves such a solid.
        skip : array of uint32, or hits, optional
            A triangle for each ray that is not there for it, such as the one that the ray begins on: its index, or hits
            of an earlier call. 2^32 - 1, as in a miss, leaves out none. The test must be "exact".
        mask : int, default 2^32 - 1
            For `masks`.
        masks : array of uint32, optional
            A word for each triangle: it is there if its word has a bit in common with `mask`. Triangles behind the last
            word are there. The test must be "exact".
        filter_mask : int, default 2^32 - 1
            With `masks`: `filter` is asked only about triangles whose word has a bit in common with this, and about
            those without a word. Hits of others stay.
        threads : int, default 0
            At most so many threads; 0: all cores.
        progress : function, optional
            Called about every 20 ms with the share of rays done, from 0 to 1. An exception ends the call.

        Returns
        -------
        Hits
            One hit for each ray, in the shape of rays.

        Raises
        ------
        TypeError, ValueError
            If an array or option has a wrong type, or both forms of rays are given; if it has a wrong shape or value.

        Examples
        --------
        >>> hits = tree.closest(origins=[[0, 0, 5], [9, 0, 5]], directions=[0, 0, -2])
        >>> hits.hit, hits.t
        (array([ True, False]), array([2.5, inf], dtype=float32))
        >>> tree.closest(raylanes.rays([[0, 0, 5]], [0, 0, -2]), filter=lambda indices, hits: hits.t < 3).hit
        array([False])
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = how(test, grade, mode, hint, self._sides(facing), threads, progress, skipped(skip),
                    masked(mask, masks, filter_mask))
        return nearest(self._numbers, Hits, rays, out, active, lambda given, answer, bits: self._tree.closest(
            given, answer.rows, asked, bits, hits_after(after, answer), self._filter(filter)))

    def closest_crossing(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, out=None, active=None,
                         after=None, mode="automatic", hint="none", facing="any", skip=None, mask=EVERY_BIT, masks=None,
                         threads=0, progress=None):
        """Find the nearest hit at which each ray passes through the surface.

        An edge between two triangles counts once, or not at all where the ray only touches it. So rays enter and leave
        a closed mesh by turns: facing="back" finds the next exit of a solid, facing="front" its entry. The result is
        exact: the first hit of closest() that is one of crossings(), and no glance at an edge or a corner.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, out, active, mode, hint, facing, skip, mask, masks, threads, progress
            As in closest(), by the test "exact".
        after : Hits, optional
            For each ray a hit: the result is the closest crossing after it, in the order of t, then of primitives.

        Returns
        -------
        Hits
            One hit for each ray, in the shape of rays.

        Examples
        --------
        >>> rays = raylanes.rays([[0, 0, 5], [9, 0, 5]], [0, 0, -2])
        >>> entered = tree.closest_crossing(rays)
        >>> entered.t, tree.closest_crossing(rays, skip=entered).hit
        (array([2.5, inf], dtype=float32), array([False, False]))
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = how("exact", "reproducible", mode, hint, self._sides(facing), threads, progress, skipped(skip),
                    masked(mask, masks))
        return nearest(self._numbers, Hits, rays, out, active, lambda given, answer, bits: self._tree.closest_crossing(
            given, answer.rows, asked, bits, hits_after(after, answer)))

    def occluded(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, filter=None, out=None,
                 active=None, test="exact", grade="reproducible", mode="automatic", hint="none", facing="any",
                 skip=None, mask=EVERY_BIT, masks=None, filter_mask=EVERY_BIT, threads=0, progress=None):
        """Find out whether the segment of each ray hits anything.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, out, test, grade, mode, hint, facing, threads, progress
            As in closest().
        filter : function, optional
            As in closest(), but asked about the hits of a ray in no order, until it keeps one.
        skip, mask, masks, filter_mask
            As in closest().
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each ray that hits a triangle with tmin <= t <= tmax, in the shape of rays.

        Examples
        --------
        >>> tree.occluded(raylanes.rays([0, 0, 5], [0, 0, -1], tmax=[4, 5]))
        array([False,  True])
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = how(test, grade, mode, hint, self._sides(facing), threads, progress, skipped(skip),
                    masked(mask, masks, filter_mask))
        return shadows(self._numbers, rays, out, active,
                       lambda given, answers, bits: self._tree.occluded(
                           given, answers, asked, bits, self._filter(filter)))

    def occluded_from(self, origin, points, *, start=0.0, end=1.0, filter=None, out=None, active=None, test="exact",
                      grade="reproducible", mode="automatic", hint="none", facing="any", skip=None, mask=EVERY_BIT,
                      masks=None, filter_mask=EVERY_BIT, threads=0, progress=None):
        """Find out whether anything lies between one point, such as a light, and each of many points.

        This is the fastest way to trace shadows. Segments begin at `points` exactly, at any distance of the light:
        the ray from a point along the difference to `origin`, rounded, decides. If both points are equal, the result is
        False. occluded_towards() takes the direction of a sun.

        Parameters
        ----------
        origin : array of float, shape (3,)
            The point that all segments share.
        points : array of float, shape (..., 3)
            The other ends.
        start, end : float
            The part of each segment to test, as shares of its length from `origin` on: all of it by default, both
            points included. A point on a surface leaves out its own triangle by `skip`.
        filter : function, optional
            As in occluded(); indices are rows of the flattened points, and t is 0 at the point and 1 at `origin`.
        facing : {"any", "front", "back"}, default "any"
            Triangles to count, by the side that `origin` sees.
        out, test, grade, mode, hint, skip, mask, masks, filter_mask, threads, progress
            As in closest().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each point in shadow, in the shape of points without their last axis.

        Examples
        --------
        >>> tree.occluded_from([0, 0, 5], [[0, 0, -5], [9, 0, -5]])
        array([ True, False])
        """
        asked = how(test, grade, mode, hint, self._sides(facing), threads, progress, skipped(skip),
                    masked(mask, masks, filter_mask))
        return shadows_from(self._numbers, origin, points, (start, end), out, active,
                            lambda *given: self._tree.occluded_from(
                                *given[:-1], asked, given[-1], self._filter(filter)))

    def occluded_towards(self, direction, points, *, filter=None, out=None, active=None, test="exact",
                         grade="reproducible", mode="automatic", hint="none", facing="any", skip=None, mask=EVERY_BIT,
                         masks=None, filter_mask=EVERY_BIT, threads=0, progress=None):
        """Find out whether anything lies in one direction, such as that of the sun, from each of many points.

        Parameters
        ----------
        direction : array of float, shape (3,)
            The direction in which all rays go, of any length, such as that towards the sun.
        points : array of float, shape (..., 3)
            The points where rays begin.
        filter, out, test, grade, mode, hint, facing, skip, mask, masks, filter_mask, threads, progress
            As in closest(); indices are rows of the flattened points.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each point in shadow, in the shape of points without their last axis.

        Examples
        --------
        >>> tree.occluded_towards([0, 0, 1], [[0, 0, -5], [9, 0, -5]])
        array([ True, False])
        """
        asked = how(test, grade, mode, hint, self._sides(facing), threads, progress, skipped(skip),
                    masked(mask, masks, filter_mask))
        return shadows_towards(self._numbers, direction, points, out, active,
                               lambda *given: self._tree.occluded_from(
                                   *given[:-1], asked, given[-1], self._filter(filter)))

    def all_hits(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, max_count=None, facing="any",
                 skip=None, mask=EVERY_BIT, masks=None, active=None, threads=0, progress=None):
        """Find every hit of each ray, once, in the order of t, then of primitives.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax
            As in closest(), in one dimension.
        max_count : int, optional
            Keep the first so many hits of each ray.
        facing : {"any", "front", "back"}, default "any"
            Keep the hits of these sides only, as in closest().
        active : array of bool, optional
            The active rays; the others have no hits.
        skip, mask, masks, threads, progress
            As in closest(), by the test "exact".

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
        rays = given_rays(rays, origins, directions, tmin, tmax)
        return listed(self._tree.all_hits, Hits, self._numbers, self._numbers.hit, rays, max_count, facing, active,
                      threads, progress, skipped(skip), masked(mask, masks))

    def crossings(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, max_count=None, facing="any",
                  skip=None, mask=EVERY_BIT, masks=None, active=None, threads=0, progress=None):
        """Find each crossing of a ray and the surface, once, also at edges and vertices.

        Simulation of simplicity decides there (Edelsbrunner, Mücke 1990): a ray leaves a closed mesh as often as it
        enters it.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, max_count, skip, active, mask, masks, threads, progress
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
        rays = given_rays(rays, origins, directions, tmin, tmax)
        return listed(self._tree.crossings, Crossings, self._numbers, self._numbers.crossing, rays, max_count, facing,
                      active, threads, progress, skipped(skip), masked(mask, masks))

    def stretches(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, max_count=None, skip=None,
                  mask=EVERY_BIT, masks=None, active=None, threads=0, progress=None):
        """Find where each ray runs within solids: each entry with its exit, and the winding number between them.

        Lengths are right for rays through edges and corners, too: the sum of (exit - entry) * winding is that of exact
        arithmetic, but for the rounding of t. Crossings at one t count together, so nothing ends where a ray touches an
        edge, or passes into a solid that shares a face. A ray may begin within a solid or on a surface. Stretches whose
        ends round to one number are left out.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, max_count, skip, active, mask, masks, threads, progress
            As in all_hits().

        Returns
        -------
        Lists
            The Stretches of each ray, in order.

        Examples
        --------
        >>> solid = raylanes.Bvh([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
        ...                      [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
        >>> within = solid.stretches(raylanes.rays([[1, 1, 9]], [0, 0, -1]))[0]
        >>> within.entry, within.exit
        (array([7.]), array([9.]))
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        return listed(self._tree.stretches, Stretches, self._numbers, self._numbers.stretch, rays, max_count, "any",
                      active, threads, progress, skipped(skip), masked(mask, masks))

    def count_crossings(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, facing="any",
                        skip=None, mask=EVERY_BIT, masks=None, out=None, active=None, threads=0, progress=None):
        """Count the crossings of each ray, and add up their sides.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, out, skip, mask, masks, threads, progress
            As in closest(), by the test "exact".
        facing : {"any", "front", "back"}, default "any"
            Count crossings of these sides only, as in crossings().
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array their counts are 0.

        Returns
        -------
        ndarray of count_dtype
            The fields crossings and winding, in the shape of rays.

        Examples
        --------
        >>> tree.count_crossings(raylanes.rays([[0, 0, 5]], [0, 0, -1]))["winding"]
        array([-1], dtype=int32)
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        return counted(self._tree.count_crossings, self._numbers, rays, out, facing, active, threads, progress,
                       skipped(skip), masked(mask, masks))
