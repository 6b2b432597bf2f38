// Pictures: written, read back through libpng, and shaded.
#include "../../bench/report/image.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

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
  const Folder folder;
  std::vector<std::uint8_t> rgb(3 * 7 * 5);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(37 * i);
  for (int again = 0; again < 2; ++again) {
    write_png(folder / "a.png", 7, 5, rgb);
    EXPECT_EQ(read_png(folder / "a.png", 7, 5), rgb);
    std::ranges::reverse(rgb);
  }
}

TEST(WritePng, Errors) {
  const Folder folder;
  const std::vector<std::uint8_t> rgb(12);
  EXPECT_THROW(write_png(folder / "a.png", 2, 3, rgb), std::invalid_argument);
  EXPECT_THROW(write_png(folder / "a.png", 0, 3, {}), std::invalid_argument);
  const fs::path nowhere = folder / "missing" / "a.png";
  const std::string message = message_of([&] { write_png(nowhere, 2, 2, rgb); });
  EXPECT_TRUE(message.starts_with(nowhere.string() + ": ")) << message;
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
  EXPECT_THROW(shade(scene, rays, hits, {}, {0, 0, 9}), std::invalid_argument);
  EXPECT_THROW(shade(scene, {}, hits, occluded, {0, 0, 9}), std::invalid_argument);
}

}  // namespace
}  // namespace raylanes::bench
