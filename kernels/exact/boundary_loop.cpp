// A loop of a boundary is the boundary of a cap F, the fan of triangles from its first corner. By the directions d and
// e of two rays from the point, the loop's term differs by what these rays cross:
//   term(d) + crossings(d, F) = term(e) + crossings(e, F) = the winding number of F.
// So the term is taken along a direction e that keeps away from the loop, where doubles do, and the crossings of both
// rays are exact. Edges and triangles that hold the point are seen from p + εd, with d along the ray and ε positive and
// smaller than any number. All loops of a point have the same d, so that what they share cancels.
// Compiled once, with one lane.
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
bool is_zero(const Vector& a) {
  return a.x.raw == 0.0 && a.y.raw == 0.0 && a.z.raw == 0.0;
}
int sign_of(double x) {
  return (x > 0.0 ? 1 : 0) - (x < 0.0 ? 1 : 0);
}

// The sum of numbers whose differences are exact, with its sign and within two ULPs: kept as parts that do not overlap
// (Shewchuk 1997).
double sum_of(const double (&terms)[6]) {
  double parts[6];
  int count = 0;
  for (double term : terms) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const double part = parts[i], sum = term + part, of_part = sum - term;
      const double rest = (term - (sum - of_part)) + (part - of_part);
      if (rest != 0.0) parts[kept++] = rest;
      term = sum;
    }
    if (term != 0.0) parts[kept++] = term;
    count = kept;
  }
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += parts[i];
  return sum;
}

struct Loop {
  const double (&point)[3];
  const double (*corners)[3];
  std::size_t count;
  int axis;     // of the ray
  double sign;  // along it

  const double (&corner(std::size_t i) const)[3] { return corners[i % count]; }
  Vector to_corner(std::size_t i) const {
    const double(&to)[3] = corner(i);
    return {to[0] - point[0], to[1] - point[1], to[2] - point[2]};
  }
  // The cross product of the vectors to two corners, each component within two ULPs: floats have exact products.
  Vector normal(std::size_t i, std::size_t j) const {
    const double(&a)[3] = corner(i), (&b)[3] = corner(j);
    const auto component = [&](int y, int z) {
      return sum_of({a[y] * b[z], -(a[z] * b[y]), a[z] * point[y], -(a[y] * point[z]), b[y] * point[z],
                     -(b[z] * point[y])});
    };
    return {component(1, 2), component(2, 0), component(0, 1)};
  }
  Vector ray() const { return along(axis, sign); }
  static Vector along(int k, double size) {
    return {k == 0 ? size : 0.0, k == 1 ? size : 0.0, k == 2 ? size : 0.0};
  }
};

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

// The direction in which p + εd sees the line through p along a unit vector: −d, less what is along the line. If the
// line is along d, d is moved by another ε along the first other axis.
Vector toward_line(const Loop& loop, const Vector& along) {
  const Vector across = Reproducible::cross(along, Reproducible::cross(loop.ray(), along));
  return is_zero(across) ? Loop::along(loop.axis == 0 ? 1 : 0, -1.0) : times(unit(across), -1.0);
}

// Calls take(arc) for what the point sees of each edge.
template <class Take>
void each_arc(const Loop& loop, const Take& take) {
  const auto seen = [&](const Vector& to_corner) {
    return is_zero(to_corner) ? times(loop.ray(), -1.0) : unit(to_corner);
  };
  for (std::size_t i = 0; i < loop.count; ++i) {
    const Vector to_a = loop.to_corner(i), to_b = loop.to_corner(i + 1), a = seen(to_a), b = seen(to_b);
    const double size = sqrt(Number(dot_product(to_a, to_a))).raw * sqrt(Number(dot_product(to_b, to_b))).raw;
    const Vector normal = size > 0.0 ? times(loop.normal(i, i + 1), 1.0 / size) : Reproducible::cross(a, b);
    if (is_zero(normal) && dot_product(a, b) < 0.0) {
      const Vector middle = toward_line(loop, a);
      take(Arc(a, middle, Reproducible::cross(a, middle)));
      take(Arc(middle, b, Reproducible::cross(middle, b)));
    } else {
      take(Arc(a, b, normal));
    }
  }
}

struct Direction {
  float components[3];  // of a length of 4 at least, so that any crossing has a finite t
  Vector unit_vector;
  double distance;
};

Direction direction_of(const Loop& loop, const float (&components)[3]) {
  Direction direction{{4.0f * components[0], 4.0f * components[1], 4.0f * components[2]}, {}, 1.0};
  direction.unit_vector = unit(Vector(double(components[0]), double(components[1]), double(components[2])));
  each_arc(loop, [&](const Arc& arc) {
    direction.distance = Arc::min_of(direction.distance, arc.distance_from(direction.unit_vector));
  });
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
  each_arc(loop, [&](const Arc& arc) {
    const Complex<Number> z = arc.half_angle(times(direction, -1.0));
    sum = sum + argument(z.real, z.imaginary);
  });
  return sum.raw * over_two_pi;
}

// The triangles of the fan and a ray from the point, by sides. A direction e in the plane of a triangle, or through an
// edge, is moved as cross_exactly() moves it; ε is smaller than that.
class Cap {
 public:
  explicit Cap(const Loop& loop) : loop_(loop) {
    for (int k = 0; k < 3; ++k) point_[k] = float_of(loop.point[k]), ray_[k] = 0.0f;
    ray_[loop.axis] = loop.sign < 0.0 ? -4.0f : 4.0f;
  }

  // How many more crossings a ray along e has than the ray along d, by sides.
  int more_crossings(const float (&e)[3]) const {
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
    float corners[9];

    Triangle(const Loop& loop, std::size_t i) : index{0, i, i + 1} {
      for (int k = 0; k < 9; ++k) corners[k] = float_of(loop.corners[index[k / 3]][k % 3]);
    }
  };

  detail::ExactCrossing crossing_of(const Triangle& triangle, const float (&direction)[3]) const {
    return detail::cross_exactly(point_, direction, triangle.corners, 0.0f,
                                 std::numeric_limits<float>::max());
  }
  // The side of a triangle that holds the point, if a ray from p + εd along e crosses it: a ray along d never does.
  int crossing_at_point(const Triangle& triangle, const float (&e)[3]) const {
    const int side = side_of(triangle, e);
    if (side == side_of(triangle, ray_)) return 0;
    for (int k = 0; k < 3; ++k) {
      const std::size_t q = triangle.index[k], r = triangle.index[(k + 1) % 3];
      if (is_zero(loop_.normal(q, r)) && turn(e, loop_.corners[q], loop_.corners[r]) != -side) return 0;
    }
    return side;
  }
  static int side_of(const Triangle& triangle, const float (&direction)[3]) {
    constexpr float axes[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    int side = detail::side_exactly(direction, triangle.corners);
    for (int k = 0; k < 3 && side == 0; ++k) side = detail::side_exactly(axes[k], triangle.corners);
    return side;
  }
  // The sign of det(e, d, r − q), for a line through q and r that holds the point. It is zero only for a line along d,
  // where d is moved as toward_line() has it: e keeps away from the line.
  int turn(const float (&e)[3], const double (&q)[3], const double (&r)[3]) const {
    double across[3], terms[6];
    for (int k = 0; k < 3; ++k) {
      const int y = (k + 1) % 3, z = (k + 2) % 3;
      across[k] = double(e[y] * ray_[z] - e[z] * ray_[y]);
      terms[2 * k] = across[k] * r[k], terms[2 * k + 1] = -(across[k] * q[k]);
    }
    if (const int sign = sign_of(sum_of(terms)); sign != 0) return sign;
    const int along = sign_of(r[loop_.axis] - q[loop_.axis]) * sign_of(loop_.sign);
    for (const double component : across)
      if (component != 0.0) return -along * sign_of(component);
    return 0;
  }

  const Loop& loop_;
  float point_[3], ray_[3];
};

}  // namespace

double detail::exact_boundary_term(const double (&point)[3], int axis, double sign,
                                   const double (*corners)[3], std::size_t count) {
  const Loop loop{point, corners, count, axis, sign};
  float components[3] = {};
  components[axis] = sign < 0.0 ? -1.0f : 1.0f;
  const Direction ray = direction_of(loop, components);
  constexpr double near = 0x1p-12;
  if (ray.distance > near) return boundary_term(loop, ray.unit_vector);
  const Direction away = away_from(loop);
  return boundary_term(loop, away.unit_vector) + Cap(loop).more_crossings(away.components);
}

}  // namespace raylanes
