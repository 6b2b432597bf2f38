"""Draws a slice of signed distances through a hollow body: lines of equal distance, inside and outside.

usage: distance_lines.py FOLDER      writes distance_lines.png
"""
import numpy as np

import raylanes
from common import ball
from figures import panels, save

cavity = ball([0.25, 0.1, 0], 0.5, 0, 16)[:, ::-1]  # turned over: its normals point out of the material
corners = np.concatenate([ball([0, 0, 0], 1, 0.3, 24), cavity])
tree = raylanes.Bvh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))

axis = (np.arange(240) - 119.5) / 80
x, y = np.meshgrid(axis, axis)
distances = tree.signed_distances(np.stack([x, y, np.full_like(x, 0.3)], axis=-1))  # negative in the material

figure, (panel,) = panels("signed distance")
filled = panel.contourf(x, y, distances, np.arange(-6, 13) / 15, cmap="RdBu", vmin=-0.8, vmax=0.8, extend="max")
lines = panel.contour(x, y, distances, np.arange(-3, 6) / 5, colors="black", linewidths=0.6, linestyles="solid")
panel.clabel(lines, fmt="%.1f", fontsize=7)
panel.contour(x, y, distances, [0], colors="black", linewidths=2)
figure.colorbar(filled, shrink=0.8, ticks=np.arange(-2, 5) / 5)
save(figure, "distance_lines.png", distances)
