"""The steps that all calls with rays share, through trees and scenes."""

import numpy as np

from ._answer import Answer, overlap
from ._arrays import packed, ray_rows, rows, vertices_of
from ._scalars import function, real, threads_of, word
from .paths import chosen


def nearest(numbers, kind, rays, out, active, ask, strided=True):
    """Hits of the class `kind`. ask(rows of rays, Answer, bits of active rays) writes them; strided: also apart."""
    given, shape = ray_rows(rays, numbers)
    initial = None if active is None else np.array(kind._miss, numbers.hit)
    answer = Answer(out, shape, numbers.hit, (given,), initial, strided=strided)
    ask(given, answer, packed(active, shape))
    return answer.finish(kind)


def shadows(numbers, rays, out, active, ask):
    """Whether rays hit anything. ask(rows of rays, bytes to write, bits of active rays) writes the answers."""
    given, shape = ray_rows(rays, numbers)
    answer = Answer(out, shape, np.dtype(bool), (given,), None if active is None else False)
    ask(given, answer.rows.view(np.uint8), packed(active, shape))
    return answer.finish()


def shadows_from(numbers, origin, points, ends, out, active, ask):
    """Whether anything lies on segments: ask(origin, rows of points, bytes to write, ends, bits of active points)."""
    given, shape = rows("points", points, 3, numbers.real)
    light = vertices_of("origin", np.reshape(origin, (1, -1)), numbers.real)[0]
    answer = Answer(out, shape, np.dtype(bool), (given,), None if active is None else False)
    start, end = ends
    end = numbers.end if end is None else end
    ask(light, given, answer.rows.view(np.uint8),
        (real("start", start, numbers.real), real("end", end, numbers.real)), packed(active, shape))
    return answer.finish()


def how(test, grade, mode, hint, facing, threads, progress):
    """The options of a trace as the native module takes them."""
    names = zip(("test", "grade", "mode", "hint"), (test, grade, mode, hint))
    return (*(word(*named) for named in names), chosen(), threads_of(threads), word("facing", facing),
            function("progress", progress))


def hits_behind(after, answer):
    """The rows of hits behind which the next are asked for: rows of `out` itself, or a copy."""
    hits, dtype, shape = np.asarray(after), answer.array.dtype, answer.array.shape
    if hits.dtype != dtype:
        raise TypeError(f"after: hits of this tree or scene are needed, records of {dtype}, not {hits.dtype}")
    if hits.shape != shape:
        raise ValueError(f"after: the shape must be {shape}, it is {hits.shape}")
    if after is answer.out:
        return answer.rows
    hits = hits.reshape(-1)
    return hits.copy() if overlap(hits, answer.rows) or hits.size > 1 > hits.strides[0] else hits
