"""Draws solids within solids as X-rays see them: how far each ray runs in which, and the light that is left.

usage: solids.py FOLDER      writes solids.png
"""
import numpy as np

import raylanes
from common import ball
from figures import panels, save

# The flesh of a fruit, its stone, a kernel in the stone, and a hollow in the kernel; each is within the one before.
parts = [ball([0, 0, 0], 1, 0.12, 32), ball([0.1, 0, 0], 0.6, 0.2, 24), ball([0.15, 0.05, 0], 0.4, 0, 16),
         ball([0.2, 0.1, 0.1], 0.2, 0, 16)]
names, densities = ["flesh", "stone", "kernel", "hollow"], [0.3, 1.2, 0.6, 0]
solid = np.repeat(np.arange(4), [len(part) for part in parts])  # of each triangle
corners = np.concatenate(parts)
tree = raylanes.Bvh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))

pixels = 240
axis = (np.arange(pixels) - (pixels - 1) / 2) / 100
x, y = (k.ravel() for k in np.meshgrid(axis, axis))
lists = tree.crossings(raylanes.rays(np.stack([x, y, np.full_like(x, 3)], axis=-1), [0, 0, -1]))

# Each ray leaves a solid as often as it enters it, also through edges: the sum of side * t is the length within.
within = np.zeros((len(parts), len(lists)))
np.add.at(within, (solid[lists.items.primitive], lists.ray), lists.items.side * lists.items.t)
lengths = within - np.concatenate([within[1:], np.zeros((1, len(lists)))])  # without what is within the solid
light = np.exp(-np.tensordot(densities, lengths, 1)).reshape(pixels, pixels)
row = pixels // 2

figure, (image, chart) = panels("light that passes", "lengths of the dashed row")
image.imshow(light, "gray", origin="lower", extent=(-1.2, 1.2, -1.2, 1.2))
image.axhline(axis[row], color="orange", linestyle="--", linewidth=1)
chart.stackplot(axis, lengths.reshape(4, pixels, pixels)[:, row], labels=names)
chart.set(aspect="auto", yticks=[0, 1, 2], xlim=(-1.2, 1.2))
chart.legend(fontsize=8, loc="upper left")
save(figure, "solids.png", lengths)
