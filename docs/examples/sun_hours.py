"""Draws the hours of sun on a midsummer day and the share of the sky in sight, on a terrain with 200 buildings in UTM
coordinates: a scene of float64, so that nothing is rounded or shifted.

usage: sun_hours.py FOLDER      writes sun_hours.png
"""
import numpy as np
from matplotlib.collections import PolyCollection

import raylanes
from figures import panels, save

side, size, corner = 150, 600, np.array([691_000.0, 5_334_000.0, 0])  # metres: 600 × 600 of UTM zone 32N
x, y = np.meshgrid(np.linspace(0, size, side), np.linspace(0, size, side))
hills = [(120, 430, 45, 150), (480, 140, 30, 120), (420, 520, 25, 90)]
z = 515 + sum(height / (1 + ((x - at_x)**2 + (y - at_y)**2) / width**2) for at_x, at_y, height, width in hills)
vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
a = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
faces = np.concatenate([np.stack([a, a + 1, a + side + 1], axis=-1), np.stack([a, a + side + 1, a + side], axis=-1)])
a, b, c = np.moveaxis(vertices[faces], 1, 0)
ground, normals = (a + b + c) / 3 + corner, np.cross(b - a, c - a)  # rays begin in the middle of each triangle

box = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
of_box = np.array([[4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4],
                   [3, 4, 7]])  # a roof and walls
n = np.arange(200)
places = np.stack([30 + n % 20 * 27.5, 60 + n // 20 * 50 + n * 7 % 11, 500 + 0 * n], axis=-1)
column, row = (places[:, :2] // 4).astype(int).T
sizes = np.stack([12 + n * 5 % 8, 14 + n * 3 % 17, z[row, column] - 485 + n * 29 % 23], axis=-1)
scene = raylanes.Scene()  # of float64, as the terrain is
scene.place(scene.add(vertices + corner, faces))
transforms, roofs = np.zeros((200, 3, 4)), (places + corner)[:, None, :2] + box[4:, :2] * sizes[:, None, :2]
transforms[:, range(3), range(3)], transforms[:, :, 3] = sizes, places + corner
scene.place(scene.add(box, of_box), transforms)
scene.update()


def in_sight(direction):
    """Whether nothing hides that direction. A ray leaves its own ground through the back, which does not count."""
    direction = np.round(1024 * direction)  # the same on each machine
    return (normals @ direction > 0) & ~scene.occluded_towards(direction, ground, facing="front")


hours, sky = np.zeros(len(ground)), np.zeros(len(ground))
latitude, declination = np.radians([48.1, 23.4])
for turn in np.radians(np.arange(-120, 121, 7.5)):  # half hours around noon
    up = np.sin(latitude) * np.sin(declination) + np.cos(latitude) * np.cos(declination) * np.cos(turn)
    north = np.cos(latitude) * np.sin(declination) - np.sin(latitude) * np.cos(declination) * np.cos(turn)
    if up > 0:
        hours += in_sight(np.array([-np.cos(declination) * np.sin(turn), north, up])) / 2
for k in range(64):  # by the cosine: what a horizontal surface receives of a grey sky
    radius, turn = np.sqrt((k + 0.5) / 64), 2.4 * k
    sky += in_sight(np.array([radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1 - radius**2)])) / 64

figure, axes = panels("hours of sun on 21 June", "share of the sky in sight")
for panel, value in zip(axes, (hours, sky)):
    drawn = panel.tripcolor(*(vertices + corner)[:, :2].T, faces, value, cmap="inferno", rasterized=True)
    panel.add_collection(PolyCollection(roofs, color="lightsteelblue"))
    figure.colorbar(drawn, ax=panel, shrink=0.75)
    panel.margins(0)
save(figure, "sun_hours.png", hours, sky)
