"""A mesh of waves, and rays from above, for the examples."""
import numpy as np

import raylanes


def waves(side):
    """(vertices, faces) of 2 * (side - 1)^2 triangles over the square from -1 to 1."""
    x, y = np.meshgrid(np.linspace(-1, 1, side), np.linspace(-1, 1, side))
    vertices = np.stack([x, y, np.sin(9 * x) * np.cos(7 * y) / 5], axis=-1).reshape(-1, 3)
    corner = np.arange(side * side).reshape(side, side)
    a, b, c, d = corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]
    faces = np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    return vertices.astype(np.float32), faces.astype(np.int32)


def rays_from_above(count, seed=1):
    """From anywhere above, in all directions that go down."""
    random = np.random.default_rng(seed)
    directions = random.normal(size=(count, 3))
    directions[:, 2] = -np.abs(directions[:, 2])
    return raylanes.rays(random.uniform(-1, 1, (count, 3)) + [0, 0, 1.5], directions)
