"""The picture of shadows.cpp in Python: rays from a camera, shadows of a light, rays to the sky.

    python3 shadows.py FOLDER
"""
import sys

import numpy as np

import raylanes
from common import ball, camera, floor, halved, mesh_of, unit, write_png

vertices, faces = mesh_of(ball([-0.7, 0, 0], 0.8, 0.3, 96), ball([0.9, -0.3, -0.3], 0.5, 0, 96), floor(4, -0.8))
tree = raylanes.Bvh(vertices, faces)

eye, directions = camera(1600, 1000)  # twice the picture's size
rays = raylanes.rays(eye, directions)
hits = tree.closest(rays)
seen = hits.hit
points = hits.positions(rays)[seen]  # where rays hit, and the normals there, on the side that is seen
corners = vertices[faces[hits.primitive[seen]]].astype(np.float64)
normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
normals *= -np.sign(np.sum(normals * directions[seen], axis=-1, keepdims=True))

light = np.array([3, -3, 4.0])
own = hits.primitive[seen]  # the triangle that a point lies on does not shadow it
dark = tree.occluded_from(light, points, skip=own)

row, column = np.nonzero(seen)
open_sky = np.ones(len(points))
for k in range(16):  # towards a spiral on the unit ball around the normal's tip: by the cosine, as light falls
    z, turn = (2 * k + 1) / 16 - 1, 2.4 * k + 0.6 * (column % 2 + 2 * (row % 2))
    r = np.sqrt(1 - z**2)
    spiral = np.stack([r * np.cos(turn), r * np.sin(turn), np.full_like(turn, z)], axis=-1)
    open_sky -= tree.occluded(raylanes.rays(points, normals + 0.99 * spiral, tmax=2), skip=own) / 16

lit = np.where(dark, 0, np.maximum(0, np.sum(normals * unit(light - points), axis=-1)))
levels = np.full(seen.shape, 0.9)
levels[seen] = np.sqrt(0.25 * open_sky + 0.65 * lit)
write_png(f"{sys.argv[1]}/shadows.png", halved(levels))
