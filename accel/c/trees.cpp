// The C functions of trees of floats and of doubles.
#include <raylanes/raylanes.h>

#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>

namespace raylanes::c {
namespace of_floats {

using Number = float;
using Tree = Bvh;
using AnyClosestPoint = ClosestPoint;
using ClosestOptions = ClosestPointOptions;
using DistanceOptions = SignedDistanceOptions;
using CornersOfTriangle = Triangle;
constexpr const char* kind = "tree";

}  // namespace of_floats
namespace of_doubles {

using Number = double;
using Tree = BvhD;
using AnyClosestPoint = ClosestPointD;
using ClosestOptions = ClosestPointOptionsD;
using DistanceOptions = SignedDistanceOptionsD;
using CornersOfTriangle = TriangleD;
constexpr const char* kind = "tree";

}  // namespace of_doubles
}  // namespace raylanes::c

#define RAYLANES_HANDLE raylanes_bvh
#define RAYLANES_CALLS raylanes_bvh_calls
#define RAYLANES_CALL(of_floats, of_doubles, of_scene, of_scene_d) of_floats
#define RAYLANES_TREE_CALL(of_floats, of_doubles) of_floats
#define RAYLANES_RAY raylanes_ray
#define RAYLANES_HIT raylanes_hit
#define RAYLANES_CLOSEST raylanes_closest_point
#define RAYLANES_NUMBERS of_floats
#include "object_calls.hpp"
#include "object_files.hpp"
#include "object_points.hpp"
#include "object_stretches.hpp"
#include "tree_calls.hpp"
#undef RAYLANES_HANDLE
#undef RAYLANES_CALLS
#undef RAYLANES_CALL
#undef RAYLANES_TREE_CALL
#undef RAYLANES_RAY
#undef RAYLANES_HIT
#undef RAYLANES_CLOSEST
#undef RAYLANES_NUMBERS

#define RAYLANES_HANDLE raylanes_bvhd
#define RAYLANES_CALLS raylanes_bvhd_calls
#define RAYLANES_CALL(of_floats, of_doubles, of_scene, of_scene_d) of_doubles
#define RAYLANES_TREE_CALL(of_floats, of_doubles) of_doubles
#define RAYLANES_RAY raylanes_rayd
#define RAYLANES_HIT raylanes_hitd
#define RAYLANES_CLOSEST raylanes_closest_pointd
#define RAYLANES_NUMBERS of_doubles
#include "object_calls.hpp"
#include "object_files.hpp"
#include "object_points.hpp"
#include "object_stretches.hpp"
#include "tree_calls.hpp"
