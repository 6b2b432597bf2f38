// Whether a ray hits a triangle, and where, for what a screen leaves undecided: by pairs of doubles, which nearly
// always decide, or by integers. Paths without AVX2 take doubles for pairs where numbers are floats.
#pragma once

#include "deferred_hits.hpp"
#if defined(__AVX2__) && defined(__FMA__)
#include "hit_in_pairs.hpp"
#endif

namespace raylanes {
namespace {

template <class AnyRay>
using NumberOfRay = typename decltype(AnyRay::origin)::value_type;

template <class Triangles, class AnyRay>
[[gnu::noinline]] auto hit_in_integers(const Triangles& triangles, const AnyRay& ray,
                                       std::uint32_t leaf_triangle) {
  using T = NumberOfRay<AnyRay>;
  const PredicateInput<T> in(triangles, ray, leaf_triangle);
  // With DAZ the sum is zero where floats take an end for zero.
  const auto found = detail::decide_exactly(in.origin, in.direction, in.corners, finite_tmin(ray.tmin) + T(0),
                                            finite_tmax(ray.tmax) + T(0));
  HitOf<T> hit;
  if (found.hit)
    hit.t = found.t + T(0), hit.u = found.u + T(0), hit.v = found.v + T(0),
    hit.primitive = triangles.primitive(leaf_triangle);
  return hit;
}

// A hit, or none, of which t is exact, rounded once, and u and v if they are clear.
template <class AnyHit>
struct DecidedHit {
  AnyHit hit;
  bool is_clear = true;
};

#if defined(__AVX2__) && defined(__FMA__)
template <class Triangles, class AnyRay>
inline HitInPairs<NumberOfRay<AnyRay>> numbers_of(const Triangles& triangles, const AnyRay& ray,
                                                  std::uint32_t leaf_triangle) {
  return {triangles, ray, leaf_triangle};
}
#else
template <class Triangles>
[[gnu::noinline]] DecidedHit<Hit> decided_hit(const Triangles& triangles, const Ray& ray,
                                              std::uint32_t leaf_triangle, const AlongAxes& along) {
  if (along.misses) return {};
  RayTrianglePairs<1> lane;
  set_lane(lane, 0, triangles, ray, leaf_triangle, SharedAxes(ray.direction));
  RoundedHits<1> rounded;
  decide_exactly(lane, 1u, rounded, along.zeros);
  if (rounded.lanes == 0) return {};
  return {{rounded.t[0], rounded.u[0], rounded.v[0], triangles.primitive(leaf_triangle)}};
}
#endif

// A ray and one triangle, with the ray's own ends.
template <class Triangles, class AnyRay>
[[gnu::noinline]] auto decided_hit(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle,
                                   const AlongAxes& along) {
  using Decided = DecidedHit<HitOf<NumberOfRay<AnyRay>>>;
  if (along.misses) return Decided();
  auto numbers = numbers_of(triangles, ray, leaf_triangle);
  if (along.zeros != 0) numbers.set_zeros(along.zeros);
  if (numbers.misses(ray.tmin, ray.tmax)) return Decided();
  if (numbers.has_t(ray.tmin, ray.tmax))
    return Decided{numbers.hit(triangles.primitive(leaf_triangle)), numbers.is_clear()};
  return Decided{hit_in_integers(triangles, ray, leaf_triangle)};
}
template <class Triangles, class AnyRay>
inline auto exact_hit(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle,
                      const AlongAxes& along) {
  const auto decided = decided_hit(triangles, ray, leaf_triangle, along);
  return decided.is_clear ? decided.hit : hit_in_integers(triangles, ray, leaf_triangle);
}
template <class Triangles, class AnyRay>
inline auto exact_hit(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle) {
  return exact_hit(triangles, ray, leaf_triangle, along_axes(triangles, ray, leaf_triangle));
}
// The numbers of a triangle that is hit, mostly in doubles.
#if defined(__AVX2__) && defined(__FMA__)
template <class Triangles, class Sizes>
[[gnu::always_inline]] inline Hit known_hit(const Triangles& triangles, const Ray& ray, const Sizes& sizes,
                                            std::uint32_t leaf_triangle) {
  const HitNumbers numbers(triangles, ray, sizes, leaf_triangle);
  if (!numbers.are_clear()) [[unlikely]]
    return exact_hit(triangles, ray, leaf_triangle);
  return numbers.hit(triangles.primitive(leaf_triangle));
}
#endif
template <class Triangles>
inline Hit known_hit(const Triangles& triangles, const Ray& ray, std::uint32_t leaf_triangle) {
#if defined(__AVX2__) && defined(__FMA__)
  const RaySizes sizes(triangles, ray, leaf_triangle);
  if (sizes.are_safe()) return known_hit(triangles, ray, sizes, leaf_triangle);
#endif
  return exact_hit(triangles, ray, leaf_triangle);
}
// A hit of which only t and the primitive matter: near edges only integers know u and v.
template <class Triangles, class AnyRay>
inline auto hit_to_compare(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle,
                           const AlongAxes& along) {
  return decided_hit(triangles, ray, leaf_triangle, along).hit;
}
template <class Triangles, class AnyRay>
inline auto hit_to_compare(const Triangles& triangles, const AnyRay& ray, std::uint32_t leaf_triangle) {
  return hit_to_compare(triangles, ray, leaf_triangle, along_axes(triangles, ray, leaf_triangle));
}

}  // namespace
}  // namespace raylanes
