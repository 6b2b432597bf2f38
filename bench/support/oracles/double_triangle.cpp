#include "double_triangle.hpp"

#include "../scenes/vector3.hpp"

namespace raylanes::oracle {

DoubleTriangleTest double_triangle(const Ray& ray, const Triangle& triangle) {
  using namespace bench;
  const auto difference = [](const Float3& a, const Float3& b) {
    return subtract(to_double(a), to_double(b));
  };
  const Double3 d = to_double(ray.direction);
  const Double3 e1 = difference(triangle.corner[1], triangle.corner[0]);
  const Double3 e2 = difference(triangle.corner[2], triangle.corner[0]);
  const Double3 s = difference(ray.origin, triangle.corner[0]);
  const Double3 p = cross(d, e2), q = cross(s, e1);
  const double det = dot(e1, p), sign = det < 0 ? -1 : 1;
  const double u = dot(s, p) * sign, v = dot(d, q) * sign;
  DoubleTriangleTest test;
  test.t = dot(e2, q) / det;
  test.u = u * sign / det;
  test.v = v * sign / det;
  test.hit = det != 0 && u >= 0 && v >= 0 && u + v <= det * sign && test.t >= ray.tmin && test.t <= ray.tmax;
  if (!test.hit) test = {};
  return test;
}

}  // namespace raylanes::oracle
