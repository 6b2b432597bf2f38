"""What the Python examples share: the meshes and the camera of common.hpp, and a PNG file."""
import struct
import zlib

import numpy as np


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def ball(centre, radius, bumps, steps):
    """(corners, 3, 3): a closed ball with bumps, the eight sides of an octahedron in steps * steps triangles each."""
    i, j = (k.ravel() for k in np.meshgrid(np.arange(steps), np.arange(steps), indexing="ij"))
    up = np.stack([[i, j], [i + 1, j], [i, j + 1]], axis=0)[:, :, i + j < steps]
    down = np.stack([[i + 1, j], [i + 1, j + 1], [i, j + 1]], axis=0)[:, :, i + j + 1 < steps]
    ij = np.concatenate([up, down], axis=2)  # (3 corners, 2, triangles)
    abc = np.stack([ij[:, 0], ij[:, 1], steps - ij[:, 0] - ij[:, 1]], axis=-1) / steps
    sides = []
    for signs in np.array(np.meshgrid([1, -1], [1, -1], [1, -1])).reshape(3, -1).T:
        n = unit(abc * signs)
        bump = 16 * n[..., 0] * n[..., 1] * n[..., 2] * (n[..., 0]**2 - n[..., 1]**2)
        corners = centre + n * (radius * (1 + bumps * bump))[..., None]
        sides.append(corners[[0, 2, 1]] if np.prod(signs) < 0 else corners)  # counter-clockwise from outside
    return np.concatenate(sides, axis=1).swapaxes(0, 1)


def floor(size, z):
    a, b, c, d = np.array([[-size, -size, z], [size, -size, z], [size, size, z], [-size, size, z]])
    return np.array([[a, b, c], [a, c, d]])


def mesh_of(*parts):
    """(vertices, faces) of arrays of corners."""
    vertices = np.concatenate(parts).reshape(-1, 3).astype(np.float32)
    return vertices, np.arange(len(vertices)).reshape(-1, 3)


def camera(width, height):
    """(origin, directions): a ray for each pixel, (height, width, 3), from above the floor towards the middle."""
    ahead = unit(np.array([0, -4, -1.8]))
    forward, right = np.array([0, -ahead[1], ahead[2]]), np.array([1.0, 0, 0])
    up = np.array([0, -forward[2], forward[1]])
    x = (np.arange(width) + 0.5 - 0.5 * width) / height
    y = (0.5 * height - np.arange(height) - 0.5) / height
    return np.array([0, -4, 2.0]), forward + 0.9 * (x[None, :, None] * right + y[:, None, None] * up)


def halved(levels):
    """Half as wide and high: the mean of each four neighbours, so that edges are smooth."""
    return levels.reshape(levels.shape[0] // 2, 2, levels.shape[1] // 2, 2).mean(axis=(1, 3))


def write_png(file, levels):
    """Grey levels from 0 to 1, (height, width)."""
    rows = (255 * np.clip(levels, 0, 1) + 0.5).astype(np.uint8)
    height, width = rows.shape

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    data = zlib.compress(np.insert(rows, 0, 0, axis=1).tobytes(), 9)
    with open(file, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)))
        out.write(chunk(b"IDAT", data) + chunk(b"IEND", b""))
