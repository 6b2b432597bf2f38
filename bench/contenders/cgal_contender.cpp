#include "cgal_contender.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <iterator>
#include <stdexcept>
#include <vector>

#include "double_contenders.hpp"

namespace raylanes::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

template <class Point>
Kernel::Point_3 point_of(const Point& p) {
  return {p[0], p[1], p[2]};
}

}  // namespace

struct CgalContender::Trees {
  Triangles triangles;
  Tree tree;
  SurfaceMesh mesh;
  bool is_closed = true;
  std::unique_ptr<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>> side;
};

CgalContender::CgalContender(std::span<const Float3> vertices, std::span<const Index3> triangles)
    : trees_(std::make_unique<Trees>()) {
  std::vector<SurfaceMesh::Vertex_index> corners;
  for (const Float3& vertex : vertices) corners.push_back(trees_->mesh.add_vertex(point_of(vertex)));
  for (const auto& [a, b, c] : triangles) {
    trees_->triangles.emplace_back(point_of(vertices[a]), point_of(vertices[b]), point_of(vertices[c]));
    const auto face = trees_->mesh.add_face(corners[a], corners[b], corners[c]);
    trees_->is_closed = trees_->is_closed && face != SurfaceMesh::null_face();
  }
  trees_->is_closed = trees_->is_closed && CGAL::is_closed(trees_->mesh);
  trees_->tree.insert(trees_->triangles.begin(), trees_->triangles.end());
  trees_->tree.build();
  if (trees_->is_closed)
    trees_->side = std::make_unique<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>>(trees_->mesh);
}
CgalContender::~CgalContender() = default;

void CgalContender::count_hits(std::span<const Ray> rays, std::span<std::uint32_t> counts) const {
  std::vector<Tree::Intersection_and_primitive_id<Kernel::Ray_3>::Type> found;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    found.clear();
    const auto& [o, d] = std::pair(rays[i].origin, rays[i].direction);
    trees_->tree.all_intersections(Kernel::Ray_3(point_of(o), Kernel::Vector_3(d[0], d[1], d[2])),
                                   std::back_inserter(found));
    counts[i] = static_cast<std::uint32_t>(found.size());
  }
}

void CgalContender::locate(std::span<const Float3> points, std::span<Location> locations) const {
  if (!trees_->side) throw std::invalid_argument("CGAL: the mesh is not closed and oriented");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CGAL::Bounded_side side = (*trees_->side)(point_of(points[i]));
    locations[i] = side == CGAL::ON_BOUNDARY       ? Location::on
                   : side == CGAL::ON_BOUNDED_SIDE ? Location::inside
                                                   : Location::outside;
  }
}

struct CgalDoubles::Tree {
  Triangles triangles;
  bench::Tree tree;
};

CgalDoubles::CgalDoubles(const oracle::DoubleMesh& mesh) : tree_(std::make_unique<Tree>()) {
  for (const auto& [a, b, c] : mesh.triangles)
    tree_->triangles.emplace_back(point_of(mesh.vertices[a]), point_of(mesh.vertices[b]),
                                  point_of(mesh.vertices[c]));
  tree_->tree.insert(tree_->triangles.begin(), tree_->triangles.end());
  tree_->tree.build();
}
CgalDoubles::~CgalDoubles() = default;

void CgalDoubles::closest(std::span<const RayD> rays, std::span<HitD> hits) const {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [x, y, z] = rays[i].direction;
    const auto nearest = tree_->tree.first_intersected_primitive(
        Kernel::Ray_3(point_of(rays[i].origin), Kernel::Vector_3(x, y, z)));
    hits[i].primitive =
        nearest ? static_cast<std::uint32_t>(*nearest - tree_->triangles.begin()) : no_primitive;
  }
}

}  // namespace raylanes::bench
