"""Queries of points in scenes, and the triangles that hits in scenes name."""

import numpy as np

from ._answer import Answer
from ._arrays import DOUBLE_SCENES, SCENES, containing_part_dtype, no_part, no_primitive, packed, rows
from ._point_queries import OUTSIDE
from ._scalars import count, function, real, threads_of, word
from ._traces import EVERY_BIT, named_in_scene
from .hits import Lists
from .paths import chosen
from .scene_hits import ContainingParts, SceneClosestPoints

_nowhere = {SCENES: (np.inf, 0, 0, 0, no_primitive, no_part, no_part),
            DOUBLE_SCENES: (np.inf, np.inf, 0, 0, 0, no_primitive, no_part, no_part)}
_in_none = (no_part, no_part, OUTSIDE)


class ScenePoints:
    """Queries of points over the native scene `self._tree`."""

    def closest_points(self, points, *, max_distance=np.inf, mask=EVERY_BIT, out=None, active=None, threads=0,
                       progress=None):
        """Find the closest point of the triangles of all instances to each point.

        Distances and points are in the space of the scene, also where instances are scaled unequally. Ties go to the
        lowest instance, then to the lowest primitive. Corners are moved to the scene in float64; then as
        Bvh.closest_points(): the same bytes on every ISA path.

        Parameters
        ----------
        points : array of float, shape (..., 3)
            If a point is not finite, there is no closest point.
        max_distance : float, default inf
            Triangles farther away are ignored.
        mask : int, default 2^32 - 1
            Only instances whose mask has a bit in common with this are there.
        out, active, threads, progress
            As in Bvh.closest_points().

        Returns
        -------
        SceneClosestPoints
            One for each point.

        Raises
        ------
        ValueError
            If an instance that the mask sees has spheres.
        RuntimeError
            If the scene was changed without update().

        Examples
        --------
        >>> closest = scene.closest_points([[0, 0, 3]])
        >>> closest.distance, closest.instance, closest.primitive
        (array([3.]), array([0], dtype=uint32), array([0], dtype=uint32))
        """
        answer = self._answer(points, out, active, self._numbers.closest_point, _nowhere[self._numbers])
        self._tree.closest_points(answer.given, answer.rows, real("max_distance", max_distance, self.dtype), chosen(),
                                  threads_of(threads), answer.bits, function("progress", progress), _mask(mask))
        return answer.finish(SceneClosestPoints)

    def locate(self, points, *, rule="parity", mask=EVERY_BIT, out=None, active=None, threads=0, progress=None):
        """Find out whether each point is inside an instance, outside of all or on the surface of one.

        A point on the surface of an instance and inside another one is INSIDE. Each instance decides exactly in its own
        space, as Bvh.locate() does, for the point that is moved there and rounded to self.dtype.

        Parameters
        ----------
        points, rule, out, active, threads, progress
            As in Bvh.locate(); no warning is given for geometries that are not closed.
        mask : int, default 2^32 - 1
            As in closest_points().

        Returns
        -------
        ndarray of uint8
            OUTSIDE, INSIDE or ON for each point.

        Raises
        ------
        ValueError
            If an instance that the mask sees has spheres.

        Examples
        --------
        >>> scene.locate([[0, 0, 0], [0, 0, 1]])
        array([2, 0], dtype=uint8)
        """
        answer = self._answer(points, out, active, np.dtype(np.uint8), OUTSIDE)
        self._tree.locate(answer.given, answer.rows, word("rule", rule), chosen(), threads_of(threads), answer.bits,
                          function("progress", progress), _mask(mask))
        return answer.finish()

    def inside(self, points, *, rule="parity", mask=EVERY_BIT, threads=0, progress=None):
        """Find out whether each point is inside an instance or on its surface.

        Parameters
        ----------
        points, rule, mask, threads, progress
            As in locate().

        Returns
        -------
        ndarray of bool
            True for each point that is INSIDE or ON.

        Examples
        --------
        >>> scene.inside([[0, 0, 0], [0, 0, 1]])
        array([ True, False])
        """
        return self.locate(points, rule=rule, mask=mask, threads=threads, progress=progress) != OUTSIDE

    def winding_numbers(self, points, *, accuracy=1e-6, mask=EVERY_BIT, out=None, active=None, threads=0,
                        progress=None):
        """Compute the sum of the winding numbers of all instances at each point, each in its own space.

        If all meshes are closed and their normals point out, it is the number of instances that contain the point, also
        where transforms mirror them.

        Parameters
        ----------
        points, accuracy, out, active, threads, progress
            As in Bvh.winding_numbers().
        mask : int, default 2^32 - 1
            As in closest_points().

        Returns
        -------
        ndarray of self.dtype
            One number for each point.

        Examples
        --------
        >>> scene.winding_numbers([[0, 0, -0.25], [0, 0, 0.25]]).round(3)
        array([ 0.324, -0.324], dtype=float32)
        """
        answer = self._answer(points, out, active, self.dtype, 0)
        self._tree.winding_numbers(answer.given, answer.rows, real("accuracy", accuracy, np.float64), chosen(),
                                   threads_of(threads), answer.bits, function("progress", progress), _mask(mask))
        return answer.finish()

    def signed_distances(self, points, *, rule="parity", max_distance=np.inf, mask=EVERY_BIT, out=None, active=None,
                         threads=0, progress=None):
        """Compute how far each point is from the nearest surface of an instance: negative inside an instance.

        The distance is 0 if and only if the point is on the surface of an instance, even within another one. Surfaces
        within other instances count.

        Parameters
        ----------
        points, rule, max_distance, out, active, threads, progress
            As in Bvh.signed_distances().
        mask : int, default 2^32 - 1
            As in closest_points().

        Returns
        -------
        ndarray of self.dtype
            One distance for each point, rounded once.

        Examples
        --------
        >>> scene.signed_distances([[0, 0, 3], [0, 0, 0]])
        array([3., 0.], dtype=float32)
        """
        answer = self._answer(points, out, active, self.dtype, np.inf)
        self._tree.signed_distances(answer.given, answer.rows, word("rule", rule),
                                    real("max_distance", max_distance, self.dtype), chosen(), threads_of(threads),
                                    answer.bits, function("progress", progress), _mask(mask))
        return answer.finish()

    def innermost_parts(self, points, *, rule="parity", mask=EVERY_BIT, out=None, active=None, threads=0,
                        progress=None):
        """Find the innermost instance that contains each point: which cell, which body.

        It is the first one of containing_parts(): that of the least volume, of equal ones the lowest.

        Parameters
        ----------
        points, rule, mask, out, threads, progress
            As in locate().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are in none.

        Returns
        -------
        ContainingParts
            One for each point; no_part where no instance contains the point.

        Raises
        ------
        ValueError
            If an instance that the mask sees has spheres.

        Examples
        --------
        >>> vertices = np.float32([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]])
        >>> faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
        >>> solids = raylanes.Scene()
        >>> part = solids.add(vertices, faces)
        >>> solids.place(part, [np.eye(4), np.diag([0.5, 0.5, 0.5, 1])])
        array([0, 1])
        >>> solids.update()
        >>> parts = solids.innermost_parts([[0.5, 0.5, 0.5], [1, 1, 1], [0, 3, 0.5], [9, 0, 0]])
        >>> parts.instance[parts.found], parts.location
        (array([1, 0, 0], dtype=uint32), array([1, 1, 2, 0], dtype=uint8))
        """
        answer = self._answer(points, out, active, containing_part_dtype, _in_none)
        self._tree.innermost_parts(answer.given, answer.rows, word("rule", rule), chosen(), threads_of(threads),
                                   answer.bits, function("progress", progress), _mask(mask))
        return answer.finish(ContainingParts)

    def containing_parts(self, points, *, rule="parity", mask=EVERY_BIT, active=None, threads=0, progress=None):
        """Find all instances that contain each point, inside or on their surface, innermost first.

        They are in the order of their volumes, then of instances: a solid within another one comes before it. The order
        of two instances is the same at all points.

        Parameters
        ----------
        points : array of float, shape (n, 3)
            Points that are not finite are in none.
        rule, mask, threads, progress
            As in locate().
        active : array of bool, optional
            The active points; the others have no parts.

        Returns
        -------
        Lists
            The ContainingParts of each point; the `ray` of an item is the row of its point.

        Raises
        ------
        ValueError
            If an instance that the mask sees has spheres.

        Examples
        --------
        >>> scene.containing_parts([[0, 0, 0], [0, 0, 1]]).counts
        array([1, 0])
        """
        given, shape = rows("points", points, 3, self.dtype)
        if len(shape) != 1:
            raise ValueError(f"points: lists are of points in two dimensions, the shape is {(*shape, 3)}")
        offsets, items = self._tree.containing_parts(given, word("rule", rule), chosen(), threads_of(threads),
                                                     packed(active, shape), function("progress", progress),
                                                     _mask(mask))
        return Lists(offsets.view(np.int64), items.view(containing_part_dtype).view(ContainingParts))

    def corners(self, hits):
        """Return the corners in the scene of the triangle of each hit, crossing or closest point.

        They are moved to the scene in float64 and rounded once to self.dtype. No trees or meshes are needed.

        Parameters
        ----------
        hits : SceneHits, SceneCrossings or SceneClosestPoints, shape (...)
            Records that name an instance and a primitive.

        Returns
        -------
        ndarray of self.dtype, shape (..., 3, 3)
            NaN for misses, and for hits of spheres.

        Examples
        --------
        >>> scene.corners(scene.closest(raylanes.rays([[0, 0, 5]], [0, 0, -1])))[0, 2]
        array([0., 1., 0.], dtype=float32)
        """
        return self._of_hits(hits, self._tree.corners, (3, 3))

    def normals(self, hits, *, threads=0):
        """Return the unit normal in the scene of the triangle of each hit, crossing or closest point.

        A normal points out of a solid if it does so in the space of the instance, also where the transform mirrors it.
        SceneHits.normals() also serves spheres.

        Parameters
        ----------
        hits
            As in corners().
        threads : int, default 0
            At most so many threads; 0: all cores.

        Returns
        -------
        ndarray of self.dtype, shape (..., 3)
            NaN for misses, for hits of spheres, and for a triangle without an area.

        Examples
        --------
        >>> scene.normals(scene.closest(raylanes.rays([[0, 0, 5]], [0, 0, -1])))
        array([[0., 0., 1.]], dtype=float32)
        """
        return self._of_hits(hits, lambda names, out: self._tree.normals(names, out, threads_of(threads)), (3,))

    def _of_hits(self, hits, ask, shape):
        out = np.empty((*np.shape(hits), *shape), self.dtype)
        ask(named_in_scene("hits", hits), out.reshape(-1))
        return out

    def _answer(self, points, out, active, dtype, initial):
        """The answers of a call with points, and `given`, the rows of points, and `bits`, the mask of active ones."""
        given, shape = rows("points", points, 3, self.dtype)
        answer = Answer(out, shape, dtype, (given,), None if active is None else np.array(initial, dtype))
        answer.given, answer.bits = given, packed(active, shape)
        return answer


def _mask(mask):
    return count("mask", mask, EVERY_BIT)
