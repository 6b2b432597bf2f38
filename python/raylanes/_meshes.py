"""Meshes of other packages, known by their members: nothing is imported. And warnings about meshes."""

import os
import sys
import warnings

import numpy as np

_package = os.path.dirname(__file__) + os.sep


def parts_of(vertices, faces):
    """(vertices, faces) as they are given, or the parts of a mesh in place of both."""
    for name, values in (("vertices", vertices), ("faces", faces)):
        if _is_of_many(values):
            raise TypeError(f"{name}: one mesh is needed, not a list of {len(values)}. Join them: concatenate all "
                            "vertices, and all faces after adding to each the number of vertices before its mesh; or "
                            "add each mesh to a raylanes.Scene")
    if faces is not None:
        return vertices, faces
    parts = _parts_of_mesh(vertices)
    if parts is None:
        raise TypeError("faces: give vertices and faces, or a mesh that has vertices and faces, not only "
                        f"{type(vertices).__name__}")
    return parts


def _is_of_many(values):
    """Whether a list holds meshes, or the arrays of several ones."""
    if not isinstance(values, (list, tuple)) or not values:
        return False
    first = values[0]
    rows = isinstance(first, (list, tuple)) and first and isinstance(first[0], (list, tuple, np.ndarray))
    return bool(rows) or getattr(first, "ndim", None) == 2 or is_mesh(first)


def is_mesh(mesh):
    """Whether an object has vertices and faces."""
    return _parts_of_mesh(mesh) is not None


def faces_in(faces):
    """Faces as they are given, or the faces of a mesh."""
    parts = _parts_of_mesh(faces)
    return faces if parts is None else parts[1]


def _parts_of_mesh(mesh):
    for pair in (("vertices", "faces"), ("vertices", "triangles")):  # trimesh; Open3D
        if all(hasattr(mesh, name) for name in pair):
            return tuple(np.asarray(getattr(mesh, name)) for name in pair)
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):  # Open3D's tensors
        return _array_of(mesh.vertex["positions"]), _array_of(mesh.triangle["indices"])
    return None


def _array_of(tensor):
    for step in ("cpu", "numpy"):
        tensor = getattr(tensor, step)() if hasattr(tensor, step) else tensor
    return np.asarray(tensor)


class MeshWarning(UserWarning):
    """A mesh for which results may not be what you expect.

    Each tree warns once, at the line of your own that made the call. To turn these warnings off:
    ``warnings.simplefilter("ignore", raylanes.MeshWarning)``.
    """


def warn(text):
    """A MeshWarning at the first line of the call stack that is not of this package."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_package):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, MeshWarning, stacklevel=level)


def warn_of_sides(tree, consequence):
    """A MeshWarning, once a tree, if its mesh is closed and turned inside out."""
    if tree.found_inside_out():
        warn(f"the mesh is turned inside out, its normals point inwards: {consequence}. faces[:, ::-1] turns it over")
