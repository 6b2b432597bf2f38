"""Draws which points two rules place on the wrong side of a scan with holes: parity, and the winding number.

usage: scan_points.py FOLDER      writes scan_points.png
"""
import warnings

import numpy as np

import raylanes
from common import ball, unit
from figures import panels, save


def tree_of(corners):
    return raylanes.Bvh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


body = ball([0, 0, 0], 1, 0.25, 32)
towards = unit(body.mean(axis=1))
holes = unit(np.array([[0.9, 0.1, 0.45], [-0.2, -0.95, 0.1], [-0.75, 0.65, 0.1], [0.3, 0.2, 0.9], [0, -0.4, -0.9]]))
scan = body[((towards[:, None] * holes).sum(axis=-1) < 0.95).all(axis=1)]

axis = (np.arange(28) - 13.5) / 10
points = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
truth = tree_of(body).inside(points)
tree = tree_of(scan)
with warnings.catch_warnings():
    warnings.simplefilter("ignore", raylanes.MeshWarning)  # "not closed": that is the point here
    wrong = [tree.inside(points, rule=rule) != truth for rule in ("parity", "winding")]

figure, axes = panels(*(f"{rule}: {part.sum():,} of {len(points):,} points wrong"
                        for rule, part in zip(("parity", "winding number"), wrong)))
middles = scan.mean(axis=1)
for panel, part in zip(axes, wrong):
    panel.scatter(*middles[:, :2].T, c="lightgray", s=1, linewidths=0)
    columns = part.reshape(28, 28, 28).sum(axis=2)  # points with the same x and y lie on each other
    at_y, at_x = np.nonzero(columns)
    drawn = panel.scatter(axis[at_x], axis[at_y], c=columns[at_y, at_x], s=24, marker="s", cmap="plasma_r", vmin=0,
                          vmax=26)
    panel.set(xlim=(-1.4, 1.4), ylim=(-1.4, 1.4))
figure.colorbar(drawn, ax=axes, shrink=0.75, label="wrong points behind each other")
save(figure, "scan_points.png", *wrong)
