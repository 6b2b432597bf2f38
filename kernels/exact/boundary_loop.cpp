// A loop of a boundary is the boundary of a cap F, triangles from any point to its edges. By the directions d and e of
// two rays from the point, the loop's term differs by what these rays cross:
//   term(d) + crossings(d, F) = term(e) + crossings(e, F) = the winding number of F.
// So the term is taken along a direction e that keeps away from the loop, where doubles do, and the crossings of both
// rays are exact. Compiled once, with one lane.
#include "boundary_loop.hpp"

#include <limits>

#include "../../dispatch/bits.hpp"
#include "../winding/solid_angle.hpp"
#include "predicate.hpp"

namespace raylanes {
namespace {

using Number = Lanes<double, 1>;
using Vector = Vec3<Number>;

using Reproducible = Arithmetic<Grade::reproducible>;

double dot_product(const Vector& a, const Vector& b) {
  return Reproducible::dot(a, b).raw;
}
Vector times(const Vector& a, Number factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}

struct Loop {
  const double (&point)[3];
  const double (*corners)[3];
  std::size_t count;

  Vector to_corner(std::size_t i) const {
    const double(&corner)[3] = corners[i % count];
    return {corner[0] - point[0], corner[1] - point[1], corner[2] - point[2]};
  }
};

// An edge as seen from the point. Near the edge a and b are nearly opposite: 1 + a·b comes from the length of a × b,
// which keeps its digits, because coordinates of floats leave room for products.
struct SeenEdge {
  Vector a, b, normal;  // two unit vectors and a × b
  double one_and_cosine;

  SeenEdge(const Loop& loop, std::size_t i) {
    const Vector to_a = loop.to_corner(i), to_b = loop.to_corner(i + 1);
    a = unit(to_a), b = unit(to_b);
    const Number size = sqrt(Number(dot_product(to_a, to_a))) * sqrt(Number(dot_product(to_b, to_b)));
    normal = times(Reproducible::cross(to_a, to_b), size.raw > 0.0 ? 1.0 / size.raw : 0.0);
    const double cosine = dot_product(a, b);
    one_and_cosine = cosine < 0.0 ? dot_product(normal, normal) / (1.0 - cosine) : 1.0 + cosine;
  }
  bool holds_point() const {
    return one_and_cosine == 0.0 || dot_product(a, a) == 0.0 || dot_product(b, b) == 0.0;
  }
  Complex<Number> half_angle(const Vector& apex) const {
    return {one_and_cosine + dot_product(apex, a) + dot_product(apex, b), dot_product(apex, normal)};
  }
  // How far a direction is from the edge, between 0 and about 1: from its corners, and from the arc between them.
  double distance_from(const Vector& direction) const {
    const double corners = min_of(1.0 - dot_product(direction, a), 1.0 - dot_product(direction, b));
    const Complex<Number> z = half_angle(times(direction, -1.0));
    const double size = abs(z.real).raw + abs(z.imaginary).raw;
    const double arc = z.real.raw < 0.0 && size > 0.0 ? abs(z.imaginary).raw / size : 1.0;
    return min_of(corners, arc);
  }
  static double min_of(double x, double y) { return x < y ? x : y; }
};

struct Direction {
  float components[3];
  Vector unit_vector;
  double distance;
};

Direction direction_of(const Loop& loop, const float (&components)[3]) {
  Direction direction{{components[0], components[1], components[2]}, {}, 1.0};
  direction.unit_vector = unit(Vector(double(components[0]), double(components[1]), double(components[2])));
  for (std::size_t i = 0; i < loop.count; ++i)
    if (const SeenEdge edge(loop, i); !edge.holds_point())
      direction.distance = SeenEdge::min_of(direction.distance, edge.distance_from(direction.unit_vector));
  return direction;
}

// The first of 26 directions, with components of −1, 0 and 1, that is far from the loop, else the farthest one.
Direction away_from(const Loop& loop) {
  constexpr double far = 0.1;
  Direction best{{}, {}, -1.0};
  for (int code = 0; code < 27 && best.distance < far; ++code) {
    if (code == 13) continue;  // no direction
    const float components[3] = {static_cast<float>(code % 3 - 1), static_cast<float>(code / 3 % 3 - 1),
                                 static_cast<float>(code / 9 - 1)};
    const Direction direction = direction_of(loop, components);
    if (direction.distance > best.distance) best = direction;
  }
  return best;
}

double boundary_term(const Loop& loop, const Vector& direction) {
  Number sum(0.0);
  for (std::size_t i = 0; i < loop.count; ++i) {
    const SeenEdge edge(loop, i);
    if (edge.holds_point()) continue;
    const Complex<Number> z = edge.half_angle(times(direction, -1.0));
    sum = sum + argument(z.real, z.imaginary);
  }
  return sum.raw * over_two_pi;
}

// A cap of the loop: triangles from its apex to the edges.
class Cap {
 public:
  // The apex is in the box of the loop, where no other edge of the cap holds the point, if there is such a place.
  explicit Cap(const Loop& loop) : loop_(loop) {
    constexpr double shares[][3] = {
        {0.375, 0.625, 0.5}, {0.625, 0.3125, 0.6875}, {0.28125, 0.4375, 0.78125}, {0.71875, 0.8125, 0.34375}};
    double lo[3], extent[3];
    for (int k = 0; k < 3; ++k) {
      double hi = lo[k] = loop.corners[0][k];
      for (std::size_t i = 1; i < loop.count; ++i) {
        const double x = loop.corners[i][k];
        lo[k] = x < lo[k] ? x : lo[k], hi = x > hi ? x : hi;
      }
      extent[k] = hi - lo[k];
      point_[k] = float_of(loop.point[k]);
    }
    for (const auto& share : shares) {
      for (int k = 0; k < 3; ++k) apex_[k] = static_cast<float>(lo[k] + share[k] * extent[k]);
      if (!holds_point_at_edge()) return;
    }
  }

  // The crossings of a ray and the cap, by sides; at the point itself they count half.
  double crossings(const float (&direction)[3]) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < loop_.count; ++i) {
      const detail::ExactCrossing crossing = crossing_of(i, direction);
      sum += (crossing.is_at_origin ? 0.5 : 1.0) * crossing.side;
    }
    return sum;
  }

 private:
  // There crossings do not count at the point.
  bool holds_point_at_edge() const {
    constexpr float directions[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t i = 0; i < loop_.count; ++i) {
      bool holds = false, crossed = false;
      for (const auto& direction : directions) {
        const detail::ExactCrossing crossing = crossing_of(i, direction);
        holds = holds || crossing.holds_origin, crossed = crossed || crossing.side != 0;
      }
      if (holds && !crossed) return true;
    }
    return false;
  }
  detail::ExactCrossing crossing_of(std::size_t edge, const float (&direction)[3]) const {
    float corners[9];
    for (int k = 0; k < 3; ++k) {
      corners[k] = apex_[k];
      corners[3 + k] = float_of(loop_.corners[edge][k]);
      corners[6 + k] = float_of(loop_.corners[(edge + 1) % loop_.count][k]);
    }
    return detail::cross_exactly(point_, direction, corners, 0.0f, std::numeric_limits<float>::max());
  }

  const Loop& loop_;
  float point_[3], apex_[3];
};

}  // namespace

double detail::exact_boundary_term(const double (&point)[3], int axis, double sign,
                                   const double (*corners)[3], std::size_t count) {
  const Loop loop{point, corners, count};
  float components[3] = {};
  components[axis] = sign < 0.0 ? -1.0f : 1.0f;
  const Direction ray = direction_of(loop, components);
  constexpr double near = 0x1p-12;
  if (ray.distance > near) return boundary_term(loop, ray.unit_vector);
  const Direction away = away_from(loop);
  const Cap cap(loop);
  return boundary_term(loop, away.unit_vector) + cap.crossings(away.components) -
         cap.crossings(ray.components);
}

}  // namespace raylanes
