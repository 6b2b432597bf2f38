// The corners and the normals of hits in scenes.

#include <raylanes/surface.hpp>

#include "../batch/checked_call.hpp"
#include "../batch/in_parallel.hpp"
#include "../queries/traced_tree.hpp"
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

// The triangles of the geometries that are hit.
class HitTriangles {
 public:
  HitTriangles(const SceneParts& scene, const PrimitiveView& hits)
      : scene_(scene), of_geometry_(scene.geometries.size()) {
    for (std::size_t i = 0; i < hits.count; ++i) {
      const std::uint32_t instance = hits.instance(i);
      if (instance >= scene.instances.size()) continue;
      const std::uint32_t geometry = scene.instances[instance].geometry;
      if (!of_geometry_[geometry]) of_geometry_[geometry].emplace(*scene.geometries[geometry]);
    }
  }
  // The instance and the triangle of a hit; null if it names none.
  const Instance* find(std::uint32_t instance, std::uint32_t primitive, Triangle& triangle) const {
    if (instance >= scene_.instances.size()) return nullptr;
    const Instance& hit = scene_.instances[instance];
    return of_geometry_[hit.geometry]->find(primitive, triangle) ? &hit : nullptr;
  }

 private:
  const SceneParts& scene_;
  std::vector<std::optional<NamedTriangles>> of_geometry_;
};

// write(result, instance or null, triangle) for each hit.
template <class Result, class Write>
void each_hit(const char* call, const char* what, const SceneParts& scene, PrimitiveView hits,
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
                  Triangle triangle;
                  const Instance* const instance = triangles.find(hits.instance(i), hits[i], triangle);
                  write(results[i], instance, triangle);
                }
              });
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void Scene::normals(PrimitiveView hits, std::span<Float3> normals, int threads) const {
  each_hit("normals", "normals", parts(), hits, normals, threads,
           [](Float3& normal, const Instance* instance, const Triangle& triangle) {
             normal = instance != nullptr ? normal_in_scene(instance->transform, unit_normal(triangle))
                                          : Float3{nan, nan, nan};
           });
}
void Scene::corners(PrimitiveView hits, std::span<Triangle> triangles, int threads) const {
  each_hit("corners", "triangles", parts(), hits, triangles, threads,
           [](Triangle& to, const Instance* instance, const Triangle& triangle) {
             for (std::size_t k = 0; k < 3; ++k)
               to.corner[k] = instance == nullptr ? Float3{nan, nan, nan}
                                                  : in_scene_as_floats(*instance, triangle.corner[k]);
           });
}

}  // namespace raylanes
