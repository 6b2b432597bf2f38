// Rays against arrays of triangles, boxes and spheres: the tests and the calls of all three.
#pragma once

#include <raylanes/boxes.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/triangles.hpp>
