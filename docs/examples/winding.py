"""Draws a slice through a ball with holes: inside by one ray, by six, and by the winding number.

usage: winding.py FOLDER      writes winding.png
"""
import pathlib
import sys

import numpy as np

import raylanes
from common import ball, write_png

pixels = 220
corners = ball(np.zeros(3), 1.0, 0.25, 24)
middles = corners.mean(axis=1)
middles /= np.linalg.norm(middles, axis=1, keepdims=True)
holes = np.array([[0.9, 0.1, 0.45], [-0.2, -0.95, 0.1], [-0.75, 0.65, 0.1], [0.3, 0.9, -0.3]])
holes /= np.linalg.norm(holes, axis=1, keepdims=True)
kept = corners[(middles @ holes.T < 0.93).all(axis=1)]
tree = raylanes.Bvh(kept.reshape(-1, 3), np.arange(3 * len(kept)).reshape(-1, 3))

axis = (np.arange(pixels) + 0.5) / pixels * 3 - 1.5
x, y = np.meshgrid(axis, axis[::-1])
points = np.stack([x, y, np.full_like(x, 0.071)], axis=-1)
levels = [np.where(tree.inside(points, rule=rule), 0.0, 1.0) for rule in ("parity", "vote")]
number = tree.winding_numbers(points)
levels.append(np.where(tree.inside(points, rule="winding"), 0.0, 1 - 0.8 * np.clip(number, 0, 1)))
levels = [np.pad(level, 4, constant_values=0.5) for level in levels]
write_png(pathlib.Path(sys.argv[1]) / "winding.png", np.concatenate(levels, axis=1))
