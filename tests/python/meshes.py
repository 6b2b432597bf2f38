"""Meshes and rays that tests share, and trees of all kinds."""

import copy
import io
import pickle
import warnings

import numpy as np

import raylanes

tree_kinds = [(raylanes.Bvh, builder) for builder in
              ("median", "equal_partition", "binned_sah", "sweep_sah", "spatial_splits", "morton")]
tree_kinds += [(raylanes.KdTree, builder) for builder in ("midpoint", "sah")]
supported = [path.name for path in raylanes.paths() if path.supported]

cube_vertices = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
cube_faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                       [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], np.int32)


copies = [copy.copy, copy.deepcopy, *(lambda one, protocol=protocol: pickle.loads(pickle.dumps(one, protocol))
                                      for protocol in range(2, 6))]


def saved(tree):
    file = io.BytesIO()
    tree.save(file)
    return file.getvalue()


def same(a, b):
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def warnings_of(call):
    """The texts of the MeshWarnings of a call; each is at a line of the file that the call is in."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert all(one.category is raylanes.MeshWarning and one.filename == call.__code__.co_filename for one in caught)
    return [str(one.message) for one in caught]


def cube(kind=raylanes.Bvh, **options):
    return kind(cube_vertices, cube_faces, **options)


def lattice(seed, triangles=40, rays=60):
    """Triangles with corners on a coarse lattice, some coincident or degenerate, and rays that often meet corners and
    edges."""
    random = np.random.default_rng(seed)
    vertices = (random.integers(-4, 5, (24, 3)) / 4).astype(np.float32)
    faces = random.integers(0, len(vertices), (triangles, 3))
    faces[1] = faces[0]
    origins = random.integers(-8, 9, (rays, 3)) / 4
    targets = vertices[random.integers(0, len(vertices), rays)]
    targets[::3] = random.uniform(-1, 1, targets[::3].shape)
    directions = targets - origins
    directions[np.all(directions == 0, axis=1)] = 1
    tmin = np.where(random.random(rays) < 0.8, 0, random.choice([0.5, 1, -1], rays))
    tmax = np.where(random.random(rays) < 0.8, np.inf, random.choice([1, 2], rays))
    return vertices, faces, raylanes.rays(origins, directions, tmin, tmax, dtype=np.float32)


def sphere(seed=1, triangles=3000):
    """A closed, bumpy ball of about so many triangles."""
    rows = max(3, round((triangles / 4) ** 0.5))
    columns = 2 * rows
    random = np.random.default_rng(seed)
    theta = np.pi * np.arange(1, rows) / rows
    phi = 2 * np.pi * np.arange(columns) / columns
    ring = np.stack(np.broadcast_arrays(np.sin(theta)[:, None] * np.cos(phi), np.sin(theta)[:, None] * np.sin(phi),
                                        np.cos(theta)[:, None]), axis=-1).reshape(-1, 3)
    vertices = np.concatenate([ring * random.uniform(0.9, 1.1, (len(ring), 1)), [[0, 0, 1], [0, 0, -1]]])
    index = np.arange(len(ring)).reshape(rows - 1, columns)
    next_one = np.roll(index, -1, axis=1)
    quads = index[:-1], next_one[:-1], index[1:], next_one[1:]
    faces = [np.stack([quads[0], quads[2], quads[3]], -1), np.stack([quads[0], quads[3], quads[1]], -1)]
    top, bottom = np.full(columns, len(ring)), np.full(columns, len(ring) + 1)
    faces += [np.stack([top, index[0], next_one[0]], -1), np.stack([bottom, next_one[-1], index[-1]], -1)]
    return vertices.astype(np.float32), np.concatenate([f.reshape(-1, 3) for f in faces]).astype(np.int32)


def random_rays(seed, count, reach=2.0, dtype=np.float32):
    random = np.random.default_rng(seed)
    return raylanes.rays(random.uniform(-reach, reach, (count, 3)), random.normal(size=(count, 3)), dtype=dtype)


def any_bits(seed, count, dtype):
    """Records of arbitrary bytes."""
    return np.random.default_rng(seed).integers(0, 256, count * dtype.itemsize, np.uint8).view(dtype)
