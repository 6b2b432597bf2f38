// The nearest triangle so far, in doubles: what decides, the same on every path.
#pragma once

#include <bit>
#include <limits>

#include <raylanes/numbers.hpp>

#include "../../dispatch/table/points.hpp"
#include "point_triangle.hpp"

namespace raylanes {
namespace {

// Lanes of doubles that half the lanes of floats make; the one that there is.
template <int N>
inline constexpr int half_of = N == 1 ? 1 : N / 2;

// A point to all lanes.
template <int N, class Point>
inline Vec3<Doubles<N>> doubles_of(const Point& point) {
  return {Doubles<N>(static_cast<double>(point[0])), Doubles<N>(static_cast<double>(point[1])),
          Doubles<N>(static_cast<double>(point[2]))};
}

// The results of doubles for triangles, and which of them count. In trees of doubles the squares of edges may be
// flushed: whether two corners are equal is looked at later, by corners as they are.
template <class T, class V>
struct MeasuredTriangles {
  PointOnTriangle<V> on;
  decltype(V() < V()) valid;

  MeasuredTriangles(const Vec3<V>& point, const Vec3<V>& v0, const Vec3<V>& v1, const Vec3<V>& v2) {
    TriangleEdges<V> edges = PointTriangle<V, Grade::reproducible>::set_up(v0, v1, v2);
    on = PointTriangle<V, Grade::reproducible>::closest(point, edges);
    if constexpr (std::is_same_v<T, float>)
      valid = (edges.shortest_squared > V(0.0)) &
              (edges.edges_squared < V(std::numeric_limits<double>::infinity()));
    else
      valid = on.distance_squared >= V(0.0);
  }
};

// T: the numbers of corners.
template <class T>
class NearestTriangle {
 public:
  explicit NearestTriangle(double max_squared = 0.0) : distance_squared_(max_squared) {}
  double distance_squared() const { return distance_squared_; }

  // Half the lanes of a register of floats.
  template <int half, int N, class Triangles>
  void keep_half(const Vec3<Doubles<half_of<N>>>& point, const Floats<N> (&corner)[9], std::uint32_t lanes,
                 const std::uint32_t (&triangle)[N], const Triangles& triangles) {
    const auto vertex = [&](int k) {
      return Vec3<Doubles<half_of<N>>>(to_doubles<half>(corner[k]), to_doubles<half>(corner[k + 1]),
                                       to_doubles<half>(corner[k + 2]));
    };
    constexpr int offset = half * half_of<N>;
    keep(point, vertex(0), vertex(3), vertex(6), lanes >> offset, triangle + offset, triangles);
  }
  // A register of triangles, by their corners; `lanes` are the bits of those that count. The numbers by which
  // triangles.primitive and answer() find them are `triangle`, lane by lane.
  template <int N, class Triangles>
  void keep(const Vec3<Doubles<N>>& point, const Vec3<Doubles<N>>& v0, const Vec3<Doubles<N>>& v1,
            const Vec3<Doubles<N>>& v2, std::uint32_t lanes, const std::uint32_t* triangle,
            const Triangles& triangles) {
    MeasuredTriangles<T, Doubles<N>> measured(point, v0, v1, v2);
    PointOnTriangle<Doubles<N>> h = measured.on;
    lanes = lanes & bits((h.distance_squared <= Doubles<N>(distance_squared_)) & measured.valid);
    if (lanes == 0) return;
    double distance_squared[N], u[N], v[N];
    h.distance_squared.store(distance_squared), h.u.store(u), h.v.store(v);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      keep(distance_squared[lane], u[lane], v[lane], triangle[lane], triangles);
    }
  }

  // One triangle.
  template <class Triangles>
  void keep(double distance_squared, double u, double v, std::uint32_t triangle, const Triangles& triangles) {
    const std::uint32_t primitive = triangles.primitive(triangle);
    if (distance_squared > distance_squared_ ||
        (distance_squared == distance_squared_ && primitive >= primitive_))
      return;
    if constexpr (std::is_same_v<T, double>)
      if (triangles.has_equal_corners(triangle)) return;
    distance_squared_ = distance_squared, u_ = u, v_ = v;
    triangle_ = triangle, primitive_ = primitive;
  }

  // triangles.number(k, triangle) is a corner's coordinate.
  template <class Triangles>
  ClosestPointOf<T> answer(const Triangles& triangles) const {
    ClosestPointOf<T> closest;
    if (primitive_ == no_primitive) return closest;
    const auto vertex = [&](int k) {
      return doubles_of<1>(PointOf<T>{triangles.number(k, triangle_), triangles.number(k + 1, triangle_),
                                      triangles.number(k + 2, triangle_)});
    };
    Vec3<Doubles<1>> at = PointTriangle<Doubles<1>, Grade::reproducible>::at({distance_squared_, u_, v_},
                                                                             vertex(0), vertex(3), vertex(6));
    closest.distance_squared = distance_squared_;
    closest.point = {static_cast<T>(at.x.raw), static_cast<T>(at.y.raw), static_cast<T>(at.z.raw)};
    closest.u = static_cast<T>(u_), closest.v = static_cast<T>(v_), closest.primitive = primitive_;
    if constexpr (std::is_same_v<T, double>) triangles.to_units_of_mesh(closest);
    return closest;
  }

 private:
  double distance_squared_, u_ = 0.0, v_ = 0.0;
  std::uint32_t primitive_ = no_primitive, triangle_ = 0;
};

// A register of triangles: out of line, as it is long and rare.
template <int N, class Triangles>
[[gnu::flatten, gnu::noinline]] void keep_nearest(NearestTriangle<float>& nearest,
                                                  const Vec3<Doubles<half_of<N>>>& point,
                                                  const Floats<N> (&corner)[9], std::uint32_t lanes,
                                                  const std::uint32_t (&triangle)[N],
                                                  const Triangles& triangles) {
  nearest.keep_half<0>(point, corner, lanes, triangle, triangles);
  if constexpr (half_of<N> < N)
    if (lanes >> half_of<N> != 0) nearest.keep_half<1>(point, corner, lanes, triangle, triangles);
}
template <int N, class Triangles>
[[gnu::flatten, gnu::noinline]] void keep_nearest(NearestTriangle<double>& nearest,
                                                  const Vec3<Doubles<N>>& point,
                                                  const Doubles<N> (&corner)[9], std::uint32_t lanes,
                                                  const std::uint32_t (&triangle)[N],
                                                  const Triangles& triangles) {
  nearest.keep(point, vec3(corner), vec3(corner + 3), vec3(corner + 6), lanes, triangle, triangles);
}

// Triangles each with a point of its own, by the nine coordinates of corners and the three of the point, `size` lanes.
template <int N, class T, class Triangles>
[[gnu::flatten, gnu::noinline]] void keep_pairs(NearestTriangle<T>* nearest, const double (&number)[12][N],
                                                int size, const std::uint32_t* point,
                                                const std::uint32_t* triangle, const Triangles& triangles) {
  const auto load = [&](int k) {
    using V = Doubles<N>;
    return Vec3<V>(V::load(number[k]), V::load(number[k + 1]), V::load(number[k + 2]));
  };
  MeasuredTriangles<T, Doubles<N>> measured(load(9), load(0), load(3), load(6));
  double distance_squared[N], u[N], v[N];
  measured.on.distance_squared.store(distance_squared), measured.on.u.store(u), measured.on.v.store(v);
  std::uint32_t valid = bits(measured.valid) & first_lanes<N>(static_cast<std::size_t>(size));
  for (; valid != 0; valid &= valid - 1) {
    const int lane = std::countr_zero(valid);
    nearest[point[lane]].keep(distance_squared[lane], u[lane], v[lane], triangle[lane], triangles);
  }
}

}  // namespace
}  // namespace raylanes
