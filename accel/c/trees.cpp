// The C functions of trees of floats and of doubles.
#include <raylanes/raylanes.h>

#include <raylanes/bvh.hpp>
#include <raylanes/doubles.hpp>

namespace raylanes::c {
namespace of_floats {

using Number = float;
using Tree = Bvh;

}  // namespace of_floats
namespace of_doubles {

using Number = double;
using Tree = BvhD;

}  // namespace of_doubles
}  // namespace raylanes::c

#define RAYLANES_HANDLE raylanes_bvh
#define RAYLANES_CALLS raylanes_bvh_calls
#define RAYLANES_CALL(of_floats, of_doubles) of_floats
#define RAYLANES_RECORD(name) raylanes_##name
#define RAYLANES_OPTIONS(name) name
#define RAYLANES_NUMBERS of_floats
#include "tree_calls.hpp"
#include "tree_points.hpp"
#undef RAYLANES_HANDLE
#undef RAYLANES_CALLS
#undef RAYLANES_CALL
#undef RAYLANES_RECORD
#undef RAYLANES_OPTIONS
#undef RAYLANES_NUMBERS

#define RAYLANES_HANDLE raylanes_bvhd
#define RAYLANES_CALLS raylanes_bvhd_calls
#define RAYLANES_CALL(of_floats, of_doubles) of_doubles
#define RAYLANES_RECORD(name) raylanes_##name##d
#define RAYLANES_OPTIONS(name) name##D
#define RAYLANES_NUMBERS of_doubles
#include "tree_calls.hpp"
#include "tree_points.hpp"
