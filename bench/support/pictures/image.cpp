#include "image.hpp"

#include <png.h>

#include "../../report/exits.hpp"
#include "../../report/whole_file.hpp"
#include "../rays/ray_sets.hpp"
#include "../rays/surface.hpp"

namespace raylanes::bench {
namespace {

using Colour = Double3;  // linear red, green, blue

Colour mix(const Colour& a, const Colour& b, double t) {
  return add(scale(a, 1 - t), scale(b, t));
}

Colour sky(const Double3& direction, const Double3& up) {
  constexpr Colour horizon{0.80, 0.84, 0.88}, zenith{0.22, 0.38, 0.66}, ground{0.42, 0.40, 0.38};
  const double height = dot(direction, up);
  return height > 0 ? mix(horizon, zenith, std::sqrt(height))
                    : mix(horizon, ground, std::min(1.0, -4 * height));
}

// Lambert's law three times over: a sky dome bluish from above and brownish from below, a lamp at the eye
// that tells apart surfaces in shadow, and the light.
Colour surface_colour(const Double3& normal, const Double3& to_eye, const Double3& to_light,
                      const Double3& up, bool lit) {
  constexpr Colour albedo{0.78, 0.75, 0.70}, sky_light{0.20, 0.24, 0.30}, ground_light{0.11, 0.09, 0.07};
  constexpr Colour eye_light{0.16, 0.16, 0.17}, sun{0.82, 0.76, 0.66};
  Colour light = mix(ground_light, sky_light, 0.5 + 0.5 * dot(normal, up));
  light = add(light, scale(eye_light, std::max(0.0, dot(normal, to_eye))));
  if (lit) light = add(light, scale(sun, std::max(0.0, dot(normal, to_light))));
  return {albedo[0] * light[0], albedo[1] * light[1], albedo[2] * light[2]};
}

std::uint8_t to_srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

// The mean of so many colours after each other is one.
std::vector<std::uint8_t> pixels_of(std::span<const Colour> colours, std::uint32_t samples) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * colours.size() / samples);
  for (std::size_t first = 0; first < colours.size(); first += samples) {
    Colour sum{};
    for (const Colour& colour : colours.subspan(first, samples)) sum = add(sum, colour);
    for (const double channel : sum) rgb.push_back(to_srgb(channel / samples));
  }
  return rgb;
}

Double3 unit_up(const Camera& camera) {
  const Double3 up = to_double(camera.up);
  return length(up) > 0 ? normalized(up) : Double3{0, 1, 0};
}

}  // namespace

void write_png(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height,
               std::span<const std::uint8_t> rgb) {
  if (width == 0 || height == 0 || rgb.size() != std::size_t{3} * width * height)
    throw std::invalid_argument(file.string() + ": " + std::to_string(rgb.size()) +
                                " bytes for a picture of " + std::to_string(width) + " x " +
                                std::to_string(height) +
                                " pixels, allowed are 3 for each pixel of at least one");
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  // In memory first: libpng's own writer of files removes a file that it cannot complete.
  std::string png(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = png.size();
  if (!png_image_write_to_memory(&image, png.data(), &size, 0, rgb.data(), 0, nullptr))
    throw OutputError(file.string() + ": cannot be written: " + image.message);
  write_whole_file(file, std::string_view(png).substr(0, size));
}

std::vector<std::uint8_t> shade(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits,
                                std::span<const std::uint8_t> shadow_occluded, const Float3& light,
                                std::uint32_t samples) {
  const std::vector<std::size_t> lit_from = secondary_origins(hits, scene.mesh);
  if (rays.size() != hits.size() || lit_from.size() != shadow_occluded.size())
    throw std::invalid_argument("picture: " + std::to_string(rays.size()) + " rays, " +
                                std::to_string(hits.size()) + " hits, " + std::to_string(lit_from.size()) +
                                " points to light, " + std::to_string(shadow_occluded.size()) +
                                " shadows: rays and hits, points and shadows must be as many");
  if (samples == 0 || rays.size() % samples != 0)
    throw std::invalid_argument("picture: " + std::to_string(rays.size()) + " rays, " +
                                std::to_string(samples) + " for each pixel");
  const Double3 up = unit_up(scene.camera);
  std::vector<Colour> colours(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (hits[i].primitive == no_primitive) colours[i] = sky(normalized(to_double(rays[i].direction)), up);
  for (std::size_t k = 0; k < lit_from.size(); ++k) {
    const std::size_t i = lit_from[k];
    const Double3 direction = normalized(to_double(rays[i].direction));
    const Double3 normal = normal_against(direction, surface_normal(scene.mesh, hits[i].primitive));
    const Double3 to_light = normalized(subtract(to_double(light), hit_point(scene.mesh, hits[i])));
    colours[i] = surface_colour(normal, scale(direction, -1), to_light, up, shadow_occluded[k] == 0);
  }
  return pixels_of(colours, samples);
}

float largest_size(std::span<const float> distances) {
  float largest = 0.0f;
  for (const float distance : distances)
    if (std::isfinite(distance)) largest = std::max(largest, std::abs(distance));
  return largest;
}

// Ends of Brewer's sequences of blues and oranges (ColorBrewer 2), which people who see no red or green tell apart.
std::vector<std::uint8_t> slice_colours(std::span<const float> distances) {
  constexpr double near[2][3] = {{253, 224, 190}, {198, 219, 239}}, far[2][3] = {{127, 39, 4}, {8, 48, 107}};
  constexpr double second_band = 0.9;
  const double largest = largest_size(distances);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * distances.size());
  for (const float distance : distances) {
    const std::size_t side = distance < 0 ? 1 : 0;
    const double share = largest > 0 ? std::min(std::abs(double{distance}) / largest, 1.0) : 1.0;
    const bool is_second = static_cast<int>(10 * share) % 2 != 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double mixed = (1 - share) * near[side][c] + share * far[side][c];
      const double colour = is_second ? second_band * mixed : mixed;
      rgb.push_back(static_cast<std::uint8_t>(distance == 0 ? 0 : std::lround(colour)));
    }
  }
  return rgb;
}

}  // namespace raylanes::bench
