// Batches of rays of doubles, each part by the traversal that suits it.
#pragma once

#include <raylanes/doubles.hpp>

#include "../../dispatch/table/double_rays.hpp"
#include "../batch/ray_source.hpp"

namespace raylanes {

// The kernels of the path that the options name, which are checked.
const DoubleRayKernels& checked_kernels(const TraceOptionsD& options);

// Whether all triangles count for all rays.
bool takes_all(const TraceOptionsD& options);

// As BvhD::closest() and BvhD::occluded(). what: the word for the rays in messages.
void trace_hits(const DoubleTreeView& tree, const RaySourceOf<double>& rays, const HitViewD& hits,
                const TraceOptionsD& options);
void trace_occluded(const DoubleTreeView& tree, const RaySourceOf<double>& rays, const char* what,
                    std::span<std::uint8_t> occluded, const TraceOptionsD& options);

}  // namespace raylanes
