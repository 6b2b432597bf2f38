// Points that rays of a batch share: exactly the point where they begin, or about the point where they end; and how
// finely rays look at a tree from there.
#pragma once

#include <raylanes/types.hpp>

#include "../../dispatch/table/double_rays.hpp"
#include "../standard.hpp"

namespace raylanes {

// The i-th of places spread over `size` so that no rows or columns show: multiples of the golden ratio.
std::size_t place_in_sample(std::size_t i, std::size_t size);

// Fewer rays of a point are not worth a packet: measured.
inline constexpr std::size_t min_shared_point = 64;

// How many rays have the first one's origin, and how many come before some that share one. One in many is looked at:
// among them may be others. AnyRay: Ray or RayD.
template <class AnyRay>
std::size_t count_of_origin(std::span<const AnyRay> rays);
template <class AnyRay>
std::size_t count_before_shared_origin(std::span<const AnyRay> rays);

// A point that the lines of rays meet at or behind their ends: a light, a sensor. Looks at a few rays spread over the
// batch, so other rays may end elsewhere. The point is the end of a segment, if direction and tmax reach it; else the
// point where two lines meet, which also serves segments that end before it.
std::optional<Float3> shared_end_of(std::span<const Ray> rays);

// Whether rays that follow each other are neighbours, as in the rows of a picture: of some spread over them most
// directions agree within `near`, and origins within that share of the box's diagonal.
template <class AnyRay, class AnyBox>
bool are_coherent(std::span<const AnyRay> rays, const AnyBox& box, double near = 0.02);
// Whether all of some rays spread over a batch pass the box by: most searches end at the root.
template <class AnyRay, class AnyBox>
bool pass_by(std::span<const AnyRay> rays, const AnyBox& box);
// Whether most rays of some spread over them begin outside the box.
template <class AnyRay, class AnyBox>
bool begin_outside(std::span<const AnyRay> rays, const AnyBox& box);

// How a ray meets the nearest triangle of a tree, as TraversalKernels and DoubleRayKernels have it.
template <class T>
using NearestTriangle = std::uint32_t (*)(const TreeViewOf<T>& tree, const RayOf<T>& ray);

// So many rays are in streams at a time.
inline constexpr std::size_t rays_of_streams = 65536;

// How many triangles the share of one ray in the view has: the mean over a few rays, of which each counts as eight at
// most, and the number of the middle one.
struct TrianglesOfRays {
  double mean = 0, middle = 0;
};

// About how many, where triangles are seen: the solid angle between a ray and its neighbours over that of the triangle
// it meets, both from the point. Rays without a common point are seen from their origins, and the nearer of those
// before and after in the batch is the neighbour. by_origins: the direction of neighbours says nothing. The share is
// then at most that of a ray among those in streams together, were they spread over the tree's bounds. Rays are traced
// from the point on, however far. If none of them meets a triangle, few rays see many, many rays and those by
// their origins none. Few rays that fill a wide solid angle see many, too: they are not worth a packet. At least three
// rays. The tree's blocks have corners.
template <class T>
TrianglesOfRays triangles_of_a_ray(const TreeViewOf<T>& tree, NearestTriangle<T> nearest,
                                   std::span<const RayOf<T>> rays, SharedApex shared, const PointOf<T>& point,
                                   bool by_origins = false);

// Whether no point of the box is farther away along an axis than so many times its largest side. Frusta are widened by
// a share of that way.
template <class AnyPoint, class AnyBox>
bool is_near(const AnyPoint& point, const AnyBox& box, double most_sizes);

// Whether rays that have a common point go as packets: not where these would test many triangles for each ray.
enum class PacketsOf { nearest_hits, any_hits, doubles };
bool packets_pay(const TrianglesOfRays& triangles, PacketsOf kind);

}  // namespace raylanes
