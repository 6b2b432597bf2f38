#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <vector>

#include "../../accel/mesh/bounding_boxes.hpp"
#include "rivals.hpp"

namespace raylanes::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;

Kernel::Point_3 point_of(const Float3& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

Triangles triangles_of(const Mesh& mesh) {
  Triangles triangles;
  for (const auto& [a, b, c] : mesh.triangles)
    if (!has_equal_corners(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]))
      triangles.emplace_back(point_of(mesh.vertices[a]), point_of(mesh.vertices[b]),
                             point_of(mesh.vertices[c]));
  return triangles;
}

}  // namespace

struct CgalPoints::Tree {
  Triangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree;
};

CgalPoints::CgalPoints(const Mesh& mesh) : tree_(std::make_unique<Tree>()) {
  tree_->triangles = triangles_of(mesh);
  tree_->tree.rebuild(tree_->triangles.cbegin(), tree_->triangles.cend());
  tree_->tree.accelerate_distance_queries();
}
CgalPoints::~CgalPoints() = default;

void CgalPoints::closest(std::span<const Float3> points, std::span<double> squared) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Kernel::Point_3 point = point_of(points[i]);
    squared[i] = CGAL::squared_distance(point, tree_->tree.closest_point(point));
  }
}

}  // namespace raylanes::bench
