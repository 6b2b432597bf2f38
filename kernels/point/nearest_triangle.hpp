// The nearest triangle so far, in doubles: what decides, the same on every path.
#pragma once

#include <bit>
#include <limits>

#include "../../dispatch/table.hpp"
#include "point_triangle.hpp"

namespace raylanes {
namespace {

template <int N>
using Doubles = Lanes<double, N>;
// Lanes of doubles that half the lanes of floats make; the one that there is.
template <int N>
inline constexpr int half_of = N == 1 ? 1 : N / 2;

// A point to all lanes.
template <int N>
inline Vec3<Doubles<N>> doubles_of(const Float3& point) {
  return {Doubles<N>(static_cast<double>(point[0])), Doubles<N>(static_cast<double>(point[1])),
          Doubles<N>(static_cast<double>(point[2]))};
}

class NearestTriangle {
 public:
  explicit NearestTriangle(double most_squared) : distance_squared_(most_squared) {}
  double distance_squared() const { return distance_squared_; }

  // Half the lanes of a register of triangles, by their corners; `lanes` are the bits of those that count. The numbers
  // by which triangles.primitive and answer() find them are `triangle`, lane by lane.
  template <int half, int N, class Triangles>
  void keep(const Vec3<Doubles<half_of<N>>>& point, const Floats<N> (&corner)[9], std::uint32_t lanes,
            const std::uint32_t (&triangle)[N], const Triangles& triangles) {
    using V = Doubles<half_of<N>>;
    const auto vertex = [&](int k) {
      return Vec3<V>(to_doubles<half>(corner[k]), to_doubles<half>(corner[k + 1]),
                     to_doubles<half>(corner[k + 2]));
    };
    PointOnTriangle<V> h =
        PointTriangle<V, Grade::reproducible>::closest(point, vertex(0), vertex(3), vertex(6));
    constexpr int offset = half * half_of<N>;
    lanes =
        lanes >> offset & bits((h.distance_squared <= V(distance_squared_)) & (h.shortest_squared > V(0.0)) &
                               (h.edges_squared < V(std::numeric_limits<double>::infinity())));
    if (lanes == 0) return;
    double distance_squared[half_of<N>], u[half_of<N>], v[half_of<N>];
    h.distance_squared.store(distance_squared), h.u.store(u), h.v.store(v);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const std::uint32_t candidate = triangle[offset + lane], primitive = triangles.primitive(candidate);
      const double d = distance_squared[lane];
      if (d > distance_squared_ || (d == distance_squared_ && primitive >= primitive_)) continue;
      distance_squared_ = d, u_ = u[lane], v_ = v[lane];
      triangle_ = candidate, primitive_ = primitive;
    }
  }

  // triangles.number(k, triangle) is a corner's coordinate.
  template <class Triangles>
  ClosestPoint answer(const Triangles& triangles) const {
    ClosestPoint closest;
    if (primitive_ == no_primitive) return closest;
    const auto vertex = [&](int k) {
      return doubles_of<1>({triangles.number(k, triangle_), triangles.number(k + 1, triangle_),
                            triangles.number(k + 2, triangle_)});
    };
    Vec3<Doubles<1>> at = PointTriangle<Doubles<1>, Grade::reproducible>::at(
        {distance_squared_, u_, v_, 0.0, 0.0}, vertex(0), vertex(3), vertex(6));
    closest.distance_squared = distance_squared_;
    closest.point = {static_cast<float>(at.x.raw), static_cast<float>(at.y.raw),
                     static_cast<float>(at.z.raw)};
    closest.u = static_cast<float>(u_), closest.v = static_cast<float>(v_), closest.primitive = primitive_;
    return closest;
  }

 private:
  double distance_squared_, u_ = 0.0, v_ = 0.0;
  std::uint32_t primitive_ = no_primitive, triangle_ = 0;
};

// A register of triangles: out of line, as it is long and rare.
template <int N, class Triangles>
[[gnu::flatten, gnu::noinline]] void keep_nearest(NearestTriangle& nearest,
                                                  const Vec3<Doubles<half_of<N>>>& point,
                                                  const Floats<N> (&corner)[9], std::uint32_t lanes,
                                                  const std::uint32_t (&triangle)[N],
                                                  const Triangles& triangles) {
  nearest.keep<0>(point, corner, lanes, triangle, triangles);
  if constexpr (half_of<N> < N)
    if (lanes >> half_of<N> != 0) nearest.keep<1>(point, corner, lanes, triangle, triangles);
}

}  // namespace
}  // namespace raylanes
