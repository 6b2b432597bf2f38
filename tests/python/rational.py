"""Hits in exact rational arithmetic, by Cramer's rule: nothing in common with how the library decides."""

from fractions import Fraction

import numpy as np


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def minus(a, b):
    return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]


def fractions(numbers):
    return [Fraction(float(x)) for x in numbers]


def rounded(number, dtype=np.float32):
    """To the nearest number of that type, of two the even one."""
    if dtype == np.float64:
        return np.float64(number.numerator / number.denominator)  # which Python rounds correctly
    near = np.float32(float(number))
    candidates = [near, np.nextafter(near, np.float32(-np.inf)), np.nextafter(near, np.float32(np.inf))]
    return min(candidates, key=lambda f: (abs(Fraction(float(f)) - number), int(f.view(np.uint32)) & 1))


def hit(ray, corners):
    """(t, u, v) as fractions; None where the ray misses. Segments are closed."""
    origin, direction = fractions(ray["origin"]), fractions(ray["direction"])
    v0, v1, v2 = corners
    e1, e2 = minus(v1, v0), minus(v2, v0)
    p, s = cross(direction, e2), minus(origin, v0)
    determinant = dot(e1, p)
    if determinant == 0:
        return None
    q = cross(s, e1)
    u, v, t = dot(s, p) / determinant, dot(direction, q) / determinant, dot(e2, q) / determinant
    tmin, tmax = float(ray["tmin"]), float(ray["tmax"])
    return (t, u, v) if u >= 0 and v >= 0 and u + v <= 1 and tmin <= t <= tmax else None


def all_hits(ray, vertices, faces, dtype=np.float32):
    """[(t, u, v, primitive)] rounded once, in the order of t and then of primitives."""
    found = []
    for primitive, face in enumerate(faces):
        numbers = hit(ray, [fractions(vertices[i]) for i in face])
        if numbers:
            found.append((*(rounded(number, dtype) for number in numbers), primitive))
    return sorted(found, key=lambda h: (h[0], h[3]))
