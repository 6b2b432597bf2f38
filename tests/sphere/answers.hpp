// Every sphere test on rays and spheres: one result per pair, by all kernels at once, which must agree; and the
// scenes that spheres are tested with.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include <raylanes/intersect.hpp>

#include "../../bench/oracles/exact_sphere.hpp"
#include "../support/float_modes.hpp"
#include "../support/random_input.hpp"
#include "../support/soa.hpp"
#include "../support/variants.hpp"

namespace raylanes::testing {

using oracle::Sphere;
using SphereVariant = Variant<SphereTest>;

// Equality is that of the bits.
struct SphereResult {
  float near, far;
  std::uint32_t hit;
  friend bool operator==(const SphereResult& a, const SphereResult& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  }
};
inline constexpr SphereResult sphere_missed{infinity, -infinity, 0};

inline Sphere ball(const Float3& centre, float radius) {
  return {{centre[0], centre[1], centre[2], signed_square(radius)}};
}

SphereResult result_of(IntervalColumns& columns, std::size_t i);

class SphereColumns {
 public:
  explicit SphereColumns(std::span<const Sphere> spheres, Place place = Place::unguarded);
  Soa columns() const { return pointers_; }
  SphereArrays arrays() const { return {{pointers_[0], pointers_[1], pointers_[2]}, pointers_[3], size_}; }

 private:
  std::size_t size_;
  FloatColumns values_;
  const float* pointers_[4];
};

// All rays of sphere 0, all rays of sphere 1 …. Adds a test failure where they disagree or write outside.
std::vector<SphereResult> answers(const SphereVariant& variant, std::span<const Ray> rays,
                                  std::span<const Sphere> spheres, Place place = Place::unguarded);
std::vector<SphereResult> answers(const SphereVariant& variant, std::span<const Ray> rays,
                                  std::span<const Sphere> spheres, FloatMode mode);

// Whether the line that the ray is part of meets each sphere, in the same order.
std::vector<bool> line_answers(const Path& path, Grade grade, std::span<const Ray> rays,
                               std::span<const Sphere> spheres, FloatMode mode = FloatMode::ieee);

// The nearest of the spheres.
Hit closest_answer(const SphereVariant& variant, const Ray& ray, std::span<const Sphere> spheres);

struct SphereScene {
  std::vector<Ray> rays;
  std::vector<Sphere> spheres;
  std::size_t size() const { return rays.size() * spheres.size(); }
  const Ray& ray(std::size_t pair) const { return rays[pair % rays.size()]; }
  const Sphere& sphere(std::size_t pair) const { return spheres[pair / rays.size()]; }
};

// Nine spheres, three rays for each from up to `distance` radii away, which pass within 1.2 radii of the
// centre.
SphereScene sphere_scene(double distance, Random& random);

}  // namespace raylanes::testing
