"""Hits in scenes: arrays of records, and single records with the same properties."""

import numpy as np

from ._arrays import double_scene_hit_dtype, no_part, no_primitive, numbers, scene_hit_dtype
from .hits import (ClosestPoint, ClosestPoints, Crossing, Crossings, HitNumbers, Hits, Records, Stretch, Stretches,
                   field_of)
from .sphere_tree import SphereTree


class _InScene:
    geometry = field_of("geometry", "uint32: index of the geometry; no_part for a miss")
    instance = field_of("instance", "uint32: index of the instance; no_part for a miss")


class _SceneHitNumbers(_InScene, HitNumbers):
    primitive = field_of("primitive", "uint32: row of the triangle in the faces of its geometry, or row of the sphere; "
                         "no_primitive for a miss")

    def interpolate(self, values, faces):
        """Compute the mean of three vertices' values by barycentric weights, as Hits.interpolate() does.

        Parameters
        ----------
        values : dict or sequence of arrays
            values[g] has a row for each vertex of geometry g: shape (n,) or (n, k), the same k for all geometries.
        faces : dict or sequence of arrays or meshes
            faces[g] are the faces of geometry g, or its mesh.

        Returns
        -------
        ndarray of float64, shape (...,) or (..., k)
            NaN for a miss.

        Raises
        ------
        ValueError
            If there is nothing for a geometry that is hit, or a face of a hit has an index that is no row of values.

        Examples
        --------
        >>> corners, faces = np.float32([[0, 0, 0], [4, 0, 0], [0, 2, 0]]), [[0, 1, 2]]
        >>> scene = raylanes.Scene()
        >>> scene.place(scene.add(raylanes.Bvh(corners, faces)))
        0
        >>> scene.update()
        >>> hits = scene.closest(raylanes.rays([[1, 0.5, 5]], [0, 0, -1]))
        >>> hits.interpolate([[[0, 0], [1, 0], [0, 1]]], [faces])
        array([[0.25, 0.25]])
        """
        hits, made = _rows_of(self), None
        for geometry, of_geometry in _geometries_in(hits):
            rows = hits[of_geometry].view(Hits).interpolate(_entry("values", values, geometry),
                                                            _entry("faces", faces, geometry))
            if made is None:
                made = np.full((len(hits), *rows.shape[1:]), np.nan)
            if made.shape[1:] != rows.shape[1:]:
                raise ValueError("values: the rows of all geometries must have one shape, they have "
                                 f"{made.shape[1:]} and {rows.shape[1:]}")
            made[of_geometry] = rows
        if made is None:  # no hits
            first = next(iter(values.values() if isinstance(values, dict) else values), ())
            made = np.full((len(hits), *np.shape(first)[1:]), np.nan)
        return made.reshape(np.shape(self) + made.shape[1:])

    def normals(self, scene, parts, rays=None, *, origins=None, directions=None):
        """Compute the unit normals of the surfaces in the space of the scene, in double.

        They are the normals of the parts times the inverse transposed transforms: the normals of a solid that point
        outwards do so in each instance, also in one that mirrors it.

        Parameters
        ----------
        scene : Scene
            The scene of the query, with the transforms that it had.
        parts : dict or sequence
            parts[g] is the tree of geometry g, or its mesh, a pair (vertices, faces), or its SphereTree.
        rays : array, optional
            The rays of the query, in the same shape. Hits on spheres need them.
        origins, directions : array of float, shape (..., 3), optional
            The origins and directions of the query, in place of `rays`. Shapes are broadcast.

        Returns
        -------
        ndarray of float64, shape (..., 3)
            NaN for a miss, and for a triangle without an area.

        Raises
        ------
        ValueError
            If there is nothing for a geometry that is hit. If a face of a hit has an index that is no vertex. If rays
            are needed, or have another shape.

        Examples
        --------
        >>> scene, spheres = raylanes.Scene(), raylanes.SphereTree([[0, 0, 0]], 1)
        >>> scene.place(scene.add(spheres))
        0
        >>> scene.update()
        >>> rays = raylanes.rays([[0, 0, 5]], [0, 0, -1])
        >>> scene.closest(rays).normals(scene, [spheres], rays)
        array([[0., 0., 1.]])
        """
        if not hasattr(scene, "transform_of"):
            raise TypeError(f"scene: a Scene is needed, not {type(scene).__name__}")
        hits = _rows_of(self)
        normals = np.full((len(hits), 3), np.nan)
        positions = None
        if rays is not None or origins is not None or directions is not None:
            positions = self.positions(rays, origins=origins, directions=directions).reshape(-1, 3).astype(np.float64)
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            for geometry, of_geometry in _geometries_in(hits):
                transforms = scene.transform_of(hits["instance"][of_geometry]).astype(np.float64)
                normals[of_geometry] = _normals_of(hits[of_geometry], _entry("parts", parts, geometry), transforms,
                                                   None if positions is None else positions[of_geometry])
            normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        return normals.reshape(np.shape(self) + (3,))


class SceneHit(_SceneHitNumbers, np.void):
    """A single hit in a scene: hits[i], with the properties and methods of SceneHits."""


class SceneHits(_SceneHitNumbers, Records):
    """An array of scene_hit_dtype or double_scene_hit_dtype: the hits of a Scene.

    hits[mask] and hits["t"] work as in any array of records, and hits[i] is a SceneHit. The positions() are in the
    space of the scene.
    """

    _record = SceneHit
    _miss = (np.inf, 0, 0, no_primitive, no_part, no_part)


class SceneCrossing(_InScene, Crossing):
    """A single crossing in a scene: crossings[i], with the properties and methods of SceneCrossings."""


class SceneCrossings(_InScene, Crossings):
    """An array of scene_crossing_dtype or double_scene_crossing_dtype; a side is that in the instance's space."""

    _record = SceneCrossing


class SceneStretch(_InScene, Stretch):
    """A single stretch within an instance: stretches[i], with the properties of SceneStretches."""


class SceneStretches(_InScene, Stretches):
    """An array of scene_stretch_dtype or double_scene_stretch_dtype; stretches[i] is a SceneStretch."""

    _record = SceneStretch


class SceneClosestPoint(_InScene, ClosestPoint):
    """A single closest point in a scene: points[i], with the properties of SceneClosestPoints."""


class SceneClosestPoints(_InScene, ClosestPoints):
    """An array of scene_closest_point_dtype or double_scene_closest_point_dtype, in the space of the scene."""

    _record = SceneClosestPoint


class _PartNumbers(_InScene):
    location = field_of("location", "uint8: INSIDE, or ON the surface; OUTSIDE where no instance contains the point")

    @property
    def found(self):
        """bool: whether an instance contains the point."""
        return self.instance != no_part


class ContainingPart(_PartNumbers, np.void):
    """A single instance that contains a point: parts[i], with the properties of ContainingParts."""


class ContainingParts(_PartNumbers, Records):
    """An array of containing_part_dtype; parts[i] is a ContainingPart."""

    _record = ContainingPart


def _rows_of(hits):
    rows = np.asarray(hits)
    dtype = double_scene_hit_dtype if rows.dtype["t"] == np.float64 else scene_hit_dtype
    return rows.astype(dtype, copy=False).reshape(-1)


def _geometries_in(hits):
    """(geometry, mask of its hits) of each geometry that is hit."""
    is_hit = hits["primitive"] != no_primitive
    for geometry in np.unique(hits["geometry"][is_hit]).tolist():
        yield geometry, is_hit & (hits["geometry"] == geometry)


def _entry(name, entries, geometry):
    try:
        return entries[geometry]
    except (KeyError, IndexError):
        raise ValueError(f"{name}: there is nothing for geometry {geometry}, which is hit") from None


def _normals_of(hits, part, transforms, positions):
    """Normals of the hits of one geometry, of any length."""
    a, b, c = np.moveaxis(transforms[:, :, :3], 1, 0)
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1)
    determinants = np.einsum("ni,ni->n", a, cofactors[:, 0])
    if isinstance(part, SphereTree):
        if positions is None:
            raise ValueError("rays: the normals of spheres need them")
        if int(hits["primitive"].max()) >= len(part):
            raise ValueError(f"parts: there are {len(part)} spheres, and a hit is on {int(hits['primitive'].max())}")
        local = np.einsum("nji,nj->ni", cofactors, positions - transforms[:, :, 3]) / determinants[:, None]
        local -= part.centres[hits["primitive"]]
    else:
        local = hits.view(Hits).normals(*part if isinstance(part, tuple) else (part,))
    return np.einsum("nij,nj->ni", cofactors, local) * np.sign(determinants)[:, None]
