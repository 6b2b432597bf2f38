"""Draws a slice through a ball with holes: inside by one ray, by six, and by the winding number.

usage: winding.py FOLDER      writes winding.png
"""
import warnings

import numpy as np

import raylanes
from common import ball, unit
from figures import panels, save

pixels = 220
corners = ball(np.zeros(3), 1.0, 0.25, 24)
holes = unit(np.array([[0.9, 0.1, 0.45], [-0.2, -0.95, 0.1], [-0.75, 0.65, 0.1], [0.3, 0.9, -0.3]]))
kept = corners[(unit(corners.mean(axis=1)) @ holes.T < 0.93).all(axis=1)]
tree = raylanes.Bvh(kept.reshape(-1, 3), np.arange(3 * len(kept)).reshape(-1, 3))

axis = (np.arange(pixels) + 0.5) / pixels * 3 - 1.5
x, y = np.meshgrid(axis, axis)
points = np.stack([x, y, np.full_like(x, 0.071)], axis=-1)
with warnings.catch_warnings():
    warnings.simplefilter("ignore", raylanes.MeshWarning)  # "not closed": that is the point here
    levels = [np.where(tree.inside(points, rule=rule), 0.0, 1.0) for rule in ("parity", "vote")]
number = np.clip(tree.winding_numbers(points, accuracy=1e-6), 0, 1)

figure, axes = panels("parity of one ray", "vote of six rays", "winding number, line at 1/2")
for panel, level in zip(axes, (*levels, 1 - 0.8 * number)):
    panel.imshow(level, cmap="gray", vmin=0, vmax=1, origin="lower", extent=(-1.5, 1.5, -1.5, 1.5))
axes[2].contour(axis, axis, number, levels=[0.5], colors="tab:red", linewidths=1)
save(figure, "winding.png", *levels, number > 0.5)
