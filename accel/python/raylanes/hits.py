"""Answers: arrays of records, with a property for each number."""

import numpy as np

from .arrays import no_primitive, ray_rows


def _field(name, meaning):
    return property(lambda self: self[name].view(np.ndarray), doc=meaning)


class Hits(np.ndarray):
    """An array of hit_dtype; hits[mask], hits["t"] and all else are as of any array of records."""

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
        """
        return _positions(self.t, self.hit, rays)


class Crossings(np.ndarray):
    """An array of crossing_dtype."""

    t = _field("t", "float32: where on the ray, rounded once")
    primitive = _field("primitive", "uint32: the triangle's row in faces")
    side = _field("side", "int32: 1 along the triangle's normal, out of a solid whose normals point out, -1 against it")

    def positions(self, rays):
        """(..., 3) float32, as of Hits."""
        return _positions(self.t, True, rays)


class ClosestPoints(np.ndarray):
    """An array of closest_point_dtype."""

    distance_squared = _field("distance_squared", "float64; inf where there is no point")
    point = _field("point", "(..., 3) float32, rounded once; zeros where there is no point")
    u = _field("u", "float32: the weight of the triangle's second corner")
    v = _field("v", "float32: the weight of its third corner")
    primitive = _field("primitive", "uint32: the triangle's row in faces; no_primitive where there is no point")

    @property
    def distance(self):
        """float64: the square root of distance_squared."""
        return np.sqrt(self.distance_squared)


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
        """(h, 3) float32 of the rays that were asked with."""
        return self.items.positions(ray_rows(rays)[0][self.ray])

    def __repr__(self):
        return f"<raylanes.Lists of {len(self.items)} items of {len(self)} rays>"


def _positions(t, there_is, rays):
    rows, shape = ray_rows(rays)
    columns = rows.view(np.float32).reshape(-1, 8) if rows.dtype.names else rows
    columns = columns.reshape(shape + (8,)).astype(np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        positions = columns[..., :3] + t.astype(np.float64)[..., None] * columns[..., 4:7]
        return np.where(np.asarray(there_is)[..., None], positions, np.nan).astype(np.float32)
