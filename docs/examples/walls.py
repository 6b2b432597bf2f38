"""Draws an X-ray of three thin sheets in three ways, by rays straight down: half of them meet edges or corners.

usage: walls.py FOLDER      writes walls.png
"""
import numpy as np

import raylanes
from figures import panels, save

cells, per_cell, metre, offset = 48, 8, 128, np.float32(1e-3)  # the sheets are 48 cells wide, 3/8 of a metre


def wave(x):  # like a sine, of numbers that each machine computes alike
    f = 2 * (x - np.floor(x))
    return np.where(f < 1, 4 * f * (1 - f), -4 * (f - 1) * (2 - f))


def sheet(height, n):
    """The corners of a closed sheet: two surfaces that are one at the rim."""
    u, v = np.meshgrid(np.arange(cells + 1) / cells, np.arange(cells + 1) / cells)
    middle = height + 3 * wave(n * u / 6 + 0.3) * wave((n + 2) * v / 6 + 0.2 * height)
    thickness = 24 * u * (1 - u) * v * (1 - v) * (1.2 + wave(n * u * v / 2))
    for side in (1, -1):
        p = np.stack([u * cells, v * cells, middle + side * thickness], axis=-1) / metre
        a, b, c, d = p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]
        yield from (np.stack(corners[::side], axis=2).reshape(-1, 3) for corners in ([a, b, c], [a, c, d]))


def material(met, ray, place):
    """The material between every other distance and the next; infinite for a ray that never leaves."""
    inside = np.bincount(ray, minlength=len(rays)) % 2 == 1
    return np.where(inside, np.inf, np.bincount(ray, np.where(place % 2, met, -met), minlength=len(rays)))


vertices = np.concatenate([part for n in range(3) for part in sheet(8.0 * n, 4 + 3 * n)]).astype(np.float32)
tree = raylanes.Bvh(vertices, np.arange(len(vertices)).reshape(-1, 3))
pixels = cells * per_cell
x, y = np.meshgrid(np.arange(pixels) / np.float32(per_cell * metre), np.arange(pixels) / np.float32(per_cell * metre))
rays = raylanes.rays(np.stack([x, y, 1 + 0 * x], axis=-1).reshape(-1, 3).astype(np.float32), np.float32([0, 0, -1]))
ways = [material(lists.items.t, lists.ray, np.arange(len(lists.items)) - lists.offsets[lists.ray])
        for lists in (tree.all_hits(rays), tree.crossings(rays))]
steps, on = [], rays.copy()
while (hits := tree.closest(on)).hit.any():
    steps.append((hits.t[hits.hit], np.flatnonzero(hits.hit), np.full(hits.hit.sum(), len(steps))))
    on["tmin"] = np.where(hits.hit, hits.t + offset, np.inf)
ways.insert(0, material(*(np.concatenate(part) for part in zip(*steps))))

figure, axes = panels("on from each hit by an offset of 1 mm\nblack: rays that never leave a wall",
                      "each triangle that is hit, once\nwhite: an edge counts twice, so nothing is left",
                      "crossings by raylanes\neach passage counts once")
figure.set_figheight(4.2)
look = {"cmap": "gray", "vmin": 0, "vmax": 1, "interpolation": "nearest"}
for panel, way in zip(axes, ways):
    picture = np.exp(-12 * way).reshape(pixels, pixels)
    panel.imshow(picture, **look)
    zoom = panel.inset_axes([0.42, 0.48, 0.46, 0.46], xlim=(42, 106), ylim=(383, 319), xticks=[], yticks=[])
    zoom.imshow(picture, **look)
    zoom.spines[:].set_color("red")
    panel.indicate_inset_zoom(zoom, edgecolor="red", alpha=1)
save(figure, "walls.png", *ways)
