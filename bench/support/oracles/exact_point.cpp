#include "exact_point.hpp"

namespace raylanes::oracle {

std::string fault_of_closest_point(const DoubleMesh& mesh, const Double3& point, const ClosestPointD& found) {
  const auto power = [](int exponent) {
    mpz_class two = 1;
    two <<= static_cast<unsigned>(std::abs(exponent));
    return exponent < 0 ? mpq_class(1, two) : mpq_class(two);
  };
  double coordinate = 0;
  const auto take_largest = [&](const Double3& p) {
    for (const double x : p) coordinate = std::max(coordinate, std::abs(x));
  };
  take_largest(point);
  for (const Double3& v : mesh.vertices) take_largest(v);
  // The root has two roundings, the last one to a double that may be subnormal. An infinite one is at least 2^1024.
  const bool is_finite = std::isfinite(found.distance);
  const mpq_class distance = is_finite ? mpq_class(found.distance) : power(1024), value = distance * distance,
                  more = value * power(-50) + distance * power(-1073) + power(-2148) +
                         mpq_class(coordinate) * mpq_class(coordinate) * power(-1400);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corners = corners_of(mesh, t);
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    const std::string of_triangle = "triangle " + std::to_string(t);
    if (!found) return of_triangle + " is not found";
    const Vector p = to_vector(point), a = to_vector(corners[0]) - p, b = to_vector(corners[1]) - p,
                 c = to_vector(corners[2]) - p;
    const mpq_class exact = exact_square_of_distance(a, b, c),
                    reach = std::max({dot(a, a), dot(b, b), dot(c, c)}), bound = reach * power(-46) + more;
    if (value > exact + bound) return of_triangle + " is nearer";
    if (t != found.primitive) continue;
    if (is_finite && value < exact - bound) return of_triangle + " is farther";
    // The point that u and v say: as far, and where it is said to be.
    const mpq_class u = found.u, v = found.v, w = 1 - u - v;
    const Vector at{w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1],
                    w * a[2] + u * b[2] + v * c[2]};
    if (is_finite && abs(dot(at, at) - value) > bound) return of_triangle + ": u and v are wrong";
    for (std::size_t k = 0; k < 3; ++k)
      if (abs(at[k] + p[k] - mpq_class(found.point[k])) > mpq_class(coordinate) * power(-50) + power(-1073))
        return of_triangle + ": its point is wrong";
  }
  const bool is_normal = found.distance > 0x1p-500 && found.distance < 0x1p500;
  if (is_normal && abs(mpq_class(found.distance_squared) - value) > value * power(-51))
    return "the distance is not the root";
  return "";
}

}  // namespace raylanes::oracle
