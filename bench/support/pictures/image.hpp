// Pictures of scenes, and of slices of signed distances.
#pragma once

#include <filesystem>

#include <raylanes/types.hpp>

#include "../scenes/mesh_and_camera.hpp"

namespace raylanes::bench {

// Writes a PNG of 8 bits for each of red, green, blue (sRGB), row by row from the top left, by write_whole_file().
// Throws std::invalid_argument unless rgb has 3·width·height bytes and both are at least 1, OutputError naming the
// file if it cannot be written.
void write_png(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint8_t> rgb);

// The picture for write_png, 3 bytes for each pixel, which is the mean of the light of `samples` rays after each
// other: surfaces lit by the sky, by a weak lamp at the ray's origin, and by the light where it is not blocked; a
// sky where nothing is hit. Triangles without an area are dark. `shadow_occluded` has one entry for each of
// secondary_origins(hits, mesh), not 0 where the light is blocked. Throws std::invalid_argument if the sizes or
// the samples do not fit or a hit names a triangle that the mesh does not have.
std::vector<std::uint8_t> shade(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits,
                                std::span<const std::uint8_t> shadow_occluded, const Float3& light,
                                std::uint32_t samples = 1);

// Three bytes a distance, for write_png: blue inside, which is negative, orange outside, black on the surface, which is
// 0; light near it, and dark at the largest distance of both sides. Every second tenth of that is a shade darker, so
// that bands are as many tenths away.
std::vector<std::uint8_t> slice_colours(std::span<const float> distances);

// The largest size of those that are finite; 0 without any.
float largest_size(std::span<const float> distances);

}  // namespace raylanes::bench
