// t, u and v of hits of rays that share an origin, and neighbours a triangle: what a triangle is from there is computed
// in doubles once, and a ray costs three products of vectors and a division.
#pragma once

#include "exact_numbers.hpp"
#include "tree_triangles.hpp"

namespace raylanes {
namespace {

// A triangle from an origin, in doubles. With d a direction, twice the weights of the corners b and c are d · weight_b
// and d · weight_c. The sum of all three weights is d · area, and t is the volume divided by it. docs/exact.md, part 4,
// derives the bounds.
struct TriangleFromOrigin {
  std::uint32_t leaf_triangle = no_leaf_triangle, primitive = no_primitive;
  double weight_b[3], weight_c[3], area[3], volume;
  double weight_error, area_error;  // with the size of d as a factor
  double volume_error;

  TriangleFromOrigin() = default;
  TriangleFromOrigin(const TreeTriangles& triangles, std::uint32_t of, const Float3& origin)
      : leaf_triangle(of), primitive(triangles.primitive(of)) {
    using V = Lanes<double, 1>;
    using A = Arithmetic<Grade::reproducible>;
    const auto corner = [&](int k) {
      const auto number = [&](int axis) { return V(static_cast<double>(triangles.number(k + axis, of))); };
      return Vec3<V>(number(0), number(1), number(2));
    };
    const auto size = [](const Vec3<V>& p) { return largest_magnitude(p.x, p.y, p.z); };
    Vec3<V> o(V(static_cast<double>(origin[0])), V(static_cast<double>(origin[1])),
              V(static_cast<double>(origin[2])));
    Vec3<V> va = corner(0), vb = corner(3), vc = corner(6);
    Vec3<V> a = va - o, b = vb - o, c = vc - o, ab = vb - va, ca = va - vc;
    Vec3<V> b_weight = A::cross(c + a, ca), c_weight = A::cross(a + b, ab), n = A::cross(ca, ab);
    keep(b_weight, weight_b), keep(c_weight, weight_c);
    keep(n + n, area);
    volume = 2 * A::dot(a, n).raw;
    constexpr double unit = 0x1p-53;
    const double reach = max(max(size(a), size(b)), size(c)).raw,
                 extent = max(max(size(ab), size(ca)), size(vc - vb)).raw;
    // Smaller ones may have lost digits that processors flush.
    const bool is_safe = extent >= 0x1p-60;
    const double least = is_safe ? 0.0 : std::numeric_limits<double>::infinity();
    weight_error = least + 100 * unit * reach * extent;
    area_error = least + 100 * unit * extent * extent;
    volume_error = least + 128 * unit * reach * extent * extent;
  }

 private:
  static void keep(const Vec3<Lanes<double, 1>>& v, double (&xyz)[3]) {
    xyz[0] = v.x.raw, xyz[1] = v.y.raw, xyz[2] = v.z.raw;
  }
};

// For half the lanes of rays that hit it; size: of their directions.
template <int half, int N>
inline auto numbers_from_origin(const TriangleFromOrigin& triangle, const Vec3<Floats<N>>& direction,
                                Floats<N> size) {
  using V = HalfInDoubles<half, N>;
  Vec3<V> d(to_doubles<half>(direction.x), to_doubles<half>(direction.y), to_doubles<half>(direction.z));
  const auto product = [&](const double(&n)[3]) {
    return multiply_add<Grade::fast>(V(n[2]), d.z, multiply_add<Grade::fast>(V(n[1]), d.y, V(n[0]) * d.x));
  };
  V inverse = V(1.0) / product(triangle.area);
  V scale = to_doubles<half>(size) * abs(inverse);
  NumbersInDoubles<V> numbers;
  numbers.t = V(triangle.volume) * inverse;
  numbers.u = product(triangle.weight_b) * inverse, numbers.v = product(triangle.weight_c) * inverse;
  V of_area = multiply_add<Grade::fast>(V(2 * triangle.area_error), scale, V(0x1p-50));
  numbers.set_uv_bound(multiply_add<Grade::fast>(V(2 * triangle.weight_error), scale, of_area));
  numbers.t_bound =
      multiply_add<Grade::fast>(V(2 * triangle.volume_error), abs(inverse), abs(numbers.t) * of_area);
  return numbers;
}

// The triangles that neighbouring rays have hit of late.
class TrianglesFromOrigin {
 public:
  TrianglesFromOrigin(const TreeView& tree, const Float3& origin) : triangles_(tree), origin_(origin) {}
  const TriangleFromOrigin& operator[](std::uint32_t leaf_triangle) {
    TriangleFromOrigin& at = kept_[leaf_triangle % count];
    if (at.leaf_triangle != leaf_triangle) at = TriangleFromOrigin(triangles_, leaf_triangle, origin_);
    return at;
  }

 private:
  static constexpr std::uint32_t count = 64;
  TreeTriangles triangles_;
  Float3 origin_;
  TriangleFromOrigin kept_[count];
};

}  // namespace
}  // namespace raylanes
