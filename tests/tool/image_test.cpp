// Pictures: written, read back through libpng, and shaded.
#include "../../bench/support/pictures/image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../bench/support/pictures/heatmap.hpp"
#include "../../bench/support/pictures/lettering.hpp"
#include "../../bench/support/pictures/slice.hpp"
#include "../support/message_of.hpp"
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

TEST(WritePng, ReadsBackTheSame) {
  const TemporaryFolder folder;
  std::vector<std::uint8_t> rgb(3 * 7 * 5);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(37 * i);
  for (int again = 0; again < 2; ++again) {
    write_png(folder / "a.png", 7, 5, rgb);
    EXPECT_EQ(read_png(folder / "a.png", 7, 5), rgb);
    std::ranges::reverse(rgb);
  }
}

TEST(WritePng, Errors) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb(12);
  EXPECT_THROW(write_png(folder / "a.png", 2, 3, rgb), std::invalid_argument);
  EXPECT_THROW(write_png(folder / "a.png", 0, 3, {}), std::invalid_argument);
  const fs::path nowhere = folder / "missing" / "a.png";
  const std::string message = message_of([&] { write_png(nowhere, 2, 2, rgb); });
  EXPECT_TRUE(message.starts_with(nowhere.string() + ": ")) << message;
}

TEST(SliceColours, TellSidesApartAndGrowDarker) {
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
  EXPECT_EQ(slice_colours(std::vector<float>{0.0f}), (std::vector<std::uint8_t>(3)));
}

TEST(Shade, SkySurfaceShadowAndDarkness) {
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
  // Two rays a pixel: the light of lit and shadowed halves, of dark and sky, is halved before it is encoded.
  const auto means = shade(scene, rays, hits, occluded, {0, 0, 9}, 2);
  ASSERT_EQ(means.size(), 6u);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_LT(means[channel], rgb[channel]);
    EXPECT_GT(means[channel], (rgb[channel] + rgb[3 + channel]) / 2);  // brighter than the mean of codes
    EXPECT_GT(means[3 + channel], rgb[9 + channel] / 2 + 10);
  }
  EXPECT_THROW(shade(scene, rays, hits, occluded, {0, 0, 9}, 3), std::invalid_argument);
  EXPECT_THROW(shade(scene, rays, hits, occluded, {0, 0, 9}, 0), std::invalid_argument);
  EXPECT_THROW(shade(scene, rays, hits, {}, {0, 0, 9}), std::invalid_argument);
  EXPECT_THROW(shade(scene, {}, hits, occluded, {0, 0, 9}), std::invalid_argument);
}

// Where colours of the scale are: black letters and white paper are none.
std::vector<std::vector<int>> heat_of(const HeatPicture& picture) {
  std::vector<std::vector<int>> reds_and_greens;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3)
    if (picture.rgb[i + 2] == 0 && picture.rgb[i] + picture.rgb[i + 1] > 0)
      reds_and_greens.push_back({picture.rgb[i], picture.rgb[i + 1]});
  return reds_and_greens;
}

TEST(Heatmap, FromGreenToRedOnOneScale) {
  const HeatRow row{"tests", {{"a", {0, 50, 100, 100}}, {"b", std::vector<std::uint64_t>(4, 25)}}};
  const HeatPicture picture = heatmap(std::span(&row, 1), 2, 2);
  ASSERT_EQ(picture.rgb.size(), std::size_t{3} * picture.width * picture.height);
  const auto heat = heat_of(picture);
  const auto count = [&](int red, int green) {
    return std::ranges::count(heat, std::vector<int>{red, green});
  };
  // The panels, and where the legend has the same colours, twelve pixels high.
  EXPECT_EQ(count(0, 255) % 12, 1);
  EXPECT_EQ(count(255, 255) % 12, 1);
  EXPECT_EQ(count(255, 0) % 12, 2);
  EXPECT_EQ(count(128, 255) % 12, 4);
  EXPECT_TRUE(std::ranges::all_of(heat, [](const auto& c) { return std::max(c[0], c[1]) == 255; }));
}

TEST(Heatmap, OnePixelThatCostsMuchLeavesTheScale) {
  HeatRow row{"tests", {{"a", std::vector<std::uint64_t>(1000, 10)}}};
  row.panels[0].tests[3] = 1000000;
  const auto heat = heat_of(heatmap(std::span(&row, 1), 100, 10));
  EXPECT_GE(std::ranges::count(heat, std::vector<int>{255, 0}), 1000);
}

TEST(Heatmap, ThatCostsNothingIsGreen) {
  const HeatRow rows[] = {{"tests", {{"a", {0}}}}, {"boxes", {{"a", {0}}}}};
  const HeatPicture one = heatmap(std::span(rows).first(1), 1, 1), two = heatmap(rows, 1, 1);
  EXPECT_EQ(one.width, two.width);
  EXPECT_GT(two.height, one.height);
  EXPECT_GE(std::ranges::count(heat_of(two), std::vector<int>{0, 255}), 2);
}

TEST(Heatmap, Errors) {
  const HeatRow empty{"tests", {}}, short_of_one{"tests", {{"a", {1, 2, 3}}}};
  EXPECT_THROW(heatmap({}, 1, 1), std::invalid_argument);
  EXPECT_THROW(heatmap(std::span(&empty, 1), 1, 1), std::invalid_argument);
  EXPECT_THROW(heatmap(std::span(&short_of_one, 1), 0, 3), std::invalid_argument);
  EXPECT_EQ(message_of([&] { heatmap(std::span(&short_of_one, 1), 2, 2); }),
            "heatmap: a has 3 pixels instead of 4");
}

// All letters of names and numbers, each its own.
TEST(Lettering, EveryGlyphIsThereOnce) {
  const std::string_view letters = "0123456789abcdefghijklmnopqrstuvwxyz_.:-+/,";
  std::vector<std::uint16_t> glyphs;
  for (const char c : letters) glyphs.push_back(glyph_of(c));
  std::ranges::sort(glyphs);
  EXPECT_GT(glyphs[0], 0);
  EXPECT_EQ(std::ranges::adjacent_find(glyphs), glyphs.end());
  EXPECT_EQ(glyph_of('A'), glyph_of('a'));
  EXPECT_EQ(glyph_of(' '), 0);
  EXPECT_TRUE(has_dot('l', 0, 0) && !has_dot('l', 2, 0) && has_dot('l', 2, 4));
}

}  // namespace
}  // namespace raylanes::bench
