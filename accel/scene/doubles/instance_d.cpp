#include "instance_d.hpp"

#include "../../../dispatch/table/frame.hpp"
#include "../../mesh/bounding_boxes.hpp"

namespace raylanes {
namespace {

// An unevaluated sum of two doubles: twice the digits (Dekker 1971).
struct Pair {
  double high = 0, low = 0;

  double rounded() const { return high + low; }
};
// Exact (Knuth 1969).
Pair sum_of(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}
Pair operator+(const Pair& a, const Pair& b) {
  const Pair sum = sum_of(a.high, b.high);
  return sum_of(sum.high, sum.low + (a.low + b.low));
}
Pair operator-(const Pair& a, const Pair& b) {
  return a + Pair{-b.high, -b.low};
}
Pair operator*(const Pair& a, const Pair& b) {
  const double product = a.high * b.high;
  return {product, std::fma(a.high, b.high, -product) + (a.high * b.low + a.low * b.high)};
}
Pair operator/(const Pair& a, const Pair& b) {
  const double first = a.high / b.high;
  const Pair rest = a - b * Pair{first, 0};
  return sum_of(first, rest.rounded() / b.high);
}
// Without a bound for what a ray may be off by, all rays come to an instance.
constexpr double most_of_doubles = std::numeric_limits<double>::max();
constexpr BoxD all_doubles{{-most_of_doubles, -most_of_doubles, -most_of_doubles},
                           {most_of_doubles, most_of_doubles, most_of_doubles}};
double size_of(double a, double b) {
  return std::abs(a * b);
}

// The numbers of a matrix, the largest between 1 and 2.
struct ScaledMatrix {
  double a[3][3];
  int power;  // the matrix is 2^-power times that

  explicit ScaledMatrix(const TransformD& transform) {
    Double3 largest{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) largest[i] = std::max(largest[i], std::abs(transform.row[i][j]));
    power = -exponent_of_largest(largest);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) a[i][j] = times_power(transform.row[i][j], power);
  }
  // The cofactor of an entry, and the sum of its terms' sizes.
  Pair cofactor(int i, int j, double& size) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    size = size_of(a[i1][j1], a[i2][j2]) + size_of(a[i1][j2], a[i2][j1]);
    return Pair{a[i1][j1]} * Pair{a[i2][j2]} - Pair{a[i1][j2]} * Pair{a[i2][j1]};
  }
};

bool is_finite(const TransformD& transform) {
  return std::ranges::all_of(transform.row, [](const double(&row)[4]) {
    return std::ranges::all_of(row, [](double x) { return std::isfinite(x); });
  });
}
double largest_of(const Double3& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

// Each coordinate as a pair, rounded once.
Double3 times(const InverseD& inverse, const Pair (&v)[3]) {
  Double3 product;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto term = [&](std::size_t j) { return Pair{inverse.high[i][j], inverse.low[i][j]} * v[j]; };
    product[i] = ((term(0) + term(1)) + term(2)).rounded();
  }
  return product;
}

}  // namespace

// The inverse by cofactors. Entries are exact, so a cofactor is off by less than 2^-102 of the sizes of its terms. The
// determinant is off by less than 2^-100 of the sizes of its terms. Each entry of the inverse is off by less than 2^-99
// of both shares.
InverseD::InverseD(const TransformD& transform) {
  if (!is_finite(transform)) return;
  const ScaledMatrix matrix(transform);
  Pair cofactor[3][3], determinant{};
  double size[3][3], sizes = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) cofactor[i][j] = matrix.cofactor(i, j, size[i][j]);
  for (int j = 0; j < 3; ++j) {
    determinant = determinant + Pair{matrix.a[0][j]} * cofactor[0][j];
    sizes += std::abs(matrix.a[0][j]) * size[0][j];
  }
  const double of_determinant = std::abs(determinant.high);
  if (!(of_determinant > 0x1p-48 * sizes) || !(of_determinant >= 0x1p-900)) return;
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j) {
      const Pair entry = cofactor[j][i] / determinant;
      high[i][j] = times_power(entry.high, matrix.power), low[i][j] = times_power(entry.low, matrix.power);
      const double share = size[j][i] / of_determinant + std::abs(entry.high) * (sizes / of_determinant);
      sum += times_power(0x1p-99 * share, matrix.power) + 0x1p-1073;
    }
    wrong = std::max(wrong, sum);
  }
  exists = std::isfinite(wrong) && std::ranges::all_of(high, [](const double(&row)[3]) {
             return std::ranges::all_of(row, [](double x) { return std::isfinite(x); });
           });
}

InstanceD::InstanceD(std::uint32_t geometry_, const TransformD& transform_, std::uint32_t mask_)
    : transform(transform_), inverse(transform_), geometry(geometry_), mask(mask_) {
  const TransformD identity;
  is_identity = std::memcmp(&transform, &identity, sizeof identity) == 0;
}

TransformD composed(const TransformD& outer, const TransformD& inner) {
  return product_of<Pair>(outer, inner, [](const Pair& x) { return x.rounded(); });
}

Double3 in_part(const InstanceD& instance, const Double3& point) {
  if (instance.is_identity) return point;
  Pair moved[3];
  for (std::size_t i = 0; i < 3; ++i) moved[i] = sum_of(point[i], -instance.transform.row[i][3]);
  return times(instance.inverse, moved);
}
RayD in_part(const InstanceD& instance, const RayD& ray) {
  if (instance.is_identity) return ray;
  const Pair direction[3] = {{ray.direction[0]}, {ray.direction[1]}, {ray.direction[2]}};
  RayD mapped{in_part(instance, ray.origin), ray.tmin, times(instance.inverse, direction), ray.tmax};
  if (largest_of(mapped.direction) < 0x1p-900) mapped.direction = {};
  return mapped;
}
Double3 in_scene(const InstanceD& instance, const Double3& point) {
  if (instance.is_identity) return point;
  Double3 moved;
  for (std::size_t i = 0; i < 3; ++i) {
    const double(&row)[4] = instance.transform.row[i];
    moved[i] = ((row[0] * point[0] + row[1] * point[1]) + row[2] * point[2]) + row[3];
  }
  return moved;
}

// With A the matrix, M the largest sum of sizes in its rows, and b the translation; R the inverse, N the largest sum of
// its rows, and W how much of N is wrong. The origin in the part's space, o' = R·(o − b), is off by 2^-52·N + W times
// |o − b|. A hit p' at t has t·|d'| <= |p'| + |o'|, and t·|d| <= 2.1·M times that, as long as M·W and M·N·2^-99 are
// below 1/4. So rounding the direction moves the hit by at most g = 2^-52 + 2.2·M·(W + 2^-100·N) times the sum of |p'|
// and N·|o − b|. A takes both back to the scene. Doubled, which is more than the roundings here take.
InstanceBoundsD bounds_of(const InstanceD& instance, const BoxD& part) {
  const InstanceBoundsD none{empty_double_box};
  if (!instance.inverse.exists || !(part.lo[0] <= part.hi[0])) return none;
  if (instance.is_identity) return {part, 0};
  double n = 0, m = 0, translation = 0, most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double(&r)[3] = instance.inverse.high[i];
    const double(&a)[4] = instance.transform.row[i];
    n = std::max(n, std::abs(r[0]) + std::abs(r[1]) + std::abs(r[2]));
    m = std::max(m, std::abs(a[0]) + std::abs(a[1]) + std::abs(a[2]));
    translation = std::max(translation, std::abs(a[3]));
    most = std::max({most, std::abs(part.lo[i]), std::abs(part.hi[i])});
  }
  const double w = instance.inverse.wrong;
  if (!(m * w < 0.25) || !(m * n < 0x1p97)) return {all_doubles};
  const double g = 0x1p-52 + 2.2 * m * (w + 0x1p-100 * n), of_origin = 2 * (0x1p-52 * n + w + g * n);
  InstanceBoundsD bounds{empty_double_box, m * of_origin};
  for (std::size_t i = 0; i < 3; ++i) {
    const double(&row)[4] = instance.transform.row[i];
    double lo = row[3], hi = lo, size = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const double at_lo = row[j] * part.lo[j], at_hi = row[j] * part.hi[j];
      lo += std::min(at_lo, at_hi), hi += std::max(at_lo, at_hi), size += std::abs(row[j]);
    }
    const double pad = size * (of_origin * translation + 2 * g * most) +
                       0x1p-50 * (std::abs(row[3]) + size * most) + 0x1p-900;
    bounds.box.lo[i] = lo - pad, bounds.box.hi[i] = hi + pad;
    if (!std::isfinite(bounds.box.lo[i]) || !std::isfinite(bounds.box.hi[i])) return none;
  }
  return bounds;
}

}  // namespace raylanes
