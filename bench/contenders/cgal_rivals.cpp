#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include "../../accel/mesh/bounding_boxes.hpp"
#include "rivals.hpp"

namespace raylanes::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

template <class K = Kernel, class Point>
typename K::Point_3 point_of(const Point& p) {
  return {p[0], p[1], p[2]};
}

template <class K = Kernel>
struct CgalTree {
  using Triangles = std::vector<typename K::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<K, typename Triangles::const_iterator>;
  Triangles triangles;
  CGAL::AABB_tree<CGAL::AABB_traits<K, Primitive>> tree;

  // Takes the triangles that `is_taken` is true of, by their corners.
  template <class Vertices, class IsTaken>
  CgalTree(const Vertices& vertices, std::span<const Index3> all, const IsTaken& is_taken) {
    for (const auto& [a, b, c] : all)
      if (is_taken(vertices[a], vertices[b], vertices[c]))
        triangles.emplace_back(point_of<K>(vertices[a]), point_of<K>(vertices[b]), point_of<K>(vertices[c]));
    tree.rebuild(triangles.cbegin(), triangles.cend());
  }
};
constexpr auto any_triangle = [](const auto&...) { return true; };

}  // namespace

struct CgalContender::Trees {
  CgalTree<> triangles;
  SurfaceMesh mesh = {};
  bool is_closed = true;
  std::unique_ptr<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>> side = {};
};

CgalContender::CgalContender(std::span<const Float3> vertices, std::span<const Index3> triangles)
    : trees_(new Trees{{vertices, triangles, any_triangle}}) {
  std::vector<SurfaceMesh::Vertex_index> corners;
  for (const Float3& vertex : vertices) corners.push_back(trees_->mesh.add_vertex(point_of(vertex)));
  for (const auto& [a, b, c] : triangles) {
    const auto face = trees_->mesh.add_face(corners[a], corners[b], corners[c]);
    trees_->is_closed = trees_->is_closed && face != SurfaceMesh::null_face();
  }
  trees_->is_closed = trees_->is_closed && CGAL::is_closed(trees_->mesh);
  if (trees_->is_closed)
    trees_->side = std::make_unique<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>>(trees_->mesh);
}
CgalContender::~CgalContender() = default;

void CgalContender::count_hits(std::span<const Ray> rays, std::span<std::uint32_t> counts) const {
  const auto& tree = trees_->triangles.tree;
  std::vector<std::decay_t<decltype(tree)>::Intersection_and_primitive_id<Kernel::Ray_3>::Type> found;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    found.clear();
    const auto& [o, d] = std::pair(rays[i].origin, rays[i].direction);
    tree.all_intersections(Kernel::Ray_3(point_of(o), Kernel::Vector_3(d[0], d[1], d[2])),
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

struct CgalDoubles::Tree : CgalTree<> {};

CgalDoubles::CgalDoubles(const oracle::DoubleMesh& mesh)
    : tree_(new Tree{{mesh.vertices, mesh.triangles, any_triangle}}) {}
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

using PointKernel = CGAL::Simple_cartesian<double>;
struct CgalPoints::Tree : CgalTree<PointKernel> {};

CgalPoints::CgalPoints(const Mesh& mesh)
    : tree_(new Tree{{mesh.vertices, mesh.triangles,
                      [](const auto&... corners) { return !has_equal_corners(corners...); }}}) {
  tree_->tree.accelerate_distance_queries();
}
CgalPoints::~CgalPoints() = default;

void CgalPoints::closest(std::span<const Float3> points, std::span<double> squared) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointKernel::Point_3 point = point_of<PointKernel>(points[i]);
    squared[i] = CGAL::squared_distance(point, tree_->tree.closest_point(point));
  }
}

}  // namespace raylanes::bench
