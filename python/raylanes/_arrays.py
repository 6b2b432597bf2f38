"""Arrays as the library reads and writes them: their types, and how others become such."""

from typing import Any, NamedTuple

import numpy as np

no_primitive = 0xFFFFFFFF
"""The primitive of a ray that hits nothing."""

ray_dtype = np.dtype([("origin", "<f4", 3), ("tmin", "<f4"), ("direction", "<f4", 3), ("tmax", "<f4")])
"""A ray: the points origin + t * direction with tmin <= t <= tmax; t counts in lengths of the direction."""

hit_dtype = np.dtype([("t", "<f4"), ("u", "<f4"), ("v", "<f4"), ("primitive", "<u4")])
"""A hit at (1-u-v)*v0 + u*v1 + v*v2 of the triangle `primitive`; a miss has t = inf, u = v = 0, no_primitive."""

no_part = 0xFFFFFFFF
"""The geometry and the instance of a ray that hits nothing in a scene."""

scene_hit_dtype = np.dtype([("t", "<f4"), ("u", "<f4"), ("v", "<f4"), ("primitive", "<u4"), ("geometry", "<u4"),
                            ("instance", "<u4")])
"""A hit in a scene: a hit_dtype, and what was hit; a miss has no_part twice."""

crossing_dtype = np.dtype([("t", "<f4"), ("primitive", "<u4"), ("side", "<i4")])
"""A crossing of the surface; side 1 along the normal, out of a solid, -1 against it."""

scene_crossing_dtype = np.dtype([*crossing_dtype.descr, ("geometry", "<u4"), ("instance", "<u4")])
"""A crossing of the surface of an instance: a crossing_dtype, and whose."""

double_ray_dtype = np.dtype(
    [("origin", "<f8", 3), ("tmin", "<f8"), ("direction", "<f8", 3), ("tmax", "<f8")])
"""A ray of float64; otherwise as ray_dtype."""

double_hit_dtype = np.dtype({"names": ["t", "u", "v", "primitive"], "formats": ["<f8", "<f8", "<f8", "<u4"],
                             "itemsize": 32})
"""A hit of float64; otherwise as hit_dtype."""

double_crossing_dtype = np.dtype([("t", "<f8"), ("primitive", "<u4"), ("side", "<i4")])
"""A crossing of a ray of float64; otherwise as crossing_dtype."""

stretch_dtype = np.dtype([("entry", "<f4"), ("exit", "<f4"), ("entered_by", "<u4"), ("left_by", "<u4"),
                          ("winding", "<i4")])
"""A stretch of a ray within a solid; no_primitive where the ray itself begins or ends."""

scene_stretch_dtype = np.dtype([*stretch_dtype.descr, ("geometry", "<u4"), ("instance", "<u4")])
"""A stretch of a ray within an instance: a stretch_dtype, and of which."""

double_stretch_dtype = np.dtype({"names": ["entry", "exit", "entered_by", "left_by", "winding"],
                                 "formats": ["<f8", "<f8", "<u4", "<u4", "<i4"], "itemsize": 32})
"""A stretch of a ray of float64; otherwise as stretch_dtype."""

count_dtype = np.dtype([("crossings", "<u4"), ("winding", "<i4")])
"""How many crossings, and the sum of their sides."""

closest_point_dtype = np.dtype(
    [("distance_squared", "<f8"), ("point", "<f4", 3), ("u", "<f4"), ("v", "<f4"), ("primitive", "<u4")])
"""The closest point of a mesh; where there is none distance_squared = inf, no_primitive."""

double_closest_point_dtype = np.dtype({
    "names": ["distance_squared", "distance", "point", "u", "v", "primitive"],
    "formats": ["<f8", "<f8", ("<f8", 3), "<f8", "<f8", "<u4"], "itemsize": 64})
"""The closest point of a mesh of float64; otherwise as closest_point_dtype."""

scene_closest_point_dtype = np.dtype([*closest_point_dtype.descr, ("geometry", "<u4"), ("instance", "<u4")])
"""The closest point of a scene: a closest_point_dtype in its space, and of what; no_part twice where there is none."""

double_scene_hit_dtype = np.dtype({
    "names": ["t", "u", "v", "primitive", "geometry", "instance"],
    "formats": ["<f8", "<f8", "<f8", "<u4", "<u4", "<u4"], "itemsize": 40})
"""A hit in a scene of float64; otherwise as scene_hit_dtype."""

double_scene_crossing_dtype = np.dtype([*double_crossing_dtype.descr, ("geometry", "<u4"), ("instance", "<u4")])
"""A crossing of the surface of an instance in a scene of float64; otherwise as scene_crossing_dtype."""

double_scene_stretch_dtype = np.dtype({
    "names": ["entry", "exit", "entered_by", "left_by", "winding", "geometry", "instance"],
    "formats": ["<f8", "<f8", "<u4", "<u4", "<i4", "<u4", "<u4"], "offsets": [0, 8, 16, 20, 24, 32, 36],
    "itemsize": 40})
"""A stretch of a ray within an instance of a scene of float64; otherwise as scene_stretch_dtype."""

double_scene_closest_point_dtype = np.dtype({
    "names": ["distance_squared", "distance", "point", "u", "v", "primitive", "geometry", "instance"],
    "formats": ["<f8", "<f8", ("<f8", 3), "<f8", "<f8", "<u4", "<u4", "<u4"], "itemsize": 72})
"""The closest point of a scene of float64; otherwise as scene_closest_point_dtype."""

containing_part_dtype = np.dtype({"names": ["geometry", "instance", "location"], "formats": ["<u4", "<u4", "u1"],
                                  "itemsize": 12})
"""An instance that contains a point: INSIDE or ON its surface; of none no_part twice, OUTSIDE."""


class Numbers(NamedTuple):
    """The types of a tree's coordinates and records."""
    real: np.dtype
    ray: np.dtype
    hit: np.dtype
    crossing: np.dtype
    stretch: np.dtype
    closest_point: np.dtype


FLOATS = Numbers(np.dtype(np.float32), ray_dtype, hit_dtype, crossing_dtype, stretch_dtype, closest_point_dtype)
DOUBLES = Numbers(np.dtype(np.float64), double_ray_dtype, double_hit_dtype, double_crossing_dtype,
                  double_stretch_dtype, double_closest_point_dtype)
SCENES = FLOATS._replace(hit=scene_hit_dtype, crossing=scene_crossing_dtype, stretch=scene_stretch_dtype,
                         closest_point=scene_closest_point_dtype)
DOUBLE_SCENES = DOUBLES._replace(hit=double_scene_hit_dtype, crossing=double_scene_crossing_dtype,
                                 stretch=double_scene_stretch_dtype, closest_point=double_scene_closest_point_dtype)


def numbers_for(dtype, *arrays):
    """The numbers of that type. If it is None, those that keep the arrays: float64 but for float32 or float16."""
    if dtype is None:
        return FLOATS if all(array.dtype.kind == "f" and array.itemsize <= 4 for array in arrays) else DOUBLES
    try:
        wanted = np.dtype(dtype)
    except TypeError:
        wanted = dtype
    for kind in (FLOATS, DOUBLES):
        if kind.real == wanted:
            return kind
    raise TypeError(f"dtype: numpy.float32 or numpy.float64 is needed, not {wanted!r}")


def numbers(name, values):
    """An array of real numbers, whatever `values` are."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name}: real numbers are needed, not {array.dtype}")
    return array


def rows(name, values, columns, real):
    """(rows, shape): numbers of the type `real` in rows of `columns`, no copy where the layout allows, and the shape
    without the last axis."""
    array = numbers(name, values)
    if array.shape == (0,):
        array = array.reshape(0, columns)
    if array.ndim == 0 or array.shape[-1] != columns:
        raise ValueError(f"{name}: the last of its axes must have {columns} numbers, its shape is {array.shape}")
    shape = array.shape[:-1]
    return strided(array.astype(real, copy=False).reshape(count_of(shape), columns)), shape


def count_of(shape):
    count = 1
    for length in shape:
        count *= length
    return count


def strided(array):
    """The same rows, copied unless each is contiguous and behind the one before."""
    step, within = array.strides
    fits = within == array.itemsize and step >= array.shape[1] * array.itemsize
    return array if fits or array.size == 0 else np.ascontiguousarray(array)


def vertices_of(name, values, real):
    """(n, 3) numbers of the type `real`."""
    array, shape = rows(name, values, 3, real)
    if len(shape) != 1:
        raise ValueError(f"{name}: the shape must be (n, 3), it is {shape + (3,)}")
    return array


def changes(values, rounded):
    """Whether a finite number of `values` is another one in `rounded`, which has the same shape."""
    if values.dtype.kind == "f":
        return values.itemsize > rounded.itemsize and bool(((values != rounded) & np.isfinite(values)).any())
    bits = np.finfo(rounded.dtype).nmant + 1
    if 8 * values.itemsize <= bits:
        return False
    # A float holds an integer from its highest bit to its lowest one, if these are at most so many bits.
    size = values.astype(np.uint64)
    size = np.where(values < 0, np.negative(size), size)
    return bool((size >> np.uint64(bits) >= (size & np.negative(size)))[size != 0].any())


def require_kept(name, given, kept, advice):
    """Refuses numbers that the type of `kept` would round without being asked to."""
    if changes(given.reshape(kept.shape), kept):
        raise ValueError(f"{name}: {kept.dtype} does not hold these {given.dtype} numbers; {advice}")


def equal_corners(vertices, faces):
    """How many triangles have two equal corners."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    return int(np.count_nonzero((a == b).all(axis=1) | (b == c).all(axis=1) | (c == a).all(axis=1)))


def positions_of(points):
    """(n,) int64: equal numbers for equal rows."""
    order = np.lexsort(points.T)
    ordered = points[order]
    number = np.zeros(len(points), np.int64)
    number[order[1:]] = np.cumsum((ordered[1:] != ordered[:-1]).any(axis=1))
    return number


def stand_ins(name, values):
    """(n, 3) float32 that are equal where the vertices are, and not finite where these are not."""
    array = np.asarray(values)
    real = numbers_for(None, numbers(name, array)).real
    kept = vertices_of(name, array, real)
    if real == np.float32:
        return kept
    position = positions_of(array.reshape(kept.shape))
    made = np.stack([position % 4096, position // 4096 % 4096, position // 4096**2], axis=1).astype(np.float32)
    return np.where(np.isfinite(kept), made, kept).astype(np.float32)


def volume_of(vertices, faces):
    """The volume within a closed mesh: negative if its normals point inwards, 0 if rounding may have made the sign."""
    if len(faces) == 0:
        return 0.0
    corners = np.asarray(vertices, np.float64)[faces]
    a, b, c = np.moveaxis(corners - corners[0, 0], 1, 0)
    terms = np.concatenate([a * np.roll(b, -1, 1) * np.roll(c, 1, 1), -a * np.roll(b, 1, 1) * np.roll(c, -1, 1)])
    volume = float(terms.sum())
    return volume / 6 if abs(volume) > 2**-20 * float(np.abs(terms).sum()) else 0.0


def faces_of(values):
    """(m, 3) int32 or uint32; other integers only with values that one of the two has."""
    array = np.asarray(values)
    if array.shape == (0,):
        array = np.zeros((0, 3), np.uint32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"faces: integers are needed, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"faces: the shape must be (m, 3), it is {array.shape}")
    if array.dtype not in (np.int32, np.uint32) or not array.dtype.isnative:
        array = narrowed(array)
    return strided(array)


def narrowed(faces):
    low, high = (int(faces.min()), int(faces.max())) if faces.size else (0, 0)
    for dtype in (np.int32, np.uint32):
        if np.iinfo(dtype).min <= low and high <= np.iinfo(dtype).max:
            return faces.astype(dtype)
    raise ValueError(f"faces: vertices {low} to {high}, which 32 bits do not hold")


class RayParts(NamedTuple):
    """Origins, directions and ends as a caller gives them; shapes are broadcast."""
    origins: Any
    directions: Any
    tmin: Any
    tmax: Any

    def checked(self):
        """(parts, shape): arrays of real numbers, and the shape of the rays."""
        parts = [numbers(name, part) for name, part in zip(self._fields, self)]
        for name, part in zip(("origins", "directions"), parts):
            if part.ndim == 0 or part.shape[-1] != 3:
                raise ValueError(f"{name}: the last of its axes must have 3 numbers, its shape is {part.shape}")
        shapes = [part.shape[:-1] for part in parts[:2]] + [part.shape for part in parts[2:]]
        longest = max(shapes, key=len)
        if all(shape in ((), longest) for shape in shapes):  # NumPy's function costs more than a query of few rays
            return parts, longest
        try:
            return parts, np.broadcast_shapes(*shapes)
        except ValueError:
            raise ValueError("origins, directions, tmin, tmax: the shapes "
                             f"{', '.join(str(part.shape) for part in parts)} cannot be broadcast") from None


def given_rays(rays, origins, directions, tmin=None, tmax=None):
    """The rays of a call: `rays`, or RayParts in their place."""
    if rays is not None and origins is directions is tmin is tmax is None:
        return rays
    if rays is None and origins is not None and directions is not None:
        return RayParts(origins, directions, 0.0 if tmin is None else tmin, np.inf if tmax is None else tmax)
    all_of_them = {"rays": rays, "origins": origins, "directions": directions, "tmin": tmin, "tmax": tmax}
    given = [name for name, value in all_of_them.items() if value is not None]
    raise TypeError(f"rays: either rays alone or origins and directions are needed, not {', '.join(given) or None}")


def rays(origins, directions, tmin=0.0, tmax=np.inf, dtype=None):
    """Make an array of rays. Shapes are broadcast.

    Queries take origins and directions without this array: Bvh.closest(origins=..., directions=...).

    A ray is the segment of points origin + t * direction with tmin <= t <= tmax, both ends included. Directions need
    not be normalised: t is measured in their lengths. A ray hits nothing if its origin or direction is not finite, its
    direction is zero, tmin or tmax is NaN, or tmin > tmax.

    Parameters
    ----------
    origins, directions : array of float, shape (..., 3)
        Any real numbers.
    tmin, tmax : float or array of float, shape (...)
        Default 0 and inf.
    dtype : {numpy.float32, numpy.float64}, optional
        The type of the rays' numbers. By default float32 if origins and directions are float32 or float16, else
        float64, which keeps them.

    Returns
    -------
    ndarray of ray_dtype or double_ray_dtype
        The fields origin, tmin, direction and tmax.

    Examples
    --------
    >>> raylanes.rays([0, 0, 5], [[0, 0, -1], [0, 1, 0]], tmax=10)["tmax"]
    array([10., 10.])
    """
    parts, shape = RayParts(origins, directions, tmin, tmax).checked()
    made = np.empty(shape, numbers_for(dtype, *parts[:2]).ray)
    made["origin"], made["direction"], made["tmin"], made["tmax"] = parts
    return made


def ray_rows(values, kind):
    """(given, shape): rays as records or in rows of eight numbers, no copy where type and layout allow. RayParts
    become a tuple of rows: origins, directions, tmin, tmax."""
    if isinstance(values, RayParts):
        parts, shape = values.checked()
        return tuple(_spread(part, shape, part.shape[-1:] if i < 2 else (), kind.real)
                     for i, part in enumerate(parts)), shape
    array = np.asarray(values)
    if array.dtype in (ray_dtype, double_ray_dtype):
        array = array.astype(kind.ray, copy=False)
        if array.ndim == 1 and (array.strides[0] >= array.itemsize or array.size < 2):
            return array, array.shape
        return np.ascontiguousarray(array).reshape(-1), array.shape
    if array.dtype.kind == "V":
        raise TypeError(f"rays: records must be of raylanes.ray_dtype or double_ray_dtype, not {array.dtype}")
    array = numbers("rays", array)
    columns = array.shape[-1] if array.ndim else 0
    if columns == 6:  # origin, direction
        made = rays(array[..., :3], array[..., 3:], dtype=kind.real)
        return made.reshape(-1), made.shape
    if columns != 8 and array.shape != (0,):
        raise ValueError("rays: records of raylanes.ray_dtype, or numbers in an axis of 6 (origin, direction) or 8 "
                         f"(origin, tmin, direction, tmax) are needed, the shape is {array.shape}")
    return rows("rays", array, 8, kind.real)


def lines(values, kind):
    """(origins, directions, shape): rows of three numbers each."""
    given, shape = ray_rows(values, kind)
    if isinstance(given, tuple):
        return given[0], given[1], shape
    if given.dtype.names:
        return given["origin"], given["direction"], shape
    return given[:, :3], given[:, 4:7], shape


def _spread(part, shape, columns, real):
    """A part for each ray of that shape: rows of `columns`, no copy where one step from row to row, 0 for a shared
    part, says where they lie."""
    part = part.astype(real, copy=False)
    if columns and part.strides[-1] != part.itemsize:
        part = np.ascontiguousarray(part)
    rows = (count_of(shape), *columns)
    if rows[0] == 1 or part.shape == shape + columns:
        flat = part.reshape(rows)
    elif part.ndim == len(columns):  # shared
        return np.ndarray(rows, real, part, 0, (0, *part.strides))
    else:
        flat = np.broadcast_to(part, shape + columns).reshape(rows)
    return flat if flat.size == 0 or flat.strides[0] >= 0 else np.ascontiguousarray(flat)


def unsigned(name, values):
    """Integers of 32 bits: indices or masks."""
    if type(values) is int and 0 <= values <= 0xFFFFFFFF:
        return np.array(values, np.uint32)
    array = np.asarray(values)
    if array.dtype.kind not in "iu" and array.shape != (0,):
        raise TypeError(f"{name}: integers are needed, not {array.dtype}")
    if array.dtype == np.uint32:
        return array
    low, high = (int(array.min()), int(array.max())) if array.size else (0, 0)
    if low < 0 or high > 0xFFFFFFFF:
        raise ValueError(f"{name}: {low if low < 0 else high} is out of range, allowed are 0 to 2^32 - 1")
    return array.astype(np.uint32)


def packed(active, shape):
    """The bits of a mask of that shape; None stays None."""
    if active is None:
        return None
    mask = np.asarray(active)
    if mask.dtype != np.bool_:
        raise TypeError(f"active: booleans are needed, not {mask.dtype}")
    if mask.shape != shape:
        raise ValueError(f"active: the shape must be {shape}, it is {mask.shape}")
    return np.packbits(mask.reshape(-1), bitorder="little")
