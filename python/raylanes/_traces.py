"""The steps that all calls with rays share, through trees and scenes."""

import numpy as np

from . import _native
from ._answer import Answer, overlap
from ._arrays import count_dtype, packed, ray_rows, rows, unsigned, vertices_of
from ._scalars import count, function, real, threads_of, word
from .hits import Lists
from .paths import chosen

EVERY_BIT = 0xFFFFFFFF


def nearest(numbers, kind, rays, out, active, ask):
    """Hits of the class `kind`. ask(rows of rays, Answer, bits of active rays) writes them, also apart."""
    given, shape = ray_rows(rays, numbers)
    initial = None if active is None else np.array(kind._miss, numbers.hit)
    answer = Answer(out, shape, numbers.hit, given, initial, strided=True)
    ask(given, answer, packed(active, shape))
    return answer.finish(kind)


def shadows(numbers, rays, out, active, ask):
    """Whether rays hit anything. ask(rows of rays, bytes to write, bits of active rays) writes the answers."""
    given, shape = ray_rows(rays, numbers)
    answer = Answer(out, shape, np.dtype(bool), given, None if active is None else False)
    ask(given, answer.rows.view(np.uint8), packed(active, shape))
    return answer.finish()


def listed(ask, kind, numbers, dtype, rays, max_count, facing, active, threads, progress, skip, masks):
    """Lists of items of the class `kind`, records of `dtype`, which ask() returns as bytes. skip: as rows."""
    given, shape = ray_rows(rays, numbers)
    if len(shape) != 1:
        raise ValueError(f"rays: lists are of rays in one dimension, the shape is {shape}")
    limit = 0xFFFFFFFF if max_count is None else count("max_count", max_count, 0xFFFFFFFF)
    offsets, items = ask(given, limit, word("facing", facing), chosen(), threads_of(threads), packed(active, shape),
                         function("progress", progress), skip, masks)
    return Lists(offsets.view(np.int64), items.view(dtype).view(kind))


def counted(ask, numbers, rays, out, facing, active, threads, progress, skip, masks):
    """The crossings of each ray, which ask() counts. skip: as rows."""
    given, shape = ray_rows(rays, numbers)
    answer = Answer(out, shape, count_dtype, given, None if active is None else np.zeros((), count_dtype))
    ask(given, answer.rows, word("facing", facing), chosen(), threads_of(threads), packed(active, shape),
        function("progress", progress), skip, masks)
    return answer.finish()


def shadows_from(numbers, origin, points, ends, out, active, ask):
    """Whether anything lies on segments: ask(origin, rows of points, bytes to write, ends, bits of active points)."""
    start, end = ends
    ends = real("start", start, numbers.real), real("end", end, numbers.real)
    return _shadows_of("origin", "origins=A, directions=B - A, tmax=1", numbers, origin, points, ends, out, active, ask)


def shadows_towards(numbers, direction, points, out, active, ask):
    """Whether anything lies in a direction: ask() as in shadows_from(), without ends."""
    return _shadows_of("direction", "origins=points, directions=D", numbers, direction, points, None, out, active, ask)


def _shadows_of(name, instead, numbers, light, points, ends, out, active, ask):
    given, shape = rows("points", points, 3, numbers.real)
    size = np.size(light)
    if size > 3 and np.shape(light)[-1] == 3:
        raise ValueError(f"{name}: one is needed, three numbers, not {size // 3} of them; with one for each point call "
                         f"occluded({instead})")
    light = vertices_of(name, np.reshape(light, (1, -1)), numbers.real)[0]
    answer = Answer(out, shape, np.dtype(bool), (given,), None if active is None else False)
    ask(light, given, answer.rows.view(np.uint8), ends, packed(active, shape))
    return answer.finish()


if _native.how_names != ("test", "grade", "mode", "hint", "path", "threads", "facing", "progress", "skip", "masks"):
    raise ImportError(f"raylanes: the native module is another version's; it asks for {_native.how_names}")


def how(test, grade, mode, hint, facing, threads, progress, skip, masks=None):
    """The options of a trace as the native module takes them: what its how_names say, in this order."""
    return (word("test", test), word("grade", grade), word("mode", mode), word("hint", hint), chosen(),
            threads_of(threads), word("facing", facing), function("progress", progress), skip, masks)


def masked(mask, masks, filter_mask=EVERY_BIT):
    """The words of triangles and what they are compared with, as the native module takes them; None: there are none."""
    bits, asked = count("mask", mask, EVERY_BIT), count("filter_mask", filter_mask, EVERY_BIT)
    return None if masks is None else (bits, words_of(masks), asked)


def words_of(masks):
    """The words of triangles as the native module takes them."""
    words = np.ascontiguousarray(unsigned("masks", masks), "<u4")
    if words.ndim != 1:
        raise ValueError(f"masks: the shape must be (n,), it is {words.shape}")
    return words


def skipped(skip):
    """The index of a primitive for each ray, by indices or by records that name one, as the native module takes it."""
    if skip is None:
        return None
    given = np.asarray(skip)
    names = given["primitive"] if given.dtype.names and "primitive" in given.dtype.names else unsigned("skip", given)
    return np.ascontiguousarray(names, "<u4").reshape(-1)


def named_in_scene(name, records):
    """Rows of a primitive and its instance, which any records of scenes name."""
    given = np.asarray(records)
    if given.dtype.names is None or not {"primitive", "instance"} <= set(given.dtype.names):
        raise TypeError(f"{name}: records that name a primitive and an instance are needed, not {given.dtype}")
    return np.stack([given["primitive"].reshape(-1), given["instance"].reshape(-1)], axis=-1).astype(np.uint32)


def hits_after(after, answer):
    """The rows of hits after which the next are asked for: rows of `out` itself, or a copy. None stays None."""
    if after is None:
        return None
    hits, dtype, shape = np.asarray(after), answer.array.dtype, answer.array.shape
    if hits.dtype.names != dtype.names or hits.dtype["t"] != dtype["t"]:
        raise TypeError(f"after: hits of this tree or scene are needed, records of {dtype}, not {hits.dtype}")
    if hits.shape != shape:
        raise ValueError(f"after: the shape must be {shape}, it is {hits.shape}")
    if after is answer.out:
        return answer.rows
    hits = hits.reshape(-1).astype(dtype, copy=False)  # numpy.where() drops the padding of records
    return hits.copy() if overlap(hits, answer.rows) or hits.size > 1 > hits.strides[0] else hits


def filter_of(filter, kind, dtype):
    """The filter as the native module calls it: with bytes, for bytes. kind, dtype: the class and the type of hits."""
    if filter is None:
        return None
    if not callable(filter):
        raise TypeError(f"filter: a function is needed, not {type(filter).__name__}")

    def rejected(indices, hits):
        indices = indices.view(np.uintp).astype(np.int64)
        answer = np.asarray(filter(indices, hits.view(dtype).view(kind)))
        if answer.dtype != np.bool_:
            raise TypeError(f"filter: it must return booleans, not {answer.dtype}")
        if answer.shape != indices.shape:
            raise ValueError(f"filter: it must return the shape {indices.shape}, not {answer.shape}")
        return np.ascontiguousarray(answer)

    return rejected
