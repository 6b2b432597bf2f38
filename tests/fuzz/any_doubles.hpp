// Meshes of any finite doubles, and rays of any bits that may meet them.
#pragma once

#include "../../bench/support/oracles/exact_rays.hpp"
#include "support.hpp"

namespace raylanes::testing {
using namespace oracle;

// Any bits, or numbers on a lattice that is moved and scaled, so that rays meet things.
class DoubleCoordinates {
 public:
  explicit DoubleCoordinates(Bytes& bytes)
      : bytes_(bytes),
        style_(bytes.below(3)),
        scale_(std::ldexp(1.0, bytes.pick({-1070, -900, -300, -190, -60, 0, 0, 0, 60, 190, 300, 900, 1015}))),
        offset_(bytes.chance(128) ? 0.0 : scale_ * bytes.pick({1e3, 0x1p24, 5e6, 0x1p40, 0x1p50})) {}
  double operator()() {
    if (style_ == 0 || (style_ == 2 && bytes_.chance(24))) return bytes_.number<double>();
    return offset_ + difference();
  }
  double difference() {
    const double x = style_ == 1 ? (static_cast<int>(bytes_.below(9)) - 4) / 2.0
                                 : static_cast<std::int16_t>(bytes_.word<std::uint16_t>()) * 0x1p-14;
    return x * scale_;
  }

 private:
  Bytes& bytes_;
  std::size_t style_;
  double scale_, offset_;
};

inline constexpr std::size_t max_double_triangles = 24;

inline DoubleMesh any_double_mesh(Bytes& bytes, DoubleCoordinates& coordinates) {
  DoubleMesh mesh;
  const std::size_t triangles = bytes.below(max_double_triangles), vertices = triangles + 3;
  for (std::size_t i = 0; i < vertices; ++i) {
    Double3& vertex = mesh.vertices.emplace_back();
    for (double& x : vertex) {
      x = coordinates();
      if (!std::isfinite(x)) x = std::signbit(x) ? -1e308 : 1e308;
    }
  }
  const auto corner = [&] { return static_cast<std::uint32_t>(bytes.below(vertices)); };
  for (std::size_t i = 0; i < triangles; ++i) mesh.triangles.push_back({corner(), corner(), corner()});
  return mesh;
}

inline RayD any_double_ray(Bytes& bytes, DoubleCoordinates& coordinates, const DoubleMesh& mesh) {
  RayD ray;
  for (double& x : ray.origin) x = coordinates();
  for (double& x : ray.direction) x = bytes.chance(20) ? bytes.number<double>() : coordinates.difference();
  if (bytes.chance(100)) {
    const Double3& target = bytes.pick(mesh.vertices);
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = target[k] - ray.origin[k];
  }
  if (bytes.chance(30)) ray.origin = bytes.pick(mesh.vertices);
  if (bytes.chance(60)) ray.tmin = bytes.chance(128) ? bytes.number<double>() : -HUGE_VAL;
  if (bytes.chance(60)) ray.tmax = bytes.number<double>();
  return ray;
}

}  // namespace raylanes::testing
