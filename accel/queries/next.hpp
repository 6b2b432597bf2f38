// The hits behind those of options.after.
#pragma once

#include "../batch/ray_source.hpp"
#include "traced_tree.hpp"

namespace raylanes {

// As TraceOptions::after says; there are as many hits as rays.
void trace_next(const TracedTree& tree, const RaySource& rays, const HitView& hits,
                const TraceOptions& options);

}  // namespace raylanes
