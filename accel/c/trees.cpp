// The C functions of trees of floats and of doubles.
#include <raylanes/raylanes.h>

#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>

namespace raylanes::c {
namespace of_floats {

using Number = float;
using Tree = Bvh;
constexpr const char* kind = "tree";

}  // namespace of_floats
namespace of_doubles {

using Number = double;
using Tree = BvhD;
constexpr const char* kind = "tree";

}  // namespace of_doubles
}  // namespace raylanes::c

#define RAYLANES_HANDLE raylanes_bvh
#define RAYLANES_CALLS raylanes_bvh_calls
#define RAYLANES_CALL(of_floats, of_doubles, of_scene) of_floats
#define RAYLANES_TREE_CALL(of_floats, of_doubles) of_floats
#define RAYLANES_RAY raylanes_ray
#define RAYLANES_HIT raylanes_hit
#define RAYLANES_RECORD(name) raylanes_##name
#define RAYLANES_OPTIONS(name) name
#define RAYLANES_NUMBERS of_floats
#include "object_calls.hpp"
#include "tree_calls.hpp"
#include "tree_points.hpp"
#undef RAYLANES_HANDLE
#undef RAYLANES_CALLS
#undef RAYLANES_CALL
#undef RAYLANES_TREE_CALL
#undef RAYLANES_RAY
#undef RAYLANES_HIT
#undef RAYLANES_RECORD
#undef RAYLANES_OPTIONS
#undef RAYLANES_NUMBERS

#define RAYLANES_HANDLE raylanes_bvhd
#define RAYLANES_CALLS raylanes_bvhd_calls
#define RAYLANES_CALL(of_floats, of_doubles, of_scene) of_doubles
#define RAYLANES_TREE_CALL(of_floats, of_doubles) of_doubles
#define RAYLANES_RAY raylanes_rayd
#define RAYLANES_HIT raylanes_hitd
#define RAYLANES_RECORD(name) raylanes_##name##d
#define RAYLANES_OPTIONS(name) name##D
#define RAYLANES_NUMBERS of_doubles
#include "object_calls.hpp"
#include "tree_calls.hpp"
#include "tree_points.hpp"
