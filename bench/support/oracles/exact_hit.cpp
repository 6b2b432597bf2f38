#include "exact_hit.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "../scenes/vector3.hpp"
#include "exact_triangle.hpp"

namespace raylanes::oracle {
namespace {

using bench::Double3, bench::subtract, bench::to_double;
constexpr float largest = std::numeric_limits<float>::max();

// d·(p×q), and a bound of its error: differences (one rounding each), products (two), sums (three) are seven roundings
// of each of six products; eight of 2^-53 cover them. Nothing under- or overflows: 2^±450 at most.
struct WithError {
  double value, error;
};
WithError determinant(const Double3& d, const Double3& p, const Double3& q) {
  WithError sum{0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double a = p[j] * q[k], b = p[k] * q[j];
    sum.value += d[i] * (a - b);
    sum.error += std::fabs(d[i]) * (std::fabs(a) + std::fabs(b));
  }
  sum.error *= 8 * 0x1p-53;
  return sum;
}

}  // namespace

bool certainly_misses(const Ray& ray, const Triangle& triangle) {
  const Double3 d = to_double(ray.direction), o = to_double(ray.origin);
  const Double3 a = subtract(to_double(triangle.corner[0]), o),
                b = subtract(to_double(triangle.corner[1]), o),
                c = subtract(to_double(triangle.corner[2]), o);
  bool positive = false, negative = false;
  for (const WithError& w : {determinant(d, c, b), determinant(d, a, c), determinant(d, b, a)}) {
    positive = positive || w.value > w.error;
    negative = negative || w.value < -w.error;
  }
  return positive && negative;
}

float nearest_float(const mpq_class& x) {
  const auto guess = static_cast<float>(x.get_d());  // off by one at most
  float best = guess;
  mpq_class error = abs(mpq_class(std::isinf(guess) ? std::copysign(0x1p128, guess) : double(guess)) - x);
  for (const float towards : {-largest, largest}) {
    const float other = std::nextafter(std::isinf(guess) ? std::copysign(largest, guess) : guess, towards);
    const mpq_class other_error = abs(mpq_class(other) - x);
    const bool is_even = (std::bit_cast<std::uint32_t>(other) & 1u) == 0;
    if (other_error < error || (other_error == error && is_even)) best = other, error = other_error;
  }
  return best + 0.0f;
}

Hit exact_hit(const Ray& ray, const Triangle& triangle) {
  if (certainly_misses(ray, triangle)) return {};
  // The segment ends with the floats.
  Ray finite = ray;
  if (finite.tmin < -largest) finite.tmin = -largest;
  if (finite.tmax > largest) finite.tmax = largest;
  const ExactTriangleTest exact = exact_triangle(finite, triangle);
  if (!(ray.tmin <= ray.tmax) || !exact.hit) return {};
  return {nearest_float(exact.t), nearest_float(exact.u), nearest_float(exact.v), 0};
}

std::vector<Hit> exact_hits(std::span<const Float3> vertices, std::span<const Index3> triangles,
                            std::span<const Ray> rays) {
  std::vector<Hit> hits;
  for (const Ray& ray : rays) {
    Hit best;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      const auto& [a, b, c] = triangles[i];
      Hit hit = exact_hit(ray, {vertices[a], vertices[b], vertices[c]});
      hit.primitive = hit ? i : no_primitive;
      // Primitives come in rising order: of equal t the first stays.
      if (hit && (!best || hit.t < best.t)) best = hit;
    }
    hits.push_back(best);
  }
  return hits;
}

}  // namespace raylanes::oracle
