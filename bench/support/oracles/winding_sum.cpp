#include "winding_sum.hpp"

#include "exact_rays.hpp"

namespace raylanes::oracle {
namespace {

constexpr double u = 0x1p-53;

double dot(const Double3& a, const Double3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The corners a, b, c seen from a point, as z = real + i·det, whose argument is half the solid angle (Van Oosterom,
// Strackee 1983). With P = |a||b||c|, computed in doubles, which neither overflow nor underflow here:
//   det:  six products, each with at most 8 roundings, √2·P in size together, are off by 8√2·u·P < 12·u·P;
//   real: a length has 3.5 roundings, so P has 12.5 and 3 sums, and each of three products a·b|c| has 9.5 and 3 sums:
//         together 53·u·P.
// So z is off by less than 55·u·P, and by 56·u·P with terms in u².
struct SeenAngle {
  double product, real, det;
  static constexpr double det_error = 12 * u, z_error = 56 * u;  // by P

  SeenAngle(const TriangleCorners<float>& corners, const Float3& point) {
    std::array<Double3, 3> corner;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        corner[i][k] = static_cast<double>(corners[i][k]) - static_cast<double>(point[k]);
    const auto& [a, b, c] = corner;
    const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
    product = la * lb * lc;
    real = product + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    det = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
          a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
};

}  // namespace

// The sign of det is exact, so z and its computed value are in the same half plane. Their arguments differ by at most
// π·e/|z|, where e bounds the error of z: arcsin(x) <= π·x below 1, and π is the most in a half plane. A triangle's
// share is the argument over 2π. The arctangent, its quotient and the sum add a few roundings of numbers up to 1/2.
WindingSum winding_sum(std::span<const Float3> vertices, std::span<const Index3> triangles,
                       const Float3& point) {
  WindingSum sum;
  double sizes = 0;
  for (const Index3& t : triangles) {
    const TriangleCorners<float> corners{vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    SeenAngle z(corners, point);
    if (std::abs(z.det) <= SeenAngle::det_error * z.product) {
      const Placed exact = placed(corners, point);
      if (exact.touch == Touch::edge) return {0, 0, true};
      if (exact.side == 0) continue;
      z.det = std::copysign(z.det, exact.side);
    }
    const double share = std::atan2(z.det, z.real) / (2 * std::numbers::pi);
    sum.number += share, sizes += std::abs(share);
    sum.error += 0.5 * SeenAngle::z_error * z.product / std::sqrt(z.real * z.real + z.det * z.det) + 4 * u;
  }
  sum.error += static_cast<double>(triangles.size()) * u * sizes;
  return sum;
}

}  // namespace raylanes::oracle
