// The inputs of every row: the same few rays and triangles on every machine, as floats and as doubles.
#pragma once

#include <raylanes/types.hpp>

#include "../../accel/batch/scratch.hpp"
#include "../../accel/doubles/bvh_d_arrays.hpp"
#include "../../accel/layout/bvh_arrays.hpp"
#include "../../bench/support/scenes/splitmix.hpp"
#include "../support/testing.hpp"

namespace raylanes::testing {

// Arrays of such sizes, some of whose elements take part.
inline constexpr std::size_t most = 67, sizes[] = {1, 7, 16, 33, most};
inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline const std::vector<std::uint8_t> some_lanes(most / 8 + 1, 0xb5);
inline constexpr Float3 eye{0.1f, -0.2f, 0.3f};

class Source {
 public:
  explicit Source(std::uint64_t seed) : bits_(seed) {}
  float number(double lo, double hi) { return static_cast<float>(lo + (hi - lo) * bits_.uniform()); }
  Float3 point(double half) { return {number(-half, half), number(-half, half), number(-half, half)}; }

 private:
  bench::SplitMix bits_;
};

// The last ones are copies.
inline std::vector<Triangle> some_triangles() {
  Source source(1);
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < most; ++i) {
    const Triangle other{{source.point(1), source.point(1), source.point(1)}};
    triangles.push_back(i < most - 15 ? other : triangles[most - 1 - i]);
  }
  return triangles;
}

// Doubles are thirds, beside a point that is far away.
template <class T>
PointOf<T> as(const Float3& p) {
  if constexpr (std::is_same_v<T, float>)
    return p;
  else
    return {p[0] / 3.0 + 1e6, p[1] / 3.0 - 5e6, p[2] / 3.0};
}

// Rays have nothing in common, or begin at the eye, or end there.
enum class Together { no, from_eye, to_eye };

// Some rays are parallel to an axis, some short, some go to corners, some hit nothing; of doubles some begin far away.
template <class T>
std::vector<RayOf<T>> some_rays(Together together = Together::no) {
  Source source(2);
  const std::vector<Triangle> triangles = some_triangles();
  std::vector<RayOf<T>> rays;
  for (std::size_t i = 0; i < most; ++i) {
    Float3 origin = together == Together::from_eye ? eye : source.point(2), direction = source.point(1);
    if (together == Together::to_eye)
      for (std::size_t axis = 0; axis < 3; ++axis) direction[axis] = eye[axis] - origin[axis];
    else if (i % 11 == 3)
      direction[i % 3] = 0;
    else if (i % 4 == 1)
      for (std::size_t axis = 0; axis < 3; ++axis)
        direction[axis] = triangles[i].corner[i % 3][axis] - origin[axis];
    if (i % 13 == 5) origin[1] = std::numeric_limits<float>::quiet_NaN();
    RayOf<T> ray{as<T>(origin), 0, {}, std::numeric_limits<T>::infinity()};
    for (std::size_t k = 0; k < 3; ++k)
      ray.direction[k] = static_cast<T>(direction[k]) / (std::is_same_v<T, float> ? 1 : 3);
    if (together == Together::to_eye)
      ray.tmax = T(i % 5 == 4 ? 0.5 : 1);
    else if (i % 7 == 2)
      ray.tmin = T(0.5), ray.tmax = T(1.5);
    if (i % 17 == 9) ray.tmax = -1;
    if (!std::is_same_v<T, float> && together == Together::no && i % 3 == 1)
      for (std::size_t k = 0; k < 3; ++k) ray.origin[k] -= T(0x1p30) * ray.direction[k];
    rays.push_back(ray);
  }
  return rays;
}

template <class T>
struct SmallMesh {
  std::vector<PointOf<T>> vertices;
  std::vector<Index3> triangles;

  SmallMesh() {
    for (const Triangle& triangle : some_triangles()) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const Float3& corner : triangle.corner) vertices.push_back(as<T>(corner));
      triangles.push_back({first, first + 1, first + 2});
    }
  }
};

// The BVH that rows are called with.
template <class T>
const auto& small_tree() {
  static const auto tree = [] {
    const SmallMesh<T> mesh;
    if constexpr (std::is_same_v<T, float>)
      return build_bvh(mesh.vertices, mesh.triangles, {});
    else
      return build_bvh_d(mesh.vertices, mesh.triangles, {});
  }();
  return tree;
}
template <class T>
TreeViewOf<T> small_view(bool rays_wait = false) {
  TreeViewOf<T> view = small_tree<T>().view();
  if constexpr (std::is_same_v<T, float>)
    view.rays_wait = rays_wait;
  else
    view.tree.rays_wait = rays_wait;
  return view;
}

// The primitive of a triangle as leaves number it.
inline std::uint32_t primitive_of(const TreeView& tree, std::uint32_t leaf_triangle) {
  const auto* const blocks = static_cast<const LeafBlock<9>*>(tree.blocks);
  return leaf_triangle == no_leaf_triangle
             ? no_primitive
             : blocks[leaf_triangle / tree_width].primitive[leaf_triangle % tree_width];
}
inline std::uint32_t primitive_of(const DoubleTreeView& tree, std::uint32_t leaf_triangle) {
  return leaf_triangle == no_leaf_triangle ? no_primitive
                                           : TrianglesOfHalves{tree.halves}.primitive(leaf_triangle);
}

}  // namespace raylanes::testing
