// The corners and the normals of hits in scenes, of floats and of doubles.

#include <raylanes/surface.hpp>

#include "../batch/checked_call.hpp"
#include "../batch/in_parallel.hpp"
#include "../queries/traced_tree.hpp"
#include "doubles/scene_d_parts.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

// The triangles of a geometry: of its mesh as it was given, or else of its tree.
class NamedTriangles {
 public:
  explicit NamedTriangles(const Geometry& geometry) : geometry_(geometry) {
    const Bvh* const tree = geometry.has_tree() ? geometry.triangles() : nullptr;
    if (tree == nullptr || TreeAccess::traced(*tree).leaves == nullptr) return;
    leaves_ = &TreeAccess::traced(*tree).leaves->corners;
    places_ = leaves_->places();
  }
  // Whether there is such a triangle, with three different corners.
  bool find(std::uint32_t primitive, Triangle& triangle) const {
    if (leaves_ != nullptr) {
      const std::uint64_t* const place = place_of(places_, primitive);
      if (place == nullptr) return false;
      triangle = leaves_->triangle(*place);
    } else if (!geometry_.find_corners(primitive, triangle)) {
      return false;
    }
    return !has_equal_corners(triangle.corner[0], triangle.corner[1], triangle.corner[2]);
  }

 private:
  const Geometry& geometry_;
  const Leaves* leaves_ = nullptr;
  std::vector<std::uint64_t> places_;
};

// The triangles of a geometry of doubles.
class NamedTrianglesD {
 public:
  explicit NamedTrianglesD(const GeometryD& geometry) {
    if (const BvhDArrays* const tree = TreeAccess::arrays(*geometry.tree)) corners_ = triangles_of(*tree);
  }
  bool find(std::uint32_t primitive, TriangleD& triangle) const {
    if (primitive >= corners_.size()) return false;
    std::ranges::copy(corners_[primitive].vertex, triangle.corner);
    return !has_equal_corners(triangle.corner[0], triangle.corner[1], triangle.corner[2]);
  }

 private:
  std::vector<CornersOf<double>> corners_;
};

// The triangles of the geometries that are hit.
template <class Parts>
class HitTriangles {
 public:
  using Named = std::conditional_t<std::is_same_v<Parts, SceneParts>, NamedTriangles, NamedTrianglesD>;
  using AnyTriangle = std::conditional_t<std::is_same_v<Parts, SceneParts>, Triangle, TriangleD>;

  HitTriangles(const Parts& scene, const PrimitiveView& hits)
      : scene_(scene), of_geometry_(scene.geometries.size()) {
    for (std::size_t i = 0; i < hits.count; ++i) {
      const std::uint32_t instance = hits.instance(i);
      if (instance >= scene.instances.size()) continue;
      const std::uint32_t geometry = scene.instances[instance].geometry;
      if (!of_geometry_[geometry]) of_geometry_[geometry].emplace(*scene.geometries[geometry]);
    }
  }
  // The instance and the triangle of a hit; null if it names none.
  auto find(std::uint32_t instance, std::uint32_t primitive, AnyTriangle& triangle) const {
    const auto& instances = scene_.instances;
    const auto* const hit = instance < instances.size() ? &instances[instance] : nullptr;
    return hit != nullptr && of_geometry_[hit->geometry]->find(primitive, triangle) ? hit : nullptr;
  }

 private:
  const Parts& scene_;
  std::vector<std::optional<Named>> of_geometry_;
};

// write(result, instance or null, triangle) for each hit.
template <class Parts, class Result, class Write>
void each_hit(const char* call, const char* what, const Parts& scene, PrimitiveView hits,
              std::span<Result> results, int threads, const Write& write) {
  const QuietFloats quiet;
  require_size(call, what, results.size(), "hits", hits.count);
  require_threads(call, threads);
  if (hits.count == 0) return;
  if (hits.first == nullptr || hits.to_instance == 0)
    throw std::invalid_argument(std::string(call) + ": hits in scenes are needed, which name an instance");
  KeptApart apart;
  hits = apart.primitives(hits, nullptr, Extent(results));
  const HitTriangles triangles(scene, hits);
  in_parallel(hits.count, grain_of(hits.count, threads, 4, 1024), threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                  typename HitTriangles<Parts>::AnyTriangle triangle;
                  const auto* const instance = triangles.find(hits.instance(i), hits[i], triangle);
                  write(results[i], instance, triangle);
                }
              });
}

Float3 corner_in_scene(const Instance& instance, const Float3& corner) {
  return in_scene_as_floats(instance, corner);
}
Double3 corner_in_scene(const InstanceD& instance, const Double3& corner) {
  return in_scene(instance, corner);
}

template <class Point>
constexpr Point no_point{std::numeric_limits<typename Point::value_type>::quiet_NaN(),
                         std::numeric_limits<typename Point::value_type>::quiet_NaN(),
                         std::numeric_limits<typename Point::value_type>::quiet_NaN()};

// NaN for hits of no triangle.
template <class Parts, class Point>
void write_normals(const Parts& scene, const PrimitiveView& hits, std::span<Point> normals, int threads) {
  each_hit("normals", "normals", scene, hits, normals, threads,
           [](Point& normal, const auto* instance, const auto& triangle) {
             normal = instance != nullptr ? normal_in_scene(instance->transform, unit_normal(triangle))
                                          : no_point<Point>;
           });
}
template <class Parts, class AnyTriangle>
void write_corners(const Parts& scene, const PrimitiveView& hits, std::span<AnyTriangle> triangles,
                   int threads) {
  each_hit("corners", "triangles", scene, hits, triangles, threads,
           [](AnyTriangle& to, const auto* instance, const AnyTriangle& triangle) {
             for (std::size_t k = 0; k < 3; ++k)
               to.corner[k] = instance != nullptr ? corner_in_scene(*instance, triangle.corner[k])
                                                  : no_point<PointOf<typename Parts::Number>>;
           });
}

}  // namespace

void Scene::normals(PrimitiveView hits, std::span<Float3> normals, int threads) const {
  write_normals(parts(), hits, normals, threads);
}
void Scene::corners(PrimitiveView hits, std::span<Triangle> triangles, int threads) const {
  write_corners(parts(), hits, triangles, threads);
}
void SceneD::normals(PrimitiveView hits, std::span<Double3> normals, int threads) const {
  write_normals(parts(), hits, normals, threads);
}
void SceneD::corners(PrimitiveView hits, std::span<TriangleD> triangles, int threads) const {
  write_corners(parts(), hits, triangles, threads);
}

}  // namespace raylanes
