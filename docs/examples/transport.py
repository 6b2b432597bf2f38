"""The walk and the picture of transport.cpp in Python: all particles step at once.

usage: transport.py FOLDER [STEPS]      writes transport.png, prints how many particles are lost
"""
import sys

import numpy as np

import raylanes
from common import write_png

none = raylanes.no_part
f32 = np.float32


def prism(sides):
    """A closed prism around the z axis, from z = -1 to 1. It is convex: a ray enters it once at most."""
    k = np.arange(sides)
    after, turn = (k + 1) % sides, (k + 0.5) * 2 * np.pi / sides
    ring = np.stack([np.cos(turn), np.sin(turn), -np.ones(sides)], axis=-1).astype(f32)
    walls = np.concatenate([np.stack([k, after, sides + after], -1), np.stack([k, sides + after, sides + k], -1)])
    fan = np.stack([0 * k, after, k], -1)[1:-1]
    return np.concatenate([ring, ring * f32([1, 1, -1])]), np.concatenate([walls, fan, sides + fan[:, [0, 2, 1]]])


class Model:
    """Each instance is a cell within the cell of its parent; no two surfaces touch."""

    def __init__(self):
        self.scene, self.parent, self.collisions = raylanes.Scene(), [], []
        box, tube = self.scene.add(*prism(4)), self.scene.add(*prism(48))
        world = self.add(box, none, 12, 9, (0, 0), 0.01, "world")
        vessel = self.add(tube, world, 7.5, 8, (0, 0), 0.5, "water")
        for row in range(-2, 3):
            for column in range(-2, 3):
                if abs(row + column) <= 2:  # a hexagon of 19 rods
                    at = f32(2.6) * f32(column + 0.5 * row), f32(2.25) * f32(row)
                    rod = self.add(tube, vessel, 0.95, 7, at, 0.2, "rod")
                    self.add(tube, rod, 0.8, 6.5, at, 1, "fuel")
        self.scene.update()
        self.parent, self.collisions = np.array(self.parent), np.array(self.collisions)  # per centimetre

    def add(self, part, around, radius, height, at, per_centimetre, name):
        self.parent.append(around)
        self.collisions.append(per_centimetre)
        return self.scene.place(part, [[radius, 0, 0, at[0]], [0, radius, 0, at[1]], [0, 0, height, 0]], name=name)


class Walk:
    """offset: how far particles are put behind a crossing; 0: they keep their ray, and the triangle is skipped."""

    def __init__(self, model, particles, offset):
        self.model, self.offset, self.steps, self.lost, self.visited = model, f32(offset), 0, [], []
        self.rays = np.zeros(particles, raylanes.ray_dtype)
        self.last = model.scene.closest(self.rays)  # misses
        self.cells, self.drawn = np.zeros(particles, np.int64), np.zeros(particles, np.uint64)
        self.begin(np.arange(particles))

    def step(self):
        scene, rays, parent = self.model.scene, self.rays, self.model.parent
        exits = scene.closest_crossing(rays, facing="back", skip=self.last)
        entries = scene.closest_crossing(rays, facing="front", skip=self.last)
        self.steps += len(rays)
        leaves = exits.hit & (exits.instance == self.cells)
        enters = entries.hit & (parent[np.where(entries.hit, entries.instance, 0)] == self.cells)
        lost = np.flatnonzero(~leaves & ~enters)
        here = np.flatnonzero(leaves | enters)
        is_entry = (enters & ~(leaves & (exits.t < entries.t)))[here]
        crossing = np.where(is_entry, entries[here], exits[here])
        flight = rays["tmin"][here] + f32(-np.log(self.random(here)) / self.model.collisions[self.cells[here]])
        self.lost.extend(rays["origin"][lost])
        self.begin(lost)
        ends = self.along(here, np.minimum(flight, crossing["t"]))
        self.visited.append(ends)
        collides = flight < crossing["t"]
        cells = np.where(is_entry, crossing["instance"], parent[crossing["instance"]])[~collides]
        turned, crossed = here[collides], here[~collides]
        self.go_on(crossed, crossing[~collides], is_entry[~collides])
        self.cells[crossed] = cells
        self.set_out(turned, ends[collides])
        self.ask_cells(turned)
        self.begin(crossed[cells == none])

    def random(self, i):
        """Numbers in (0, 1), the same in C++: bits of a counter and the particle, mixed."""
        z = (i.astype(np.uint64) << np.uint64(32) | self.drawn[i]) * np.uint64(0x9e3779b97f4a7c15)
        self.drawn[i] += np.uint64(1)
        z = (z ^ z >> np.uint64(30)) * np.uint64(0xbf58476d1ce4e5b9)
        z = (z ^ z >> np.uint64(27)) * np.uint64(0x94d049bb133111eb)
        return ((z ^ z >> np.uint64(31)) >> np.uint64(12)) * 2.0**-52 + 2.0**-53

    def along(self, i, t):
        return (self.rays["origin"][i] + t[:, None].astype(np.float64) * self.rays["direction"][i]).astype(f32)

    def set_out(self, i, origins):
        """In directions of length 1: the first of eight points that lies in the unit ball, or else the last."""
        points = np.stack([2 * self.random(i) - 1 for _ in range(24)], axis=-1).reshape(-1, 8, 3)
        squares = points[..., 0]**2 + points[..., 1]**2 + points[..., 2]**2
        first = np.where((squares <= 1).any(axis=1), (squares <= 1).argmax(axis=1), 7)[:, None]
        length = np.sqrt(np.take_along_axis(squares, first, axis=1))
        self.rays[i] = raylanes.rays(origins, f32(np.take_along_axis(points, first[..., None], axis=1)[:, 0] / length))
        self.last[i] = (np.inf, 0, 0, raylanes.no_primitive, none, none)

    def begin(self, i):
        """New particles, in the fuel of some rods."""
        cells = 3 + 2 * (19 * self.random(i)).astype(np.int64)
        self.cells[i] = cells
        at = self.model.scene.transform_of(cells)[..., 3]
        self.set_out(i, at + np.stack([f32(size * (self.random(i) - 0.5)) for size in (1, 1, 12)], axis=-1))

    def go_on(self, i, crossings, is_entry):
        """t of a crossing is rounded, tmin is not. After an entry the exit may follow at once, after an exit none."""
        if self.offset > 0:
            self.rays["origin"][i], self.rays["tmin"][i] = self.along(i, crossings["t"] + self.offset), 0
        else:
            self.rays["tmin"][i] = np.nextafter(crossings["t"], f32(np.where(is_entry, -np.inf, np.inf)))
            self.last[i] = crossings

    def ask_cells(self, turned):
        """The cells of particles that turned: where they turned was rounded, perhaps into another cell."""
        self.cells[turned] = self.model.scene.innermost_parts(self.rays["origin"][turned]).instance
        self.begin(turned[self.cells[turned] == none])


wanted, particles, size = int(sys.argv[2]) if len(sys.argv) > 2 else 500_000, 20_000, 320
model = Model()
levels = np.ones((size, 2 * size))
for panel, offset in enumerate((0, 2e-3)):
    walk, visits = Walk(model, particles, offset), np.zeros((size, size), int)

    def pixels(points):
        column, row = ((points[:, :2] + f32(9)) * f32(size / 18)).astype(int).T
        return size - 1 - row, column

    while walk.steps < wanted:
        walk.step()
        np.add.at(visits, pixels(np.concatenate(walk.visited)), 1)
        walk.visited.clear()
    print(f"{f'by an offset of {offset:g}' if offset else 'by crossings'}: {walk.steps} steps, {len(walk.lost)} "
          "particles lost")
    dark = 1 - 1 / (1 + 0.15 / wanted * size * size * visits)
    levels[:, panel * size:][:, :size] = 1 - (0.3 if offset else 1) * dark
    for row, column in zip(*pixels(np.reshape(walk.lost, (-1, 3)))):
        levels[row - 2:row + 3, panel * size + column - 2:panel * size + column + 3] = 0
write_png(f"{sys.argv[1]}/transport.png", levels)
