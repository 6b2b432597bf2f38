"""The picture of shadows.cpp in Python: rays from a camera, shadows of a light, rays to the sky.

    python3 shadows.py FOLDER
"""
import sys

import numpy as np

import raylanes
from common import ball, camera, floor, mesh_of, unit, write_png

vertices, faces = mesh_of(ball([-0.7, 0, 0], 0.8, 0.3, 24), ball([0.9, -0.3, -0.3], 0.5, 0, 24), floor(4, -0.8))
tree = raylanes.Bvh(vertices, faces)

eye, directions = camera(320, 200)
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

k = np.arange(16)  # towards a spiral on the unit ball around the normal's tip: by the cosine, as light falls
z = (2 * k + 1) / 16 - 1
spiral = np.stack([np.sqrt(1 - z**2) * np.cos(2.4 * k), np.sqrt(1 - z**2) * np.sin(2.4 * k), z], axis=-1)
to_sky = raylanes.rays(points[:, None], normals[:, None] + 0.99 * spiral, tmax=2)
open_sky = 1 - tree.occluded(to_sky, skip=np.repeat(own, 16)).mean(axis=-1)

lit = np.where(dark, 0, np.maximum(0, np.sum(normals * unit(light - points), axis=-1)))
levels = np.full(seen.shape, 0.9)
levels[seen] = np.sqrt(0.25 * open_sky + 0.65 * lit)
write_png(f"{sys.argv[1]}/shadows.png", levels)
