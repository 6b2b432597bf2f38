// A part in a place: its transform, the inverse, and where it may be hit.
#pragma once

#include <raylanes/scene.hpp>

#include "../../dispatch/table/instances.hpp"

namespace raylanes {

// The place of an instance in its scene: added since the last update(); in the common tree; waiting until enough others
// wait to build that again; apart from it.
enum class Standing : std::uint8_t { added, common, waiting, apart };
// The standing of an instance that has changed.
constexpr Standing left(Standing standing) {
  return standing == Standing::added ? Standing::added : Standing::apart;
}

struct Instance : PlacedTree {
  Transform transform;
  double doubt;  // by which share the inverse may be wrong; negative: nothing is hit, there is no inverse
  Standing standing = Standing::added;
  // The instance that places the scene to which this one belongs; no_part: the caller has placed it.
  std::uint32_t placer = no_part;

  Instance(std::uint32_t geometry_, const Transform& transform_, std::uint32_t mask_);
};

// A conversion of a double beyond the largest float is undefined.
inline float float_or_infinity(double x) {
  constexpr double largest_float = std::numeric_limits<float>::max();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  return x > largest_float ? infinity : x < -largest_float ? -infinity : static_cast<float>(x);
}
// A point of a part in the scene.
inline Double3 moved_to_scene(const Transform& transform, const Float3& point) {
  Double3 moved;
  for (std::size_t i = 0; i < 3; ++i) {
    const float(&row)[4] = transform.row[i];
    const auto product = [&](std::size_t k) { return double{row[k]} * double{point[k]}; };
    moved[i] = ((product(0) + product(1)) + product(2)) + double{row[3]};
  }
  return moved;
}
inline Float3 in_scene_as_floats(const Instance& instance, const Float3& point) {
  if (instance.is_identity) return point;
  const Double3 moved = moved_to_scene(instance.transform, point);
  return {float_or_infinity(moved[0]), float_or_infinity(moved[1]), float_or_infinity(moved[2])};
}
// A point of the scene in the space of an instance, as kernels map the origins of rays.
inline Float3 in_part(const Instance& instance, const Float3& point) {
  if (instance.is_identity) return point;
  Float3 mapped;
  for (std::size_t i = 0; i < 3; ++i) {
    const double* const row = instance.inverse + i;
    mapped[i] = float_or_infinity(
        ((row[0] * double{point[0]} + row[3] * double{point[1]}) + row[6] * double{point[2]}) + row[9]);
  }
  return mapped;
}

// The padding of boxes: a share of the largest coordinate of a ray's origin, and a distance.
struct BoxPadding {
  float share = 0.0f, distance = 0.0f;
};
// The bounds of an instance of a part, for rays that are transformed as Scene says. The box contains all hits if it is
// padded by `share` of a ray's origin. Hits may lie outside the part's bounds by `slack` of the origin in the part's
// space. Triangle tests whose numbers are rounded need the padding `rounded` as well. The box is empty if nothing is
// hit.
struct InstanceBounds {
  Box box;
  float share = 0.0f;
  BoxPadding rounded = {};
};
InstanceBounds bounds_of(const Instance& instance, const Box& part, float slack);

// The product of two maps, `inner` first: each number is computed by numbers of type Wide and then rounded.
template <class Wide, class AnyTransform, class Round>
AnyTransform product_of(const AnyTransform& outer, const AnyTransform& inner, const Round& round) {
  AnyTransform product;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& row = outer.row[i];
    for (std::size_t j = 0; j < 4; ++j) {
      const auto term = [&](std::size_t k) { return Wide{row[k]} * Wide{inner.row[k][j]}; };
      const Wide linear = (term(0) + term(1)) + term(2);
      product.row[i][j] = round(j == 3 ? linear + Wide{row[3]} : linear);
    }
  }
  return product;
}
// As Scene::place() says.
inline Transform composed(const Transform& outer, const Transform& inner) {
  return product_of<double>(outer, inner, float_or_infinity);
}

}  // namespace raylanes
