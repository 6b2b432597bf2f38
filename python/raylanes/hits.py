"""Results: arrays of records with a property for each number, and single records with the same properties."""

from types import GenericAlias

import numpy as np

from ._arrays import DOUBLES, FLOATS, faces_of, given_rays, lines, no_primitive, numbers, vertices_of
from ._meshes import faces_in, parts_of


def field_of(name, meaning):
    def number(self):
        value = self[name]
        return value.view(np.ndarray) if isinstance(value, np.ndarray) else value
    return property(number, doc=meaning)


class Records(np.ndarray):
    """An array of records; an index that names a single record returns `_record`, a view of it."""

    _record = np.void

    def __getitem__(self, key):
        item = super().__getitem__(key)
        if type(item) is not np.void:
            return item
        return self.view(np.dtype((self._record, self.dtype)))[key]

    def columns(self):
        """Return the records as columns: pandas.DataFrame(hits.columns()) is a table with a row for each.

        Returns
        -------
        dict of ndarray, shape (n,)
            A contiguous array for each field, in the order of records. Coordinates of points have columns of their
            own: point_x, point_y, point_z.

        Examples
        --------
        >>> tree = raylanes.Bvh([[0, 0, 0], [4, 0, 0], [0, 2, 0]], [[0, 1, 2]])
        >>> tree.closest(raylanes.rays([[1, 0.5, 5]], [0, 0, -1])).columns()["t"]
        array([5.])
        """
        columns = {}
        for name in self.dtype.names:
            field = np.asarray(self[name])
            axes = {name: field} if field.ndim == self.ndim else {
                f"{name}_{axis}": field[..., k] for k, axis in enumerate("xyz")}
            columns.update((key, np.array(column).reshape(-1)) for key, column in axes.items())
        return columns


class _OnTriangle:
    """Records with a place in a triangle: u and v say where."""

    @property
    def barycentric(self):
        """ndarray of the type of u, shape (..., 3): the weights 1 - u - v, u, v of the corners; NaN for a miss."""
        u, v = self.u, self.v
        weights = np.stack([np.asarray(1 - u - v, u.dtype), u, v], axis=-1)
        return np.where(_there_is(self.primitive)[..., None], weights, np.nan).astype(u.dtype)

    def interpolate(self, values, faces):
        """Compute the mean of three vertices' values by barycentric weights: texture coordinates, colours, normals.

        Parameters
        ----------
        values : array of float, shape (n,) or (n, k)
            A row for each vertex.
        faces : array of int, shape (m, 3), or a mesh
            The faces of the tree.

        Returns
        -------
        ndarray of float64, shape (...,) or (..., k)
            Computed in double from u and v; NaN for a miss.

        Raises
        ------
        ValueError
            If a face of a hit has an index that is no row of values.

        Examples
        --------
        >>> tree = raylanes.Bvh([[0, 0, 0], [4, 0, 0], [0, 2, 0]], [[0, 1, 2]])
        >>> hits = tree.closest(raylanes.rays([[1, 0.5, 5]], [0, 0, -1]))
        >>> hits.interpolate([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
        array([[0.25, 0.25]])
        """
        values = np.asarray(numbers("values", values), np.float64)
        if values.ndim not in (1, 2):
            raise ValueError(f"values: the shape must be (n,) or (n, k), it is {values.shape}")
        rows = self._corners(faces_in(faces), len(values))
        weights = np.asarray(self.barycentric, np.float64)
        if not len(values):
            return np.full(np.shape(self.u) + values.shape[1:], np.nan)
        return np.einsum("...i,...i->..." if values.ndim == 1 else "...i,...ik->...k", weights, values[rows])

    def normals(self, vertices, faces=None):
        """Compute the unit normals of the triangles: along (v1 - v0) x (v2 - v0), in double.

        Parameters
        ----------
        vertices, faces : array of float, shape (n, 3), and array of int, shape (m, 3)
            The mesh of the tree; or a mesh, or the tree itself, in place of both.

        Returns
        -------
        ndarray of float64, shape (..., 3)
            NaN for a miss, and for a triangle without an area.

        Raises
        ------
        ValueError
            If a face of a hit has an index that is no vertex.

        Examples
        --------
        >>> vertices, faces = [[0, 0, 0], [4, 0, 0], [0, 2, 0]], [[0, 1, 2]]
        >>> tree = raylanes.Bvh(vertices, faces)
        >>> tree.closest(raylanes.rays([[1, 0.5, 5]], [0, 0, -1])).normals(vertices, faces)
        array([[0., 0., 1.]])
        >>> tree.closest(raylanes.rays([[1, 0.5, 5]], [0, 0, -1])).normals(tree)
        array([[0., 0., 1.]])
        """
        if faces is None and hasattr(vertices, "_corners_of"):
            corners = vertices._corners_of(self.primitive)
        else:
            vertices, faces = parts_of(vertices, faces)
            vertices = np.asarray(vertices_of("vertices", vertices, np.float64))
            if not len(vertices):
                return np.full(np.shape(self.u) + (3,), np.nan)
            corners = vertices[self._corners(faces, len(vertices))]
        a, b, c = np.moveaxis(corners, -2, 0)
        with np.errstate(invalid="ignore", over="ignore"):
            crossed = np.cross(b - a, c - a)
            unit = crossed / np.linalg.norm(crossed, axis=-1, keepdims=True)
        return np.where(_there_is(self.primitive)[..., None], unit, np.nan)

    def _corners(self, faces, count):
        """(..., 3): vertices of the triangles; 0 for a miss."""
        faces = faces_of(faces)
        primitive = np.where(_there_is(self.primitive), self.primitive, 0)
        if not len(faces) and not _there_is(self.primitive).any():
            return np.zeros(np.shape(primitive) + (3,), np.int64)
        if primitive.size and int(primitive.max()) >= len(faces):
            raise ValueError(f"faces: there are {len(faces)}, and a hit is on face {int(primitive.max())}")
        rows = np.where(_there_is(self.primitive)[..., None], faces[primitive], 0)
        if rows.size and not (0 <= int(rows.min()) and int(rows.max()) < count):
            raise ValueError(f"faces: an index is no row of {count}")
        return rows


class _OnRay:
    """Records with a place on a ray: t says where."""

    def positions(self, rays=None, *, origins=None, directions=None):
        """Compute origin + t * direction of each hit or crossing.

        Computed in double: off along the ray by the rounding of t, |t * direction| * 2^-24 for t of float32 and 2^-52
        times the size of origin and position for t of float64.

        Parameters
        ----------
        rays : array, optional
            The rays of the query, in the same shape.
        origins, directions : array of float, shape (..., 3), optional
            The origins and directions of the query, in place of `rays`. Shapes are broadcast.

        Returns
        -------
        ndarray of the type of t, shape (..., 3)
            NaN for a miss.

        Raises
        ------
        ValueError
            If the rays have another shape.
        """
        origins, directions, shape = lines(given_rays(rays, origins, directions), _numbers_of(self.t))
        if shape != np.shape(self.t):
            raise ValueError(f"rays: the shape must be {np.shape(self.t)}, it is {shape}")
        origins, directions = (part.reshape(shape + (3,)) for part in (origins, directions))
        with np.errstate(invalid="ignore", over="ignore"):
            positions = origins + np.asarray(self.t, np.float64)[..., None] * directions
            return np.where(_there_is(self.primitive)[..., None], positions, np.nan).astype(self.t.dtype)


class HitNumbers(_OnTriangle, _OnRay):
    t = field_of("t", "real: distance in lengths of the direction, rounded once; inf for a miss")
    u = field_of("u", "real: weight of the triangle's second corner, rounded once; 0 for a miss")
    v = field_of("v", "real: weight of its third corner")
    primitive = field_of("primitive", "uint32: row of the triangle in faces; no_primitive for a miss")

    @property
    def hit(self):
        """bool: whether the ray hits."""
        return _there_is(self.primitive)


class _CrossingNumbers(_OnRay):
    t = field_of("t", "real: distance in lengths of the direction, rounded once")
    primitive = field_of("primitive", "uint32: row of the triangle in faces")
    side = field_of("side", "int32: 1 along the triangle's normal, out of a solid; -1 against it, into a solid")


class _StretchNumbers:
    entry = field_of("entry", "real: where it begins, in lengths of the direction")
    exit = field_of("exit", "real: where it ends, behind entry")
    entered_by = field_of("entered_by", "uint32: the triangle crossed at entry; no_primitive where the ray begins")
    left_by = field_of("left_by", "uint32: the triangle crossed at exit; no_primitive where the ray ends")
    winding = field_of("winding", "int32: the winding number along it; 1 in a closed mesh whose normals point out")


class _ClosestPointNumbers(_OnTriangle):
    distance_squared = field_of("distance_squared", "float64: inf if there is no point")
    point = field_of("point", "real, shape (..., 3): rounded once; zeros if there is no point")
    u = field_of("u", "real: weight of the triangle's second corner")
    v = field_of("v", "real: weight of its third corner")
    primitive = field_of("primitive", "uint32: row of the triangle in faces; no_primitive if there is no point")

    @property
    def distance(self):
        """float64: the square root of distance_squared."""
        if "distance" not in self.dtype.names:
            return np.sqrt(self.distance_squared)
        of_record = self["distance"]
        return of_record.view(np.ndarray) if isinstance(of_record, np.ndarray) else of_record


class Hit(HitNumbers, np.void):
    """A single hit: hits[i], with the properties and methods of Hits."""


class Crossing(_CrossingNumbers, np.void):
    """A single crossing: crossings[i], with the properties and methods of Crossings."""


class Stretch(_StretchNumbers, np.void):
    """A single stretch: stretches[i], with the properties of Stretches."""


class ClosestPoint(_ClosestPointNumbers, np.void):
    """A single closest point: points[i], with the properties of ClosestPoints."""


class Hits(HitNumbers, Records):
    """An array of hit_dtype or double_hit_dtype.

    hits[mask] and hits["t"] work as in any array of records, and hits[i] is a Hit.
    """

    _record = Hit
    _miss = (np.inf, 0, 0, no_primitive)


class Crossings(_CrossingNumbers, Records):
    """An array of crossing_dtype or double_crossing_dtype; crossings[i] is a Crossing."""

    _record = Crossing


class Stretches(_StretchNumbers, Records):
    """An array of stretch_dtype or double_stretch_dtype; stretches[i] is a Stretch."""

    _record = Stretch


class ClosestPoints(_ClosestPointNumbers, Records):
    """An array of closest_point_dtype or double_closest_point_dtype; points[i] is a ClosestPoint."""

    _record = ClosestPoint


class Lists:
    """A list of items for each ray: lists[i], or items[offsets[i]:offsets[i + 1]], has the items of ray i in order.

    Attributes
    ----------
    offsets : ndarray of int64, shape (n + 1,)
        The index of the first item of each ray, and the end of the last.
    items : Hits, Crossings or Stretches, or those of scenes, shape (h,)
        The items of all rays, ray by ray.
    """

    __class_getitem__ = classmethod(GenericAlias)

    def __init__(self, offsets, items):
        self.offsets, self.items = offsets, items

    def __len__(self):
        return len(self.offsets) - 1

    def __getitem__(self, ray):
        if not -len(self) <= ray < len(self):
            raise IndexError(f"ray {ray} of {len(self)}")
        ray %= len(self)
        return self.items[self.offsets[ray]:self.offsets[ray + 1]]

    def __iter__(self):
        return (self[ray] for ray in range(len(self)))

    @property
    def counts(self):
        """ndarray of int64, shape (n,): how many items each ray has."""
        return np.diff(self.offsets)

    @property
    def ray(self):
        """ndarray of int64, shape (h,): the ray of each item."""
        return np.repeat(np.arange(len(self)), self.counts)

    def columns(self):
        """Return the items as columns, with the ray of each: pandas.DataFrame(lists.columns()) is a table of them.

        Returns
        -------
        dict of ndarray, shape (h,)
            "ray", and the columns of the items.

        Examples
        --------
        >>> tree = raylanes.Bvh([[0, 0, 0], [4, 0, 0], [0, 2, 0]], [[0, 1, 2]])
        >>> list(tree.crossings(raylanes.rays([[1, 0.5, 5]], [0, 0, -1])).columns())
        ['ray', 't', 'primitive', 'side']
        """
        return {"ray": self.ray, **self.items.columns()}

    def positions(self, rays=None, *, origins=None, directions=None):
        """Compute origin + t * direction of each hit or crossing.

        Computed in double: off along the ray by the rounding of t, |t * direction| * 2^-24 for t of float32 and 2^-52
        times the size of origin and position for t of float64.

        Parameters
        ----------
        rays : array, optional
            The rays of the query, shape (n,).
        origins, directions : array of float, shape (..., 3), optional
            The origins and directions of the query, in place of `rays`. Shapes are broadcast.

        Returns
        -------
        ndarray of the type of t, shape (..., 3)
            One position for each item.

        Raises
        ------
        ValueError
            If the rays have another number.
        """
        origins, directions, shape = lines(given_rays(rays, origins, directions), _numbers_of(self.items.t))
        if shape != (len(self),):
            raise ValueError(f"rays: the shape must be {(len(self),)}, it is {shape}")
        return self.items.positions(origins=origins[self.ray], directions=directions[self.ray])

    def __repr__(self):
        return f"<raylanes.Lists of {len(self.items)} items of {len(self)} rays>"


def _there_is(primitive):
    return np.asarray(primitive) != no_primitive


def _numbers_of(t):
    return FLOATS if t.dtype == np.float32 else DOUBLES
