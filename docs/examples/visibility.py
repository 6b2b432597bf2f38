"""Draws which parts of a landscape two watchers see: one low, one on a tower.

usage: visibility.py FOLDER      writes visibility.png
"""
import numpy as np

import raylanes
from figures import panels, save

side = 200  # hills: sums of bumps 1 / (1 + distance^2), so that each machine computes the same ones
x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side))
hills = [(-0.5, 0.4, 0.3, 0.35), (0.3, 0.5, 0.2, 0.25), (0.5, -0.3, 0.25, 0.3), (-0.3, -0.5, 0.2, 0.2),
         (0, 0, 0.1, 0.1)]
z = sum(height / (1 + ((x - at_x)**2 + (y - at_y)**2) / width**2) for at_x, at_y, width, height in hills)
vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
a = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
faces = np.concatenate([np.stack([a, a + 1, a + side + 1], axis=-1), np.stack([a, a + side + 1, a + side], axis=-1)])
tree = raylanes.Bvh(vertices, faces)

corners = vertices[faces]
normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
middles = corners.mean(axis=1)


def seen_from(watcher):
    """Whether the middle of each triangle is visible."""
    towards = np.sum(normals * (watcher - middles), axis=1) > 0
    # A segment leaves each hill that hides its end, and its own ground is an entry. So exits alone count, and no offset
    # is needed. A ray that begins at the ground would ask for facing="front".
    return towards & ~tree.occluded_from(watcher, middles, facing="back")


ground = np.array([-0.1, -0.9, z[10, 90]])
watchers = [ground + [0, 0, height] for height in (0.02, 0.5)]
seen = [seen_from(watcher) for watcher in watchers]

figure, axes = panels(*(f"{100 * part.mean():.0f} % in sight" for part in seen))
for panel, watcher, part in zip(axes, watchers, seen):
    panel.tripcolor(*vertices[:, :2].T, faces, part.astype(float), cmap="cividis", vmin=-0.3, vmax=1.1)
    panel.contour(x, y, z, np.arange(1, 20) / 25, colors="black", linewidths=0.4)
    panel.plot(*watcher[:2], "o", color="red", markeredgecolor="white")
save(figure, "visibility.png", *seen)
