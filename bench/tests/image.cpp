// Pictures: written, read back through libpng, and shaded.
#include "../support/pictures/image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "../../tests/support/message_of.hpp"
#include "../support/pictures/heatmap.hpp"
#include "../support/pictures/lettering.hpp"
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
  for (int again = 0; again < 2; ++again) {
    write_png(folder / "a.png", 7, 5, rgb);
    EXPECT_EQ(read_png(folder / "a.png", 7, 5), rgb);
    std::ranges::reverse(rgb);
  }
}

TEST(WritePng, refuses_wrong_sizes_and_files) {
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> rgb(12);
  EXPECT_THROW(write_png(folder / "a.png", 2, 3, rgb), std::invalid_argument);
  EXPECT_THROW(write_png(folder / "a.png", 0, 3, {}), std::invalid_argument);
  const fs::path nowhere = folder / "missing" / "a.png";
  const std::string message = message_of([&] { write_png(nowhere, 2, 2, rgb); });
  EXPECT_TRUE(message.starts_with(nowhere.string() + ": ")) << message;
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
  EXPECT_EQ(slice_colours(std::vector<float>{0.0f}), (std::vector<std::uint8_t>(3)));
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

// Without colour vision the order of lightness is left: CIE L* of sRGB, which each step of the legend raises.
TEST(Heatmap, lightness_grows_along_the_scale) {
  const HeatRow row{"tests", {{"a", std::vector<std::uint64_t>(1, 7)}}};
  const HeatPicture picture = heatmap(std::span(&row, 1), 1, 1);
  const auto linear = [](double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
  };
  const auto lightness = [&](const Rgb& c) {
    const double y =
        0.2126 * linear(c[0] / 255.0) + 0.7152 * linear(c[1] / 255.0) + 0.0722 * linear(c[2] / 255.0);
    return 116 * std::cbrt(y) - 16;
  };
  // The longest line of pixels in colours of the scale is one of the legend.
  std::vector<Rgb> line, legend;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    const Rgb pixel{picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
    if (pixel == Rgb{0, 0, 0} || pixel == Rgb{255, 255, 255})
      line.clear();
    else
      line.push_back(pixel);
    if (line.size() > legend.size()) legend = line;
  }
  ASSERT_GE(legend.size(), 100u);
  for (std::size_t i = 0; i + 10 < legend.size(); i += 10)
    EXPECT_GT(lightness(legend[i + 10]), lightness(legend[i]) + 2) << i;
}

TEST(Heatmap, one_pixel_that_costs_much_leaves_the_scale) {
  HeatRow row{"tests", {{"a", std::vector<std::uint64_t>(1000, 10)}}};
  row.panels[0].tests[3] = 1000000;
  const auto heat = heat_of(heatmap(std::span(&row, 1), 100, 10));
  EXPECT_GE(std::ranges::count(heat, dearest), 1000);
}

TEST(Heatmap, that_costs_nothing_is_dark) {
  const HeatRow rows[] = {{"tests", {{"a", {0}}}}, {"boxes", {{"a", {0}}}}};
  const HeatPicture one = heatmap(std::span(rows).first(1), 1, 1), two = heatmap(rows, 1, 1);
  EXPECT_EQ(one.width, two.width);
  EXPECT_GT(two.height, one.height);
  EXPECT_GE(std::ranges::count(heat_of(two), cheapest), 2);
}

TEST(Heatmap, refuses_wrong_costs) {
  const HeatRow empty{"tests", {}}, short_of_one{"tests", {{"a", {1, 2, 3}}}};
  EXPECT_THROW(heatmap({}, 1, 1), std::invalid_argument);
  EXPECT_THROW(heatmap(std::span(&empty, 1), 1, 1), std::invalid_argument);
  EXPECT_THROW(heatmap(std::span(&short_of_one, 1), 0, 3), std::invalid_argument);
  EXPECT_EQ(message_of([&] { heatmap(std::span(&short_of_one, 1), 2, 2); }),
            "heatmap: a has 3 pixels instead of 4");
}

// All letters of names and numbers, each its own.
TEST(Lettering, every_glyph_is_there_once) {
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
