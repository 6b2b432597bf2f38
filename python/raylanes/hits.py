"""Results: arrays of records, with a property for each number, and the same of a single record."""

import numpy as np

from .arrays import no_primitive, ray_rows


def _field(name, meaning):
    def number(self):
        value = self[name]
        return value.view(np.ndarray) if isinstance(value, np.ndarray) else value
    return property(number, doc=meaning)


class _Records(np.ndarray):
    """An array of records; an index that names a single record returns `_record`, a view of it."""

    _record = np.void

    def __getitem__(self, key):
        item = super().__getitem__(key)
        if type(item) is not np.void:
            return item
        return self.view(np.dtype((self._record, self.dtype)))[key]


class _HitNumbers:
    t = _field("t", "float32: where on the ray, in lengths of its direction, rounded once; inf for a miss")
    u = _field("u", "float32: the weight of the triangle's second corner, rounded once; 0 for a miss")
    v = _field("v", "float32: the weight of its third corner")
    primitive = _field("primitive", "uint32: the triangle's row in faces; no_primitive for a miss")

    @property
    def hit(self):
        """bool: whether anything is hit."""
        return self.primitive != no_primitive

    def positions(self, rays):
        """(..., 3) float32: origin + t * direction of the same rays, NaN for a miss.

        Computed in double and rounded once: off by the rounding of t, |t * direction| * 2^-24, along the ray.
        ValueError if the rays have another shape than the hits.
        """
        return _positions(self.t, self.hit, rays)


class _CrossingNumbers:
    t = _field("t", "float32: where on the ray, rounded once")
    primitive = _field("primitive", "uint32: the triangle's row in faces")
    side = _field("side", "int32: 1 along the triangle's normal, out of a solid whose normals point out, -1 against it")

    def positions(self, rays):
        """(..., 3) float32: origin + t * direction of the same rays, rounded as in Hits."""
        return _positions(self.t, True, rays)


class _ClosestPointNumbers:
    distance_squared = _field("distance_squared", "float64; inf where there is no point")
    point = _field("point", "(..., 3) float32, rounded once; zeros where there is no point")
    u = _field("u", "float32: the weight of the triangle's second corner")
    v = _field("v", "float32: the weight of its third corner")
    primitive = _field("primitive", "uint32: the triangle's row in faces; no_primitive where there is no point")

    @property
    def distance(self):
        """float64: the square root of distance_squared."""
        return np.sqrt(self.distance_squared)


class Hit(_HitNumbers, np.void):
    """A single hit: hits[i], with the properties and methods of Hits."""


class Crossing(_CrossingNumbers, np.void):
    """A single crossing: crossings[i], with the properties and methods of Crossings."""


class ClosestPoint(_ClosestPointNumbers, np.void):
    """A single closest point: points[i], with the properties of ClosestPoints."""


class Hits(_HitNumbers, _Records):
    """An array of hit_dtype: hits[mask] and hits["t"] work as in any array of records, and hits[i] is a Hit."""

    _record = Hit


class Crossings(_CrossingNumbers, _Records):
    """An array of crossing_dtype; crossings[i] is a Crossing."""

    _record = Crossing


class ClosestPoints(_ClosestPointNumbers, _Records):
    """An array of closest_point_dtype; points[i] is a ClosestPoint."""

    _record = ClosestPoint


class Lists:
    """What belongs to each ray: items[offsets[i]:offsets[i + 1]] is ray i's, in order; lists[i] the same.

    offsets: (n + 1,) int64; items: Hits or Crossings, (h,); ray: (h,) int64, the ray of each item.
    """

    def __init__(self, offsets, items):
        self.offsets, self.items = offsets, items

    def __len__(self):
        return len(self.offsets) - 1

    def __getitem__(self, ray):
        if not -len(self) <= ray < len(self):
            raise IndexError(f"ray {ray} of {len(self)}")
        ray %= len(self)
        return self.items[self.offsets[ray]:self.offsets[ray + 1]]

    @property
    def counts(self):
        """(n,) int64: how many items each ray has."""
        return np.diff(self.offsets)

    @property
    def ray(self):
        return np.repeat(np.arange(len(self)), self.counts)

    def positions(self, rays):
        """(h, 3) float32: origin + t * direction of the rays of the query. ValueError if their number differs."""
        rows, shape = ray_rows(rays)
        if shape != (len(self),):
            raise ValueError(f"rays: the shape must be {(len(self),)}, it is {shape}")
        return self.items.positions(rows[self.ray])

    def __repr__(self):
        return f"<raylanes.Lists of {len(self.items)} items of {len(self)} rays>"


def _positions(t, there_is, rays):
    rows, shape = ray_rows(rays)
    if shape != np.shape(t):
        raise ValueError(f"rays: the shape must be {np.shape(t)}, it is {shape}")
    parts = (rows["origin"], rows["direction"]) if rows.dtype.names else (rows[:, :3], rows[:, 4:7])
    origins, directions = (part.reshape(shape + (3,)).astype(np.float64) for part in parts)
    with np.errstate(invalid="ignore", over="ignore"):
        positions = origins + np.asarray(t, np.float64)[..., None] * directions
        return np.where(np.asarray(there_is)[..., None], positions, np.nan).astype(np.float32)
