// The rows of roots in raylanes_bench: sqrt/METHOD/PATH/SIZE, rsqrt/…, reciprocal/…, double_sqrt/… and so on,
// sqrt_latency/METHOD/PATH, sqrt/classic_N_FORM/PATH/SIZE for the forms of the course report, and
// sqrt/LIBRARY_OPERATION/PATH/SIZE for other libraries with the instructions of PATH.
#pragma once

#include <raylanes/paths.hpp>

namespace raylanes::bench {

void register_root_rows(const Path& path);

}  // namespace raylanes::bench
