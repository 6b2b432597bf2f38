// A loop of a boundary is the boundary of a cap F, the fan of triangles from its first corner. By the directions d and
// e of two rays from the point, the loop's term differs by what these rays cross:
//   term(d) + crossings(d, F) = term(e) + crossings(e, F) = the winding number of F.
// So the term is taken along a direction e that keeps away from the loop, where doubles do, and the crossings of both
// rays are exact. Edges and triangles that hold the point are seen from p + εd, with d along the ray and ε positive and
// smaller than any number. All loops of a point have the same d, so that what they share cancels.
// Compiled once, with one lane.
#include "boundary_loop.hpp"

#include <limits>

#include "../exact/predicate.hpp"
#include "seen_loop.hpp"

namespace raylanes {
namespace {

// An arc between unit vectors, at most half a turn, with its normal a × b.
struct Arc {
  Vector a, b, normal;
  double one_and_cosine;

  Arc(const Vector& from, const Vector& to, const Vector& cross) : a(from), b(to), normal(cross) {
    const double cosine = dot_product(a, b);
    one_and_cosine = cosine < 0.0 ? dot_product(normal, normal) / (1.0 - cosine) : 1.0 + cosine;
  }
  Complex<Number> half_angle(const Vector& apex) const {
    const Vector a_and_b = times(a, one_and_cosine) + Reproducible::cross(normal, a);
    return {one_and_cosine + dot_product(apex, a_and_b), dot_product(apex, normal)};
  }
  // How far a direction is from the arc, between 0 and about 1: from its ends, and from what is between them.
  double distance_from(const Vector& direction) const {
    const double ends = min_of(1.0 - dot_product(direction, a), 1.0 - dot_product(direction, b));
    const Complex<Number> z = half_angle(times(direction, -1.0));
    const double size = abs(z.real).raw + abs(z.imaginary).raw;
    const double between = z.real.raw < 0.0 && size > 0.0 ? abs(z.imaginary).raw / size : 1.0;
    return min_of(ends, between);
  }
  static double min_of(double x, double y) { return x < y ? x : y; }
};

// The direction in which p + εd sees the line through p and a corner, which is along a unit vector: −d, less what is
// along the line. If the line is along d, d is moved by another ε along the first other axis.
template <class T>
Vector toward_line(const Loop<T>& loop, std::size_t corner, const Vector& along) {
  const Vector across = loop.across_ray(corner);
  if (is_zero(across)) return Loop<T>::along(loop.axis == 0 ? 1 : 0, -1.0);
  return times(loop.ray(), -dot_product(along, across)) + times(across, dot_product(along, loop.ray()));
}

// Calls take(arc) for what the point sees of each edge.
template <class T, class Take>
void each_arc(const Loop<T>& loop, const Take& take) {
  const auto seen = [&](const Sight& to_corner) {
    return is_zero(to_corner.vector) ? times(loop.ray(), -1.0) : unit(to_corner.vector);
  };
  for (std::size_t i = 0; i < loop.count; ++i) {
    const Sight to_a = loop.to_corner(i), to_b = loop.to_corner(i + 1);
    const Vector a = seen(to_a), b = seen(to_b);
    const bool is_at_corner = is_zero(to_a.vector) || is_zero(to_b.vector);
    const Vector normal =
        is_at_corner ? Reproducible::cross(a, b) : Exactly<T>::over_sizes(loop.normal(i, i + 1), to_a, to_b);
    if (is_zero(normal) && dot_product(a, b) < 0.0) {
      const Vector middle = toward_line(loop, i, a);
      take(Arc(a, middle, Reproducible::cross(a, middle)));
      take(Arc(middle, b, Reproducible::cross(middle, b)));
    } else {
      take(Arc(a, b, normal));
    }
  }
}

template <class T>
struct Direction {
  T components[3];  // of a length of 4 at least, so that any crossing has a finite t
  Vector unit_vector;
  double distance;
};

template <class T>
Direction<T> direction_of(const Loop<T>& loop, const T (&components)[3]) {
  Direction<T> direction{{4 * components[0], 4 * components[1], 4 * components[2]}, {}, 1.0};
  direction.unit_vector = unit(Vector(double(components[0]), double(components[1]), double(components[2])));
  each_arc(loop, [&](const Arc& arc) {
    direction.distance = Arc::min_of(direction.distance, arc.distance_from(direction.unit_vector));
  });
  return direction;
}

// The first of 26 directions, with components of −1, 0 and 1, that is far from the loop, else the farthest one.
template <class T>
Direction<T> away_from(const Loop<T>& loop) {
  constexpr double far = 0.1;
  Direction<T> best{{}, {}, -1.0};
  for (int code = 0; code < 27 && best.distance < far; ++code) {
    if (code == 13) continue;  // no direction
    const T components[3] = {static_cast<T>(code % 3 - 1), static_cast<T>(code / 3 % 3 - 1),
                             static_cast<T>(code / 9 - 1)};
    const Direction<T> direction = direction_of(loop, components);
    if (direction.distance > best.distance) best = direction;
  }
  return best;
}

template <class T>
double boundary_term(const Loop<T>& loop, const Vector& direction) {
  Number sum(0.0);
  each_arc(loop, [&](const Arc& arc) {
    const Complex<Number> z = arc.half_angle(times(direction, -1.0));
    sum = sum + argument(z.real, z.imaginary);
  });
  return sum.raw * over_two_pi;
}

// The triangles of the fan and a ray from the point, by sides. A direction e in the plane of a triangle, or through an
// edge, is moved as cross_exactly() moves it; ε is smaller than that.
template <class T>
class Cap {
 public:
  explicit Cap(const Loop<T>& loop) : loop_(loop) {
    for (int k = 0; k < 3; ++k) point_[k] = Exactly<T>::number(loop.point[k]), ray_[k] = 0;
    ray_[loop.axis] = loop.sign < 0.0 ? -4 : 4;
  }

  // How many more crossings a ray along e has than the ray along d, by sides.
  int more_crossings(const T (&e)[3]) const {
    int sum = 0;
    for (std::size_t i = 1; i + 1 < loop_.count; ++i) {
      const Triangle triangle(loop_, i);
      const detail::ExactCrossing along_e = crossing_of(triangle, e);
      sum += along_e.holds_origin ? crossing_at_point(triangle, e)
                                  : along_e.side - crossing_of(triangle, ray_).side;
    }
    return sum;
  }

 private:
  struct Triangle {
    std::size_t index[3];
    T corners[9];

    Triangle(const Loop<T>& loop, std::size_t i) : index{0, i, i + 1} {
      for (int k = 0; k < 9; ++k) corners[k] = Exactly<T>::number(loop.corners[index[k / 3]][k % 3]);
    }
  };

  detail::ExactCrossing crossing_of(const Triangle& triangle, const T (&direction)[3]) const {
    return detail::cross_exactly(point_, direction, triangle.corners, T(0), std::numeric_limits<T>::max());
  }
  // The side of a triangle that holds the point, if a ray from p + εd along e crosses it: a ray along d never does.
  int crossing_at_point(const Triangle& triangle, const T (&e)[3]) const {
    const int side = side_of(triangle, e);
    if (side == side_of(triangle, ray_)) return 0;
    for (int k = 0; k < 3; ++k) {
      const std::size_t q = triangle.index[k], r = triangle.index[(k + 1) % 3];
      if (is_zero(loop_.normal(q, r).vector) && turn(e, loop_.corners[q], loop_.corners[r]) != -side)
        return 0;
    }
    return side;
  }
  static int side_of(const Triangle& triangle, const T (&direction)[3]) {
    constexpr T axes[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int side = detail::side_exactly(direction, triangle.corners);
    for (int k = 0; k < 3 && side == 0; ++k) side = detail::side_exactly(axes[k], triangle.corners);
    return side;
  }
  // The sign of det(e, d, r − q), for a line through q and r that holds the point. It is zero only for a line along d,
  // where d is moved as toward_line() has it: e keeps away from the line.
  int turn(const T (&e)[3], const double (&q)[3], const double (&r)[3]) const {
    int across[3];
    double terms[6];
    for (int k = 0; k < 3; ++k) {
      const int y = (k + 1) % 3, z = (k + 2) % 3;
      across[k] = sign_of(double(e[y] * ray_[z] - e[z] * ray_[y]));  // all of one size, or zero
      terms[2 * k] = across[k] * r[k], terms[2 * k + 1] = -across[k] * q[k];
    }
    if (const int sign = detail::sign_of_sum_exactly(terms); sign != 0) return sign;
    const int along = (r[loop_.axis] > q[loop_.axis] ? 1 : -1) * sign_of(loop_.sign);
    for (const int component : across)
      if (component != 0) return -along * component;
    return 0;
  }

  const Loop<T>& loop_;
  T point_[3], ray_[3];
};

}  // namespace

template <class T>
double detail::exact_boundary_term(const double (&point)[3], int axis, double sign,
                                   const double (*corners)[3], std::size_t count) {
  const Loop<T> loop{point, corners, count, axis, sign};
  T components[3] = {};
  components[axis] = sign < 0.0 ? -1 : 1;
  const Direction<T> ray = direction_of(loop, components);
  constexpr double near = 0x1p-12;
  if (ray.distance > near) return boundary_term(loop, ray.unit_vector);
  const Direction<T> away = away_from(loop);
  return boundary_term(loop, away.unit_vector) + Cap<T>(loop).more_crossings(away.components);
}
template double detail::exact_boundary_term<float>(const double (&)[3], int, double, const double (*)[3],
                                                   std::size_t);
template double detail::exact_boundary_term<double>(const double (&)[3], int, double, const double (*)[3],
                                                    std::size_t);

}  // namespace raylanes
