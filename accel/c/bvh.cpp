// The C functions of trees of floats.
#include <raylanes/raylanes.h>

#include <raylanes/bvh.hpp>

#define RAYLANES_HANDLE raylanes_bvh
#define RAYLANES_CALL(name) raylanes_bvh_##name
#define RAYLANES_RECORD(name) raylanes_##name
#define RAYLANES_OPTIONS(name) name

namespace raylanes::c {
namespace {

using Number = float;
using Tree = Bvh;

}  // namespace
}  // namespace raylanes::c

#include "tree_calls.hpp"
