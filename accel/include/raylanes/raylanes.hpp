// Everything public.
#pragma once

#include <raylanes/bounded_tree.hpp>
#include <raylanes/boxes.hpp>
#include <raylanes/builders.hpp>
#include <raylanes/bvh.hpp>
#include <raylanes/closed_mesh.hpp>
#include <raylanes/closest_points.hpp>
#include <raylanes/cpu_features.hpp>
#include <raylanes/intersect.hpp>
#include <raylanes/kd_nodes.hpp>
#include <raylanes/kdtree.hpp>
#include <raylanes/mesh.hpp>
#include <raylanes/paths.hpp>
#include <raylanes/points.hpp>
#include <raylanes/queries.hpp>
#include <raylanes/rays.hpp>
#include <raylanes/root_methods.hpp>
#include <raylanes/roots.hpp>
#include <raylanes/scene.hpp>
#include <raylanes/sphere_tree.hpp>
#include <raylanes/spheres.hpp>
#include <raylanes/traversal.hpp>
#include <raylanes/tree.hpp>
#include <raylanes/triangle_tree.hpp>
#include <raylanes/triangles.hpp>
#include <raylanes/types.hpp>
