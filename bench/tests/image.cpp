// Pictures: written, read back through libpng, and shaded.
#include "../support/pictures/image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <vector>

#include "../support/pictures/heatmap.hpp"
#include "../support/pictures/slice.hpp"
#include "scene_samples.hpp"

namespace raylanes::bench {
namespace {

// Reads a picture back through libpng.
std::vector<std::uint8_t> read_png(const fs::path& file, std::uint32_t width, std::uint32_t height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&image, file.c_str()));
  EXPECT_EQ(image.width, width);
  EXPECT_EQ(image.height, height);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr));
  return rgb;
}

TEST(WritePng, reads_back_the_same) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgb(3 * 7 * 5);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(37 * i);
  write_png(folder / "a.png", 7, 5, rgb);
  EXPECT_EQ(read_png(folder / "a.png", 7, 5), rgb);
  EXPECT_THROW(write_png(folder / "a.png", 7, 6, rgb), std::invalid_argument);
}

TEST(SliceColours, tell_sides_apart_and_grow_darker) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> distances{-1, -0.05f, 0, 0.05f, 0.15f, 1, infinity, -infinity};
  const std::vector<std::uint8_t> rgb = slice_colours(distances);
  ASSERT_EQ(rgb.size(), 3 * distances.size());
  EXPECT_EQ(largest_size(distances), 1.0f);
  const auto sum = [&](std::size_t i) { return rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2]; };
  EXPECT_EQ(sum(2), 0);
  for (const std::size_t inside : {0u, 1u, 7u}) EXPECT_GT(rgb[3 * inside + 2], rgb[3 * inside]);
  for (const std::size_t outside : {3u, 4u, 5u, 6u}) EXPECT_GT(rgb[3 * outside], rgb[3 * outside + 2]);
  EXPECT_LT(sum(0), sum(1));
  EXPECT_LT(sum(4), sum(3));
  EXPECT_LT(sum(5), sum(4));
  EXPECT_EQ(sum(6), sum(5));
}

TEST(Shade, sky_surface_shadow_and_darkness) {
  const Scene scene{"three", three, front};
  const std::vector<Ray> rays(4, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const std::vector<Hit> hits{{5, 0.25f, 0.5f, 0}, {5, 0.25f, 0.5f, 0}, {5, 0, 0, 1}, miss};
  const std::vector<std::uint8_t> occluded{0, 1};
  const auto rgb = shade(scene, rays, hits, occluded, {0, 0, 9});
  ASSERT_EQ(rgb.size(), 12u);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_GT(rgb[channel], rgb[3 + channel] + 40);  // lit against in shadow
    EXPECT_GT(rgb[3 + channel], 40);                 // which can still be seen
    EXPECT_EQ(rgb[6 + channel], 0);                  // no area, no colour
    EXPECT_GT(rgb[9 + channel], 150);                // sky
  }
  EXPECT_THROW(shade(scene, rays, hits, {}, {0, 0, 9}), std::invalid_argument);
}

using Rgb = std::array<int, 3>;
constexpr Rgb cheapest{68, 1, 84}, middle{33, 145, 140}, dearest{253, 231, 37};

// The pixels in colours of the scale: not black letters and white paper.
std::vector<Rgb> heat_of(const HeatPicture& picture) {
  std::vector<Rgb> heat;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const Rgb pixel{picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
    if (pixel != Rgb{0, 0, 0} && pixel != Rgb{255, 255, 255}) heat.push_back(pixel);
  }
  return heat;
}

TEST(Heatmap, from_violet_to_yellow_on_one_scale) {
  const HeatRow row{"tests", {{"a", {0, 50, 100, 100}}, {"b", std::vector<std::uint64_t>(4, 25)}}};
  const HeatPicture picture = heatmap(std::span(&row, 1), 2, 2);
  ASSERT_EQ(picture.rgb.size(), std::size_t{3} * picture.width * picture.height);
  const auto heat = heat_of(picture);
  // The panels, and the legend in the same colours, twelve pixels high.
  EXPECT_EQ(std::ranges::count(heat, cheapest) % 12, 1);
  EXPECT_EQ(std::ranges::count(heat, middle) % 12, 1);
  EXPECT_EQ(std::ranges::count(heat, dearest) % 12, 2);
  EXPECT_EQ(std::ranges::count(heat, Rgb{59, 82, 139}) % 12, 4);
}

TEST(Heatmap, one_pixel_that_costs_much_leaves_the_scale) {
  HeatRow row{"tests", {{"a", std::vector<std::uint64_t>(1000, 10)}}};
  row.panels[0].tests[3] = 1000000;
  const auto heat = heat_of(heatmap(std::span(&row, 1), 100, 10));
  EXPECT_GE(std::ranges::count(heat, dearest), 1000);
}

}  // namespace
}  // namespace raylanes::bench
