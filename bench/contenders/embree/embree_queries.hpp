// Rays in our layout through a scene of Embree, one at a time or in packets.
#pragma once

#include <embree3/rtcore.h>

#include <cstdint>
#include <span>

#include "embree_contender.hpp"

namespace raylanes::bench {

// The same as EmbreeContender::closest and any, for spans of equal sizes. Errors that Embree reports go to its device.
void trace_closest(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                   std::span<Hit> hits);
void trace_any(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
               std::span<std::uint8_t> occluded);
// Returns the seconds of the same calls: rays are in Embree's layout before the clock starts, and results are converted
// after it has stopped.
double trace_packed_closest(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                            std::span<Hit> hits);
double trace_packed_any(RTCScene scene, EmbreeMode mode, bool coherent, std::span<const Ray> rays,
                        std::span<std::uint8_t> occluded);
void trace_all(RTCScene scene, std::span<const Ray> rays, RayLists<Hit>& lists);

}  // namespace raylanes::bench
