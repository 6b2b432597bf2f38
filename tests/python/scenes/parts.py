"""Scenes of lattices in places where exact arithmetic needs no rounding, and their hits by brute force in rational
numbers: of triangles in the space of the scene, where the library never looks at them."""

import functools

import numpy as np

import rational
import raylanes
from meshes import lattice

miss = (np.inf, 0, 0, raylanes.no_primitive, raylanes.no_part, raylanes.no_part)


def dyadic_transform(random):
    """An affine map whose inverse has small dyadic numbers, too: turns, mirrors, shears, powers of two, steps."""
    matrix = np.eye(3)[random.permutation(3)] * random.choice([-1, 1], 3)
    shear = np.eye(3)
    shear[random.integers(0, 3), random.integers(0, 3)] = 1
    scaled = matrix @ shear * 2.0 ** random.integers(-1, 2, 3)
    return np.column_stack([scaled, random.integers(-4, 5, 3) / 4])


number_types = [np.float32, np.float64]
far = 2.0 ** np.array([19, 22, 8]) + 2.0**-20  # as UTM coordinates are; floats are 0.25 apart there


class Parts:
    """Three lattices in several places, with a mask each, and rays that often meet corners and edges. Those of float64
    are far away from zero, where no transform rounds them either."""

    def __init__(self, seed, instances=7, dtype=np.float32):
        random = np.random.default_rng(seed)
        self.dtype, at = dtype, 0 if dtype == np.float32 else far
        lattices = [lattice(3 * seed + k, triangles=14)[:2] for k in range(3)]
        self.meshes = [(vertices.astype(dtype) + dtype(1) * at, faces) for vertices, faces in lattices]
        rays = lattice(seed + 90, rays=70)[2]
        self.rays = raylanes.rays(rays["origin"].astype(dtype) + at,
                                  np.round(rays["direction"] * 64) / 64,  # which no transform here rounds
                                  rays["tmin"], rays["tmax"], dtype=dtype)
        self.transforms = np.array([dyadic_transform(random) for _ in range(instances)])
        self.transforms[0] = np.eye(4)[:3]
        self.transforms[5] = self.transforms[2]  # in one place: the first instance counts
        self.transforms[:, :, 3] += at - self.transforms[:, :, :3] @ (np.zeros(3) + at)
        self.geometries = np.array([0, 1, 2, 0, 1, 2, 0])[:instances]
        self.masks = (1 << (np.arange(instances) % 3)).tolist()
        self.trees = [raylanes.Bvh(*mesh) for mesh in self.meshes]

    def scene(self):
        scene = raylanes.Scene()
        for tree in self.trees:
            scene.add(tree)
        for row in zip(self.geometries.tolist(), self.transforms, self.masks):
            scene.place(row[0], row[1], mask=row[2])
        scene.update()
        return scene

    def corners(self, instance):
        """The triangles of an instance in the space of the scene, exactly."""
        vertices, faces = self.meshes[self.geometries[instance]]
        rows = [rational.fractions(row) for row in self.transforms[instance]]
        moved = [[rational.dot(row, rational.fractions(v)) + row[3] for row in rows] for v in vertices]
        return [[moved[i] for i in face] for face in faces]

    @functools.cached_property
    def all_hits(self):
        """[((t, u, v, primitive, geometry, instance), side)] of each ray, in order; the side is that of the part."""
        found = [[] for _ in self.rays]
        for instance, geometry in enumerate(self.geometries.tolist()):
            for primitive, corners in enumerate(self.corners(instance)):
                for of_ray, ray in zip(found, self.rays):
                    numbers = rational.hit(ray, corners)
                    if numbers:
                        hit = *(rational.rounded(n, self.dtype) for n in numbers), primitive, geometry, instance
                        of_ray.append((hit, self.side(ray, corners, instance)))
        return [sorted(of_ray, key=lambda h: (h[0][0], h[0][5], h[0][3])) for of_ray in found]

    def side(self, ray, corners, instance):
        """The side of a triangle that a ray comes to, in the space of its part."""
        a, b, c = corners
        normal = rational.cross(rational.minus(b, a), rational.minus(c, a))
        is_mirrored = np.linalg.det(self.transforms[instance][:, :3]) < 0
        comes_against = rational.dot(rational.fractions(ray["direction"]), normal) < 0
        return "front" if comes_against != is_mirrored else "back"

    def hits(self, mask=0xFFFFFFFF, facing="any"):
        return [[hit for hit, side in of_ray if self.masks[hit[5]] & mask and facing in ("any", side)]
                for of_ray in self.all_hits]


def nearest(hits):
    return [of_ray[0] if of_ray else miss for of_ray in hits]


def sphere_hits(ray, centres, radii, transform):
    """(t, whether it is clear) of each sphere in a place, by float64. Clear are hits for which the library's test has a
    bound of 16 ULP, and misses by far."""
    inverse = np.linalg.inv(transform[:, :3])
    o = inverse @ (np.float64(ray["origin"]) - transform[:, 3]) - np.float64(centres)
    d = inverse @ np.float64(ray["direction"])
    dd, b = d @ d, o @ d
    apart = np.sum((o - np.outer(b / dd, d)) ** 2, axis=1)  # of the centre and the line, squared
    inside = np.float64(radii) ** 2 - apart
    half = np.sqrt(np.maximum(inside, 0) / dd)
    near, far = -b / dd - half, -b / dd + half
    tmin, tmax = float(ray["tmin"]), float(ray["tmax"])
    t = np.where((near >= tmin) & (near <= tmax), near, np.where((far >= tmin) & (far <= tmax), far, np.inf))
    edges = np.abs(np.stack([near - tmin, near - tmax, far - tmin, far - tmax])) > 1e-4
    clear = (np.abs(inside) > 0.02 * np.float64(radii) ** 2) & (edges.all(axis=0) | (inside < 0))
    return np.where(inside > 0, t, np.inf), clear
