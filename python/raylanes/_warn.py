"""Warnings about meshes."""

import os
import sys
import warnings

_package = os.path.dirname(__file__) + os.sep


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
