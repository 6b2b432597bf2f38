"""Queries of scenes."""

from ._arrays import given_rays
from ._scalars import count
from ._traces import (EVERY_BIT, counted, filter_of, hits_after, how, listed, named_in_scene, nearest, shadows,
                      shadows_from, shadows_towards)
from .scene_hits import SceneCrossings, SceneHits, SceneStretches


class SceneQueries:
    """Queries of rays over the native scene `self._tree`."""

    def closest(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, mask=EVERY_BIT, filter=None,
                out=None, active=None, after=None, test="exact", grade="reproducible", mode="automatic", hint="none",
                facing="any", skip=None, threads=0, progress=None):
        """Find the nearest hit of each ray.

        Ties in t go to the lowest instance, then to the lowest primitive.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax
            As in Bvh.closest().
        mask : int, default 2^32 - 1
            Only instances whose mask has a bit in common with this are hit.
        filter : function, optional
            filter(indices, hits) returns a bool for each hit: True rejects it, and its ray goes on behind it. indices
            are rows of the flattened rays, hits are SceneHits. It is called with batches of hits, on the calling
            thread. The test must be "exact".
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are misses.
        after : SceneHits, optional
            For each ray a hit, in the shape of rays: the result is the next one behind it, in the order of t, then
            instance, then primitive. Behind a miss there is none; if t is -inf, it is the nearest hit. A sphere has two
            hits, where a ray enters and leaves it. The test must be "exact".
        test, grade, mode, hint : str
            As in Bvh.closest(), for geometries of triangles.
        facing : {"any", "front", "back"}, default "any"
            The sides of triangles that count, in the space of their geometry. A scene with spheres has "any" alone.
        skip : SceneHits, SceneCrossings or SceneClosestPoints, optional
            A primitive of an instance for each ray that is not there for it, such as the one that the ray begins on.
            A skipped sphere lacks the hit nearer to tmin alone. A miss leaves out none. The test must be "exact".
        threads : int, default 0
            At most so many threads; 0: all cores.
        progress : function, optional
            Called about every 20 ms with the share of rays done, from 0 to 1. An exception ends the call.

        Returns
        -------
        SceneHits
            One hit for each ray, in the shape of rays.

        Raises
        ------
        RuntimeError
            If the scene was changed without update().

        Examples
        --------
        >>> rays = raylanes.rays([[0, 0, 5]], [0, 0, -1])
        >>> scene.closest(rays).instance
        array([0], dtype=uint32)
        >>> scene.closest(rays, filter=lambda indices, hits: hits.primitive == 0).hit
        array([False])
        >>> scene.closest(rays, after=scene.closest(rays)).hit
        array([False])
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = how(test, grade, mode, hint, facing, threads, progress, _skipped(skip), _mask(mask))
        return nearest(self._numbers, SceneHits, rays, out, active, lambda given, answer, bits: self._tree.closest(
            given, answer.rows, asked, bits, hits_after(after, answer), self._filter(filter)))

    def closest_crossing(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, mask=EVERY_BIT,
                         after=None, out=None, active=None, facing="any", skip=None, threads=0, progress=None):
        """Find the nearest hit at which each ray passes through the surface of an instance.

        As Bvh.closest_crossing() in the space of each instance: an edge counts once, or not at all where the ray only
        touches it. All geometries must consist of triangles; the test is "exact".

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, mask, active, facing, skip, threads, progress
            As in closest().
        after : SceneHits, optional
            For each ray a hit: the result is the closest crossing after it.
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result; it may be `after` itself.

        Returns
        -------
        SceneHits
            One hit for each ray, in the shape of rays.

        Raises
        ------
        ValueError
            If a geometry has spheres.

        Examples
        --------
        >>> rays = raylanes.rays([[0, 0, 5]], [0, 0, -1])
        >>> scene.closest_crossing(rays, facing="front").hit, scene.closest_crossing(rays, facing="back").hit
        (array([ True]), array([False]))
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = how("exact", "reproducible", "automatic", "none", facing, threads, progress, _skipped(skip),
                    _mask(mask))
        return nearest(self._numbers, SceneHits, rays, out, active,
                       lambda given, answer, bits: self._tree.closest_crossing(
                           given, answer.rows, asked, bits, hits_after(after, answer)))

    def occluded(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, mask=EVERY_BIT, filter=None,
                 out=None, active=None, test="exact", grade="reproducible", mode="automatic", hint="none", facing="any",
                 skip=None, threads=0, progress=None):
        """Find out whether the segment of each ray hits anything.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, mask, filter, out, test, grade, mode, hint, facing, skip, threads,
        progress
            As in closest().
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each ray that hits something with tmin <= t <= tmax, in the shape of rays.

        Examples
        --------
        >>> scene.occluded(raylanes.rays([0, 0, 5], [0, 0, -1], tmax=[4, 5]))
        array([False,  True])
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        asked = how(test, grade, mode, hint, facing, threads, progress, _skipped(skip), _mask(mask))
        return shadows(self._numbers, rays, out, active, lambda given, answers, bits: self._tree.occluded(
            given, answers, asked, bits, self._filter(filter)))

    def occluded_from(self, origin, points, *, start=0.0, end=1.0, mask=EVERY_BIT, filter=None, out=None, active=None,
                      test="exact", grade="reproducible", mode="automatic", hint="none", facing="any", skip=None,
                      threads=0, progress=None):
        """Find out whether anything lies between one point, such as a light, and each of many points.

        Parameters
        ----------
        origin : array of float, shape (3,)
            The point that all segments share.
        points : array of float, shape (..., 3)
            The other ends.
        start, end : float
            As in Bvh.occluded_from(): 0 and 1 by default.
        facing : {"any", "front", "back"}, default "any"
            Triangles to count, by the side that `origin` sees.
        mask, filter, out, test, grade, mode, hint, skip, threads, progress
            As in closest().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each point in shadow, in the shape of points without their last axis.

        Examples
        --------
        >>> scene.occluded_from([0, 0, 5], [[0, 0, -5], [9, 0, -5]])
        array([ True, False])
        """
        asked = how(test, grade, mode, hint, facing, threads, progress, _skipped(skip), _mask(mask))
        return shadows_from(self._numbers, origin, points, (start, end), out, active,
                            lambda *given: self._tree.occluded_from(
                                *given[:-1], asked, given[-1], self._filter(filter)))

    def occluded_towards(self, direction, points, *, mask=EVERY_BIT, filter=None, out=None, active=None, test="exact",
                         grade="reproducible", mode="automatic", hint="none", facing="any", skip=None, threads=0,
                         progress=None):
        """Find out whether anything lies in one direction, such as that of the sun, from each of many points.

        Parameters
        ----------
        direction : array of float, shape (3,)
            The direction in which all rays go, of any length, such as that towards the sun.
        points : array of float, shape (..., 3)
            The points where rays begin.
        mask, filter, out, test, grade, mode, hint, facing, skip, threads, progress
            As in closest().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are False.

        Returns
        -------
        ndarray of bool
            True for each point in shadow, in the shape of points without their last axis.

        Examples
        --------
        >>> scene.occluded_towards([0, 0, 1], [[0, 0, -5], [9, 0, -5]])
        array([ True, False])
        """
        asked = how(test, grade, mode, hint, facing, threads, progress, _skipped(skip), _mask(mask))
        return shadows_towards(self._numbers, direction, points, out, active, lambda *given: self._tree.occluded_from(
            *given[:-1], asked, given[-1], self._filter(filter)))

    def all_hits(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, mask=EVERY_BIT,
                 max_count=None, facing="any", skip=None, active=None, threads=0, progress=None):
        """Find every hit of each ray in all instances, once, in the order of t, then of instances, then of primitives.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax
            As in closest(), in one dimension.
        max_count : int, optional
            Keep the first so many hits of each ray.
        active : array of bool, optional
            The active rays; the others have no hits.
        mask, facing, skip, threads, progress
            As in closest(), by the test "exact".

        Returns
        -------
        Lists
            The SceneHits of each ray.

        Examples
        --------
        >>> scene.all_hits(raylanes.rays([[0, 0, 5], [9, 0, 5]], [0, 0, -1])).counts
        array([1, 0])
        """
        rays, kinds = given_rays(rays, origins, directions, tmin, tmax), self._numbers
        return listed(self._tree.all_hits, SceneHits, kinds, kinds.hit, rays, max_count, facing, active, threads,
                      progress, _skipped(skip), _mask(mask))

    def crossings(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, mask=EVERY_BIT,
                  max_count=None, facing="any", skip=None, active=None, threads=0, progress=None):
        """Find each crossing of a ray and the surface of an instance, once, also at edges and vertices.

        As Bvh.crossings() in the space of each instance. All geometries must consist of triangles.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, mask, max_count, facing, skip, active, threads, progress
            As in all_hits().

        Returns
        -------
        Lists
            The SceneCrossings of each ray, in the order of t, then of instances, then of primitives.

        Raises
        ------
        ValueError
            If a geometry has spheres.

        Examples
        --------
        >>> crossings = scene.crossings(raylanes.rays([[0, 0, 5]], [0, 0, -1]))[0]
        >>> crossings.side, crossings.instance
        (array([-1], dtype=int32), array([0], dtype=uint32))
        """
        rays, kinds = given_rays(rays, origins, directions, tmin, tmax), self._numbers
        return listed(self._tree.crossings, SceneCrossings, kinds, kinds.crossing, rays, max_count, facing, active,
                      threads, progress, _skipped(skip), _mask(mask))

    def stretches(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, mask=EVERY_BIT,
                  max_count=None, skip=None, active=None, threads=0, progress=None):
        """Find where each ray runs within each instance: each entry with its exit, and the winding number between them.

        As Bvh.stretches(), of each instance by itself. All geometries must consist of triangles.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, mask, max_count, skip, active, threads, progress
            As in all_hits().

        Returns
        -------
        Lists
            The SceneStretches of each ray, in the order of their entries, then of instances.

        Raises
        ------
        ValueError
            If a geometry has spheres.

        Examples
        --------
        >>> solid = raylanes.Scene()
        >>> solid.place(solid.add(np.float32([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]),
        ...                       [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))
        0
        >>> solid.update()
        >>> within = solid.stretches(raylanes.rays([[1, 1, 9]], [0, 0, -1]))[0]
        >>> within.entry, within.exit, within.instance
        (array([7.], dtype=float32), array([9.], dtype=float32), array([0], dtype=uint32))
        """
        rays, kinds = given_rays(rays, origins, directions, tmin, tmax), self._numbers
        return listed(self._tree.stretches, SceneStretches, kinds, kinds.stretch, rays, max_count, "any", active,
                      threads, progress, _skipped(skip), _mask(mask))

    def count_crossings(self, rays=None, *, origins=None, directions=None, tmin=None, tmax=None, mask=EVERY_BIT,
                        facing="any", skip=None, out=None, active=None, threads=0, progress=None):
        """Count the crossings of each ray over all instances, and add up their sides.

        Parameters
        ----------
        rays, origins, directions, tmin, tmax, mask, out, skip, threads, progress
            As in closest(), by the test "exact".
        facing : {"any", "front", "back"}, default "any"
            Count crossings of these sides only, as in crossings().
        active : array of bool, optional
            The active rays, one bool for each. Inactive ones leave `out` unchanged; in a new array their counts are 0.

        Returns
        -------
        ndarray of count_dtype
            The fields crossings and winding, in the shape of rays.

        Raises
        ------
        ValueError
            If a geometry has spheres.

        Examples
        --------
        >>> scene.count_crossings(raylanes.rays([[0, 0, 5]], [0, 0, -1]))["winding"]
        array([-1], dtype=int32)
        """
        rays = given_rays(rays, origins, directions, tmin, tmax)
        return counted(self._tree.count_crossings, self._numbers, rays, out, facing, active, threads, progress,
                       _skipped(skip), _mask(mask))

    def _filter(self, filter):
        return filter_of(filter, SceneHits, self._numbers.hit)


def _skipped(skip):
    return None if skip is None else named_in_scene("skip", skip)


def _mask(mask):
    return count("mask", mask, EVERY_BIT)
