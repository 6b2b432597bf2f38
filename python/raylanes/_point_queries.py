"""Queries of points, which Bvh and KdTree share."""

import numpy as np

from ._answer import Answer
from ._arrays import DOUBLES, FLOATS, no_primitive, packed, rows
from ._meshes import warn, warn_of_sides
from ._scalars import function, real, threads_of, word
from .hits import ClosestPoints
from .paths import chosen

OUTSIDE, INSIDE, ON = np.uint8(0), np.uint8(1), np.uint8(2)

_nowhere = {FLOATS: (np.inf, 0, 0, 0, no_primitive), DOUBLES: (np.inf, np.inf, 0, 0, 0, no_primitive)}


class PointQueries:
    """Queries of points over `self._tree`, which has `self._numbers`."""

    def _rule(self, rule):
        """The name of a rule. Warns if it is parity, and the mesh is not closed; or winding, and it is inside out."""
        if rule == "parity" and self._tree.found_holes():
            warn('the mesh is not closed: inside and outside by rule="parity" may be wrong near and behind holes. '
                 'rule="winding" is for such meshes; raylanes.closed_report() lists the open edges')
        if rule == "winding":
            warn_of_sides(self._tree, 'rule="winding" finds no point inside')
        return word("rule", rule)

    def locate(self, points, *, rule="parity", out=None, active=None, threads=0, progress=None):
        """Find out whether each point is inside, outside or on the surface, exactly.

        Parameters
        ----------
        points : array of float, shape (..., 3)
            Points that are not finite are outside.
        rule : {"parity", "nonzero", "vote", "winding"}, default "parity"
            "parity": a ray from the point crosses the surface an odd number of times. "nonzero": the sides of the
            crossings do not add up to 0, for solids that overlap or are nested. "winding": the winding number is 1/2
            or more, for meshes with holes or faces turned over; see winding_numbers(). "vote": four of six rays agree,
            in up to six times the time. See closed_report(). A mesh that is not closed gets a MeshWarning by "parity",
            once for each tree.
        out : ndarray, optional
            The array to write to, of the shape and dtype of the result.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are OUTSIDE.
        threads : int, default 0
            At most so many threads; 0: all cores.
        progress : function, optional
            Called about every 20 ms with the share of points done, from 0 to 1. An exception ends the call.

        Returns
        -------
        ndarray of uint8
            OUTSIDE, INSIDE or ON for each point.

        Examples
        --------
        >>> tree.locate([[0, 0, 0], [0, 0, 1]])
        array([2, 0], dtype=uint8)
        """
        given, shape = rows("points", points, 3, self._numbers.real)
        answer = Answer(out, shape, np.dtype(np.uint8), (given,), None if active is None else OUTSIDE)
        self._tree.locate(given, answer.rows, self._rule(rule), chosen(), threads_of(threads), packed(active, shape),
                          function("progress", progress))
        return answer.finish()

    def inside(self, points, *, rule="parity", threads=0, progress=None):
        """Find out whether each point is inside or on the surface.

        contains_points of raylanes.trimesh has another rule: parity if the mesh is closed, else the vote of six rays.

        Parameters
        ----------
        points, rule, threads, progress
            As in locate(). A mesh that is not closed gets a MeshWarning by "parity".

        Returns
        -------
        ndarray of bool
            True for each point that is INSIDE or ON.

        Examples
        --------
        >>> tree.inside([[0, 0, 0], [0, 0, 1]])
        array([ True, False])
        """
        return self.locate(points, rule=rule, threads=threads, progress=progress) != OUTSIDE

    def winding_numbers(self, points, *, accuracy=1e-6, out=None, active=None, threads=0, progress=None):
        """Compute the generalised winding number of each point: how often the mesh winds around it.

        It is the sum of the solid angles of all triangles, seen from the point, over 4 pi. Closed meshes have whole
        numbers, exactly: 1 inside and 0 outside. Meshes with holes have numbers between, without a jump at the hole.

        Parameters
        ----------
        points : array of float, shape (..., 3)
            Points that are not finite have 0.
        accuracy : float, default 1e-6
            The greatest error of expansions of far parts of the boundary; 0: no expansions. The larger, the faster.
        out, threads, progress
            As in locate().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are 0.

        Returns
        -------
        ndarray of self.dtype
            One number for each point.

        Notes
        -----
        Jacobson, Kavan, Sorkine-Hornung, 2013: Robust inside-outside segmentation using generalized winding numbers.

        Examples
        --------
        >>> tree.winding_numbers([[0, 0, -0.25], [0, 0, 0.25]]).round(3)
        array([ 0.324, -0.324], dtype=float32)
        """
        given, shape = rows("points", points, 3, self._numbers.real)
        answer = Answer(out, shape, self.dtype, (given,), None if active is None else 0)
        self._tree.winding_numbers(given, answer.rows, real("accuracy", accuracy, np.float64), chosen(),
                                   threads_of(threads), packed(active, shape), function("progress", progress))
        return answer.finish()

    def closest_points(self, points, *, max_distance=np.inf, out=None, active=None, threads=0, progress=None):
        """Find the closest point of the triangles to each point.

        Ties go to the lowest primitive. Distances are computed in double, with the same bytes on every ISA path and in
        every tree. With M the distance to the triangle's farthest corner, distance_squared is off by at most
        2^-46 * M^2. In a tree of float64, points are not rounded, and `distance` has no overflow.

        Parameters
        ----------
        points : array of float, shape (..., 3)
            If a point is not finite, there is no closest point.
        max_distance : float, default inf
            Triangles farther away are ignored.
        out, threads, progress
            As in locate().
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array
            there is no closest point.

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
        given, shape = rows("points", points, 3, self._numbers.real)
        dtype = self._numbers.closest_point
        initial = None if active is None else np.array(_nowhere[self._numbers], dtype)
        answer = Answer(out, shape, dtype, (given,), initial)
        self._tree.closest_points(given, answer.rows, real("max_distance", max_distance, self._numbers.real), chosen(),
                                  threads_of(threads), packed(active, shape), function("progress", progress))
        return answer.finish(ClosestPoints)

    def signed_distances(self, points, *, rule="parity", max_distance=np.inf, out=None, active=None, threads=0,
                         progress=None):
        """Compute how far each point is from the surface: negative inside, positive outside.

        This is the sign of Open3D. raylanes.trimesh.signed_distance has the sign of trimesh: positive inside.
        The sign is exact, as in locate(): the distance is 0 if and only if the point is on a triangle.

        Parameters
        ----------
        points, rule, out, threads, progress
            As in locate().
        max_distance : float, default inf
            Points farther away get an infinity with the sign of their side: the smaller, the faster.
        active : array of bool, optional
            The active points, one bool for each. Inactive ones leave `out` unchanged; in a new array they are inf.

        Returns
        -------
        ndarray of self.dtype
            One distance for each point, rounded once.

        Examples
        --------
        >>> tree.signed_distances([[0, 0, 3], [0, 0, 0]])
        array([3., 0.], dtype=float32)
        """
        given, shape = rows("points", points, 3, self._numbers.real)
        answer = Answer(out, shape, self.dtype, (given,), None if active is None else np.inf)
        self._tree.signed_distances(given, answer.rows, self._rule(rule),
                                    real("max_distance", max_distance, self._numbers.real), chosen(),
                                    threads_of(threads), packed(active, shape), function("progress", progress))
        return answer.finish()
