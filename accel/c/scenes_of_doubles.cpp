// The C functions of scenes of doubles.
#include <raylanes/raylanes.h>

#include <raylanes/scene_d.hpp>

namespace raylanes::c::of_scenes_of_doubles {

using Number = double;
using Tree = SceneD;
using PartTree = BvhD;
using AnyTransform = TransformD;
using AnyClosestPoint = SceneClosestPointD;
using ClosestOptions = ClosestPointOptionsD;
using DistanceOptions = SignedDistanceOptionsD;
using CornersOfTriangle = TriangleD;
constexpr const char* kind = "scene";

}  // namespace raylanes::c::of_scenes_of_doubles

#define RAYLANES_HANDLE raylanes_scene_d
#define RAYLANES_CALL(of_floats, of_doubles, of_scene, of_scene_d) of_scene_d
#define RAYLANES_SCENE_CALL(of_floats, of_doubles) of_doubles
#define RAYLANES_PART raylanes_bvhd
#define RAYLANES_RAY raylanes_rayd
#define RAYLANES_HIT raylanes_scene_hit_d
#define RAYLANES_CLOSEST raylanes_scene_closest_point_d
#define RAYLANES_CROSSING raylanes_scene_crossing_d
#define RAYLANES_NUMBERS of_scenes_of_doubles
#include "object_calls.hpp"
#include "object_files.hpp"
#include "object_points.hpp"
#include "object_stretches.hpp"
#include "scene_calls.hpp"

static_assert(sizeof(raylanes::SceneStretchD) == sizeof(raylanes_scene_stretch_d));
