// Questions beyond the nearest hit, of rays and points of any bits to trees over meshes of any finite ones, on any
// path: lists, counts and next hits with the bytes of rational numbers, locations, nothing written
// elsewhere.
#include <raylanes/kdtree.hpp>

#include "../fuzz/any_mesh.hpp"
#include "../fuzz/any_queries.hpp"

namespace raylanes::testing {
namespace {

// A vertex, the middle of two, or a point in the plane of three: of triangles, of chords between corners of a boundary,
// and of caps.
Float3 at_or_between(Bytes& bytes, const std::vector<Float3>& vertices) {
  const Float3 &a = bytes.pick(vertices), &b = bytes.chance(64) ? a : bytes.pick(vertices);
  const Float3& c = bytes.chance(128) ? b : bytes.pick(vertices);
  Float3 point;
  for (std::size_t axis = 0; axis < 3; ++axis)
    point[axis] = 0.5f * a[axis] + (0.25f * b[axis] + 0.25f * c[axis]);
  return point;
}

}  // namespace
}  // namespace raylanes::testing

int fuzz_queries(const std::uint8_t* data, std::size_t size) {
  using namespace raylanes;
  using namespace raylanes::testing;
  Bytes bytes(data, size);
  Mesh mesh = any_mesh(bytes);
  const Placement placement(bytes);
  // Rational numbers take long.
  const std::size_t n = mesh.triangles.size() > 100 ? bytes.below(3) : bytes.below(max_queries + 1);
  Coordinates coordinates(bytes);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < n; ++i) {
    rays.push_back(any_ray(bytes, coordinates, mesh));
    if (bytes.chance(64) && !mesh.vertices.empty()) rays[i].origin = at_or_between(bytes, mesh.vertices);
    placement.move(rays[i]);
    // On a line along an axis with the one before.
    if (i > 0 && bytes.chance(128)) {
      const std::size_t axis = bytes.below(3);
      const float x = bytes.chance(64) ? finite(rays[bytes.below(i)].origin[axis]) : rays[i].origin[axis];
      rays[i].origin = rays[i - 1].origin;
      rays[i].origin[axis] = x;
    }
  }
  for (Float3& vertex : mesh.vertices) {
    placement.move(vertex);
    for (float& x : vertex) x = finite(x);
  }
  const AnyQueries<float> queries(bytes, mesh, rays);
  const auto builder = static_cast<TreeBuilder>(bytes.below(tree_builder_names.size()));
  const auto kd_builder = static_cast<KdBuilder>(bytes.below(kd_builder_names.size()));
  const bool flush = bytes.chance(64);
  const Rounding rounding(flush);
  if (bytes.chance(128))
    queries.ask(any_refitted<Bvh>(bytes, mesh, builder), flush);
  else
    queries.ask(KdTree(mesh, {.builder = kd_builder}), flush);
  return 0;
}
