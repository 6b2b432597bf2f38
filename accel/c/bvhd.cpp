// The C functions of trees of doubles.
#include <raylanes/raylanes.h>

#include <raylanes/doubles.hpp>

#define RAYLANES_HANDLE raylanes_bvhd
#define RAYLANES_CALL(name) raylanes_bvhd_##name
#define RAYLANES_RECORD(name) raylanes_##name##d
#define RAYLANES_OPTIONS(name) name##D

namespace raylanes::c {
namespace {

using Number = double;
using Tree = BvhD;

}  // namespace
}  // namespace raylanes::c

#include "tree_calls.hpp"
