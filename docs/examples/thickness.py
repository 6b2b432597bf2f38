"""Draws how thick the wall of a hollow body is, from each visible point along the normal to the next exit.

usage: thickness.py FOLDER      writes thickness.png
"""
import numpy as np

import raylanes
from common import ball
from figures import panels, save

cavity = ball([0.1, 0.15, 0.1], 0.55, 0, 32)[:, ::-1]  # turned over: its normals point out of the material
corners = np.concatenate([ball([0, 0, 0], 1, 0.15, 48), cavity])
vertices, faces = corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)
tree = raylanes.Bvh(vertices, faces)

axis = (np.arange(300) - 149.5) / 125
x, y = np.meshgrid(axis, axis)
rays = raylanes.rays(np.stack([x, y, np.full_like(x, 3)], axis=-1), [0, 0, -1])
hits = tree.closest(rays)
points, normals = hits.positions(rays)[hits.hit], hits.normals(vertices, faces)[hits.hit]
# The surface at a ray's origin is an entry, never the next exit, so no offset is needed.
exits = tree.closest(raylanes.rays(points, -normals), facing="back")

wall = np.full(hits.shape, np.nan)
wall[hits.hit] = exits.t
thinnest = points[np.argmin(exits.t)]

figure, (panel,) = panels(f"thickness, at least {exits.t.min():.3f}")
figure.colorbar(panel.imshow(wall, "viridis_r", extent=(-1.2, 1.2, -1.2, 1.2), origin="lower"), shrink=0.8)
panel.plot(*thinnest[:2], "o", color="red", markeredgecolor="white")
save(figure, "thickness.png", wall)
