// What the examples share: vectors, a mesh made by a formula, a camera, and a PNG file by libpng.
#pragma once

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include <raylanes/raylanes.hpp>

namespace example {

using raylanes::Float3;

inline Float3 add(const Float3& a, const Float3& b, float times = 1) {
  return {a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]};
}
inline float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Float3 unit(const Float3& a) {
  return add({}, a, 1 / std::sqrt(dot(a, a)));
}

// A box around others, which begins empty, and half its area.
struct Bounds {
  Float3 lo{9, 9, 9}, hi{-9, -9, -9};

  void add(const Bounds& b) {
    for (std::size_t k = 0; k < 3; ++k) lo[k] = std::min(lo[k], b.lo[k]), hi[k] = std::max(hi[k], b.hi[k]);
  }
  float area() const {
    const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
    return x * y + y * z + z * x;
  }
};

// Writes grey levels from 0 (black) to 1, or three of them a pixel, row by row from the top.
inline void write_png(const std::string& file, std::size_t width, const std::vector<float>& levels,
                      std::size_t channels = 1) {
  std::vector<std::uint8_t> bytes;
  for (const float level : levels)
    bytes.push_back(static_cast<std::uint8_t>(255 * std::clamp(level, 0.0f, 1.0f) + 0.5f));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(levels.size() / channels / width);
  image.format = channels == 3 ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
  if (png_image_write_to_file(&image, file.c_str(), 0, bytes.data(), 0, nullptr) == 0)
    throw std::runtime_error(file + ": " + image.message);
}

// Writes a text of digits, small letters and -., into a picture of three channels, in black: characters of three by
// five dots, each of `scale`² pixels.
inline void write_text(std::vector<float>& levels, std::size_t width, std::size_t left, std::size_t top,
                       std::size_t scale, const std::string& text) {
  // A row of three dots an octal digit, the top row first.
  constexpr unsigned digits[] = {075557, 026227, 071747, 071717, 055711,
                                 074717, 074757, 071122, 075757, 075717};
  constexpr unsigned letters[] = {025755, 065656, 034443, 065556, 074647, 074644, 034553, 055755, 072227,
                                  011152, 055655, 044447, 057755, 065555, 025552, 065644, 025563, 065655,
                                  034216, 072222, 055557, 055552, 055775, 055255, 055222, 071247};
  const auto dots_of = [&](char c) {
    if (c >= 'a' && c <= 'z') return letters[c - 'a'];
    if (c >= '0' && c <= '9') return digits[c - '0'];
    return c == '-' ? 000700u : c == '.' ? 000002u : c == ',' ? 000024u : 0u;
  };
  for (std::size_t k = 0; k < text.size(); ++k) {
    const unsigned dots = dots_of(text[k]);
    for (std::size_t i = 0; i < 15 * scale * scale; ++i) {
      const std::size_t x = i % (3 * scale), y = i / (3 * scale);
      if ((dots >> (14 - y / scale * 3 - x / scale) & 1) == 0) continue;
      const std::size_t pixel = (top + y) * width + left + 4 * scale * k + x;
      std::fill_n(levels.begin() + static_cast<std::ptrdiff_t>(3 * pixel), 3, 0.0f);
    }
  }
}

// The same grey levels in three channels.
inline std::vector<float> in_colour(const std::vector<float>& levels) {
  std::vector<float> colours;
  for (const float level : levels) colours.insert(colours.end(), 3, level);
  return colours;
}

// Half as wide and high: the mean of each four neighbours, so that edges are smooth.
inline std::vector<float> halved(const std::vector<float>& levels, std::size_t width) {
  std::vector<float> half;
  for (std::size_t row = 0; row + width < levels.size(); row += 2 * width)
    for (std::size_t i = row; i < row + width; i += 2)
      half.push_back((levels[i] + levels[i + 1] + levels[i + width] + levels[i + width + 1]) / 4);
  return half;
}

// A closed ball with bumps, around `centre`: the eight sides of an octahedron, each cut into steps² triangles.
inline void append_ball(raylanes::Mesh& mesh, const Float3& centre, float radius, float bumps, int steps) {
  const auto point = [&](float x, float y, float z) {
    const Float3 n = unit({x, y, z});
    const float bump = 16 * n[0] * n[1] * n[2] * (n[0] * n[0] - n[1] * n[1]);
    return add(centre, n, radius * (1 + bumps * bump));
  };
  const float step = 1 / static_cast<float>(steps);
  for (int side = 0; side < 8; ++side) {
    const float x = side & 1 ? -1.0f : 1.0f, y = side & 2 ? -1.0f : 1.0f, z = side & 4 ? -1.0f : 1.0f;
    const auto corner = [&](int i, int j) {
      const float a = static_cast<float>(i) * step, b = static_cast<float>(j) * step;
      mesh.vertices.push_back(point(x * a, y * b, z * static_cast<float>(steps - i - j) * step));
    };
    const auto triangle = [&](int i, int j, int k, int l, int m, int n) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      corner(i, j), corner(k, l), corner(m, n);
      const bool turns = x * y * z < 0;  // corners run counter-clockwise as seen from outside
      mesh.triangles.push_back({first, turns ? first + 2 : first + 1, turns ? first + 1 : first + 2});
    };
    for (int i = 0; i < steps; ++i)
      for (int j = 0; i + j < steps; ++j) {
        triangle(i, j, i + 1, j, i, j + 1);
        if (i + j + 1 < steps) triangle(i + 1, j, i + 1, j + 1, i, j + 1);
      }
  }
}

// Two triangles below: a square floor at the height z.
inline void append_floor(raylanes::Mesh& mesh, float size, float z) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(),
                       {{-size, -size, z}, {size, -size, z}, {size, size, z}, {-size, size, z}});
  mesh.triangles.insert(mesh.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
}

// A ray for each pixel, row by row, from a point above the floor towards the middle.
inline std::vector<raylanes::Ray> camera_rays(std::size_t width, std::size_t height) {
  const Float3 eye{0, -4, 2}, ahead = unit({0, -4, -1.8f}), forward{0, -ahead[1], ahead[2]}, right{1, 0, 0};
  const Float3 up{0, -forward[2], forward[1]};
  std::vector<raylanes::Ray> rays;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const float h = static_cast<float>(height), half = 0.5f;
      const float i = (static_cast<float>(x) + half - half * static_cast<float>(width)) / h;
      const float j = (half * h - static_cast<float>(y) - half) / h;
      rays.push_back({.origin = eye, .direction = add(add(forward, right, 0.9f * i), up, 0.9f * j)});
    }
  return rays;
}

// The unit normal of a triangle, on the side that a ray sees.
inline Float3 normal_seen(const raylanes::Mesh& mesh, std::uint32_t primitive, const Float3& direction) {
  const auto& [a, b, c] = mesh.triangles[primitive];
  const Float3 n =
      unit(normal_of(raylanes::Triangle{{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}}));
  return dot(n, direction) > 0 ? add({}, n, -1) : n;
}

}  // namespace example
