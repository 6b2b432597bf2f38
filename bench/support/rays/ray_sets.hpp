// The rays of a picture: from the camera, to a light, bounced, and short ones around each point; and orders of pixels.
// All are computed in double and rounded once. A ray set does not depend on the order of its pixels.
#pragma once

#include <raylanes/types.hpp>

#include "../scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

// One ray through the centre of each pixel, row by row from the top left, width·height in all; of more samples, a
// square number, so many for each pixel, one after the other: each at random in a cell of its own, as many by as many
// (stratified), always in the same places. Directions are not normalised: they reach a plane one unit before the eye.
// tmin is 0, tmax infinite.
// Throws std::invalid_argument for a size of 0, samples that are no square number, an opening angle outside (0,
// 180), an eye equal to look_at, numbers that are not finite. If `up` is zero or along the line of sight, an axis
// across it serves.
std::vector<Ray> primary_rays(const Camera& camera, std::uint32_t width, std::uint32_t height,
                              std::uint32_t samples = 1);

// The positions in `hits` of rays that hit a triangle with an area, rising: secondary rays start there. Each set below
// has one ray for each of them, in this order. The other functions take the same `hits`. Throws std::invalid_argument
// if a hit names a triangle that the mesh does not have.
std::vector<std::size_t> secondary_origins(std::span<const Hit> hits, const Mesh& mesh);

// Secondary rays begin beside their surface and end before the light, so that engines that cannot leave out a triangle
// trace the same rays. Programs that use raylanes name the triangle instead: TraceOptions::skip.
// From each hit point to the light, tmin 0, tmax slightly below 1: the unnormalised direction ends at the light. The
// start is (1-u-v)·v0 + u·v1 + v·v2, moved off the triangle towards the side of the light: by 2^-21 of the mesh's
// diagonal and in ULP of the point. Source: Waechter, Binder, "A Fast and Robust Method for Avoiding
// Self-Intersection", Ray Tracing Gems, 2019.
std::vector<Ray> shadow_rays(std::span<const Hit> hits, const Mesh& mesh, const Float3& light);

// From the light to just before the start of each shadow ray, tmin 0, tmax 1 - 2^-12: the same shadows, by rays that
// share an origin.
std::vector<Ray> rays_from_light(std::span<const Ray> shadow, const Float3& light);

// From each hit point one bounce of cosine distribution (Malley's method) about the geometric normal, on
// the side the primary ray came from; direction of length 1, tmin 0, tmax infinite. The random numbers come
// from `seed` and the position in `hits`. Throws std::invalid_argument unless there is a hit for each
// primary ray.
std::vector<Ray> diffuse_rays(std::span<const Ray> primary, std::span<const Hit> hits, const Mesh& mesh,
                              std::uint64_t seed);

// The same as diffuse_rays, but tmax is a tenth of the diagonal of the mesh.
std::vector<Ray> ambient_occlusion_rays(std::span<const Ray> primary, std::span<const Hit> hits,
                                        const Mesh& mesh, std::uint64_t seed);

// So many rays that have nothing in common: from points spread evenly over a sphere around the mesh, whose radius is
// the mesh's diagonal, to points spread evenly over its bounds; tmin 0, tmax infinite. None of an empty mesh.
std::vector<Ray> random_rays(const Mesh& mesh, std::size_t count, std::uint64_t seed);

// A light for the scene. If the eye is inside the bounds of the mesh (an interior): above and to the left of
// the eye, by 8 % of the way to look_at each but at most 5 % of the diagonal, so that it stays in the room.
// Otherwise above and to the left behind the eye, as far from the middle of the mesh as the eye or a diagonal,
// whichever is more.
Float3 default_light(const Scene& scene);

// Row by row, as a renderer makes them; tiles of 4 × 4 in blocks of 32 × 32, so that neighbours in the batch are
// neighbours in the picture; or shuffled, always in the same way.
enum class PixelOrder : std::uint8_t { rows, tiles, shuffled };
inline constexpr std::array<std::string_view, 3> pixel_order_names{"rows", "tiles", "shuffled"};

// The numbers of all pixels, counted row by row. Throws std::invalid_argument for an order that does not exist.
std::vector<std::size_t> pixels_in(PixelOrder order, std::uint32_t width, std::uint32_t height);

}  // namespace raylanes::bench
