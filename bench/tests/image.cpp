// Pictures: written, read back through libpng, and shaded.
#include "../support/pictures/image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "../support/pictures/heatmap.hpp"
#include "../support/pictures/slice.hpp"
#include "scene_samples.hpp"
#include "temporary_folder.hpp"

namespace raylanes::bench {
namespace {

TEST(WritePng, reads_back_the_same) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgb(3 * 7 * 5);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(37 * i);
  write_png(folder / "a.png", 7, 5, rgb);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&image, (folder / "a.png").c_str()));
  EXPECT_TRUE(image.width == 7 && image.height == 5);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(read, rgb);
}

TEST(SliceColours, tell_sides_apart_and_grow_darker) {
  const std::vector<float> distances{-1, -0.05f, 0, 0.05f, 0.15f, 1, infinity, -infinity};
  const std::vector<std::uint8_t> rgb = slice_colours(distances);
  ASSERT_EQ(rgb.size(), 3 * distances.size());
  EXPECT_EQ(largest_size(distances), 1.0f);
  const auto sum = [&](std::size_t i) { return rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2]; };
  for (const std::size_t inside : {0u, 1u, 7u}) EXPECT_GT(rgb[3 * inside + 2], rgb[3 * inside]);
  for (const std::size_t outside : {3u, 4u, 5u, 6u}) EXPECT_GT(rgb[3 * outside], rgb[3 * outside + 2]);
  EXPECT_TRUE(sum(2) == 0 && sum(0) < sum(1) && sum(4) < sum(3) && sum(5) < sum(4) && sum(6) == sum(5));
}

TEST(Shade, sky_surface_shadow_and_darkness) {
  const std::vector<Ray> rays(4, Ray{{0, 0, 5}, 0, {0, 0, -1}, 9});
  const std::vector<Hit> hits{{5, 0.25f, 0.5f, 0}, {5, 0.25f, 0.5f, 0}, {5, 0, 0, 1}, miss};
  const auto rgb = shade({"three", three, front}, rays, hits, std::vector<std::uint8_t>{0, 1}, {0, 0, 9});
  ASSERT_EQ(rgb.size(), 12u);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_GT(rgb[channel], rgb[3 + channel] + 40);  // lit against in shadow
    EXPECT_GT(rgb[3 + channel], 40);                 // which can still be seen
    EXPECT_EQ(rgb[6 + channel], 0);                  // no area, no colour
    EXPECT_GT(rgb[9 + channel], 150);                // sky
  }
}

using Rgb = std::array<std::uint8_t, 3>;

// How many pixels of one row of panels have the colour.
std::ptrdiff_t pixels_of(const Rgb& colour, const HeatRow& row, std::uint32_t width, std::uint32_t height) {
  const HeatPicture picture = heatmap(std::span(&row, 1), width, height);
  EXPECT_EQ(picture.rgb.size(), std::size_t{3} * picture.width * picture.height);
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
    count += Rgb{picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]} == colour;
  return count;
}

// The panels, and the legend in the same colours, twelve pixels high. One pixel that costs much leaves the scale.
TEST(Heatmap, from_violet_to_yellow_on_one_scale) {
  const HeatRow row{"tests", {{"a", {0, 50, 100, 100}}, {"b", std::vector<std::uint64_t>(4, 25)}}};
  const Rgb cheapest{68, 1, 84}, middle{33, 145, 140}, dearest{253, 231, 37};
  for (const auto& [colour, panels] : {std::pair{cheapest, 1}, {middle, 1}, {dearest, 2}, {{59, 82, 139}, 4}})
    EXPECT_EQ(pixels_of(colour, row, 2, 2) % 12, panels);
  HeatRow one{"tests", {{"a", std::vector<std::uint64_t>(1000, 10)}}};
  one.panels[0].tests[3] = 1000000;
  EXPECT_GE(pixels_of(dearest, one, 100, 10), 1000);
}

}  // namespace
}  // namespace raylanes::bench
