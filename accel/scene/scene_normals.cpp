// Normals of hits in scenes.

#include <raylanes/surface.hpp>

#include "../batch/checked_call.hpp"
#include "../batch/in_parallel.hpp"
#include "../queries/traced_tree.hpp"
#include "scene_parts.hpp"

namespace raylanes {
namespace {

// The triangles of a geometry; none without triangles.
struct NamedTriangles {
  const Leaves* leaves = nullptr;
  std::vector<std::uint64_t> places = {};

  explicit NamedTriangles(const Bvh* tree) {
    if (tree == nullptr || TreeAccess::traced(*tree).leaves == nullptr) return;
    leaves = &TreeAccess::traced(*tree).leaves->corners;
    places = leaves->places();
  }
};

// The matrices of the instances that are hit, and the triangles of their geometries.
class HitInstances {
 public:
  HitInstances(const Scene& scene, std::span<const Instance> instances, const PrimitiveView& hits)
      : number_of_(instances.size(), none) {
    std::vector<std::uint32_t> of_geometry(scene.geometry_count(), none);
    for (std::size_t i = 0; i < hits.count; ++i) {
      const std::uint32_t instance = hits.instance(i);
      if (instance >= instances.size() || number_of_[instance] != none) continue;
      std::uint32_t& geometry = of_geometry[instances[instance].geometry];
      if (geometry == none) {
        geometry = static_cast<std::uint32_t>(geometries_.size());
        geometries_.emplace_back(scene.tree(instances[instance].geometry));
      }
      number_of_[instance] = static_cast<std::uint32_t>(hit_.size());
      hit_.push_back({detail::NormalMatrix(instances[instance].transform), geometry});
    }
  }
  Float3 normal(std::uint32_t instance, std::uint32_t primitive) const {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    if (instance >= number_of_.size()) return {nan, nan, nan};
    const auto& [matrix, geometry] = hit_[number_of_[instance]];
    const auto& [leaves, places] = geometries_[geometry];
    const std::uint64_t* const place = place_of(places, primitive);
    return place != nullptr ? matrix(unit_normal(leaves->triangle(*place))) : Float3{nan, nan, nan};
  }

 private:
  struct HitInstance {
    detail::NormalMatrix matrix;
    std::uint32_t geometry;
  };
  static constexpr std::uint32_t none = ~0u;

  std::vector<std::uint32_t> number_of_;  // of each instance among those that are hit
  std::vector<HitInstance> hit_;
  std::vector<NamedTriangles> geometries_;
};

}  // namespace

void Scene::normals(PrimitiveView hits, std::span<Float3> normals, int threads) const {
  const QuietFloats quiet;
  require_size("normals", "normals", normals.size(), "hits", hits.count);
  require_threads("normals", threads);
  if (hits.count == 0) return;
  if (hits.first == nullptr || hits.to_instance == 0)
    throw std::invalid_argument("normals: hits in scenes are needed, which name an instance");
  KeptApart apart;
  hits = apart.primitives(hits, nullptr, Extent(normals));
  const HitInstances of_hits(*this, parts().instances, hits);
  in_parallel(hits.count, grain_of(hits.count, threads, 4, 1024), threads,
              [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                  normals[i] = of_hits.normal(hits.instance(i), hits[i]);
              });
}

}  // namespace raylanes
