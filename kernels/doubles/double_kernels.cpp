// Rays of doubles through trees of doubles, of one path: compiled once per path with its flags and back end; the table
// is the only symbol that leaves the object.
#include "double_lists.hpp"

namespace raylanes::detail::RAYLANES_PATH_NAME {

extern constinit const DoubleRayKernels doubles;
constinit const DoubleRayKernels doubles{closest_doubles, any_double, list_doubles};

}  // namespace raylanes::detail::RAYLANES_PATH_NAME
