#pragma once

#include <pybind11/pybind11.h>

namespace raylanes::python {

// sqrt, rsqrt, reciprocal, accuracy.
void bind_roots(pybind11::module_& module);
// Bvh, BvhD and KdTree.
void bind_trees(pybind11::module_& module);
// SphereTree and Scene.
void bind_scenes(pybind11::module_& module);

}  // namespace raylanes::python
