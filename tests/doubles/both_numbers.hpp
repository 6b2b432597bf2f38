// Trees, meshes and rays of floats and of doubles, for tests of both by one text.
#pragma once

#include <raylanes/doubles.hpp>
#include <raylanes/numbers.hpp>

#include "double_cases.hpp"

namespace raylanes::testing {

using Numbers = ::testing::Types<float, double>;
struct NumberNames {
  template <class T>
  static std::string GetName(int) {
    return std::is_same_v<T, float> ? "float" : "double";
  }
};

template <class T>
using BvhOf = std::conditional_t<std::is_same_v<T, float>, Bvh, BvhD>;
template <class T>
using TraceOptionsOf = std::conditional_t<std::is_same_v<T, float>, TraceOptions, TraceOptionsD>;

// The same numbers as floats or as doubles.
template <class T>
MeshOf<T> mesh_of(const Mesh& mesh) {
  if constexpr (std::is_same_v<T, float>)
    return mesh;
  else
    return moved(mesh, 1, {0, 0, 0});
}
template <class T>
std::vector<RayOf<T>> rays_of(const std::vector<Ray>& rays) {
  std::vector<RayOf<T>> result;
  for (const Ray& ray : rays) {
    RayOf<T>& to = result.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) to.origin[k] = ray.origin[k], to.direction[k] = ray.direction[k];
    to.tmin = ray.tmin, to.tmax = ray.tmax;
  }
  return result;
}
template <class T>
BvhOf<T> tree_of(const MeshOf<T>& mesh, const BuildOptions& options = {}) {
  return BvhOf<T>(mesh.vertices, mesh.triangles, options);
}

}  // namespace raylanes::testing
