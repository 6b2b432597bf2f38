// The results of scenes of doubles by rational numbers: rays are mapped exactly and rounded once, and each triangle of
// each instance is asked. Independent of the library.
#pragma once

#include <raylanes/scene_d.hpp>

#include "../../doubles/double_cases.hpp"
#include "../../oracles/closest_crossing_oracle.hpp"

namespace raylanes::testing {

// x rounded to nearest, of two to the even one.
inline double nearest_double(const mpq_class& x) {
  const double towards_zero = x.get_d();
  const double away = std::nextafter(towards_zero, x < 0 ? -HUGE_VAL : HUGE_VAL);
  const mpq_class error = abs(x - mpq_class(towards_zero)), other = abs(mpq_class(away) - x);
  const bool is_odd = (std::bit_cast<std::uint64_t>(towards_zero) & 1u) != 0;
  return other < error || (other == error && is_odd) ? away : towards_zero;
}

// The map to the space of an instance, by Cramer's rule.
struct ExactMap {
  mpq_class inverse[3][3], translation[3];
  bool is_identity, exists;

  explicit ExactMap(const TransformD& transform) {
    using oracle::Vector;
    const TransformD identity;
    is_identity = std::memcmp(&transform, &identity, sizeof identity) == 0;
    Vector row[3];
    for (std::size_t i = 0; i < 3; ++i) {
      row[i] = oracle::to_vector(Double3{transform.row[i][0], transform.row[i][1], transform.row[i][2]});
      translation[i] = transform.row[i][3];
    }
    const mpq_class determinant = oracle::dot(row[0], oracle::cross(row[1], row[2]));
    exists = determinant != 0;
    for (std::size_t j = 0; j < 3 && exists; ++j) {
      const Vector column = oracle::cross(row[(j + 1) % 3], row[(j + 2) % 3]);
      for (std::size_t i = 0; i < 3; ++i) inverse[i][j] = column[i] / determinant;
    }
  }
  Double3 of(const oracle::Vector& v) const {
    Double3 mapped;
    for (std::size_t i = 0; i < 3; ++i)
      mapped[i] = nearest_double(inverse[i][0] * v[0] + inverse[i][1] * v[1] + inverse[i][2] * v[2]);
    return mapped;
  }
  Double3 of_point(const Double3& point) const {
    if (is_identity) return point;
    const oracle::Vector at = oracle::to_vector(point);
    return of({at[0] - translation[0], at[1] - translation[1], at[2] - translation[2]});
  }
  RayD of_ray(const RayD& ray) const {
    if (is_identity) return ray;
    return {of_point(ray.origin), ray.tmin, of(oracle::to_vector(ray.direction)), ray.tmax};
  }
};

// A scene and its meshes, by geometry; none of scenes.
struct PartsD {
  SceneD scene;
  std::vector<DoubleMesh> meshes;
  std::map<std::uint32_t, std::vector<std::uint32_t>> masks;  // of the triangles of geometries

  std::uint32_t add(const DoubleMesh& mesh) {
    meshes.push_back(mesh);
    return meshes.size() % 2 == 0 ? scene.add(mesh.vertices, mesh.triangles)
                                  : scene.add(BvhD(mesh.vertices, mesh.triangles));
  }
  std::uint32_t add(const PartsD& other) {
    const std::uint32_t number = scene.add(other.scene);
    const PartsD from = other;
    meshes.emplace_back();
    meshes.insert(meshes.end(), from.meshes.begin(), from.meshes.end());
    for (const auto& [geometry, words] : from.masks) masks[number + 1 + geometry] = words;
    return number;
  }
  void set_masks(std::uint32_t geometry, const std::vector<std::uint32_t>& words) {
    masks[geometry] = words;
    scene.set_triangle_masks(geometry, words);
  }
  // With a point in the place of each triangle that the mask does not see.
  DoubleMesh seen(std::uint32_t geometry, std::uint32_t mask) const {
    DoubleMesh seen = meshes[geometry];
    if (const auto found = masks.find(geometry); found != masks.end())
      for (std::size_t i = 0; i < std::min(found->second.size(), seen.triangles.size()); ++i)
        if ((found->second[i] & mask) == 0) seen.triangles[i] = {0, 0, 0};
    return seen;
  }
};

// The sides, the mask and the skipped triangles of a call, and what its rays find.
struct ExpectedD {
  Facing facing;
  std::uint32_t mask;
  std::vector<SceneHitD> skip;
  std::vector<std::vector<SceneHitD>> hits, closest_crossings;
  std::vector<std::vector<SceneCrossingD>> crossings;

  ExpectedD(const PartsD& parts, const std::vector<RayD>& rays, Facing side, std::uint32_t of_mask,
            std::vector<SceneHitD> skipped = {})
      : facing(side),
        mask(of_mask),
        skip(std::move(skipped)),
        hits(rays.size()),
        closest_crossings(rays.size()),
        crossings(rays.size()) {
    for (std::uint32_t i = 0; i < parts.scene.instance_count(); ++i) {
      const ExactMap map(parts.scene.transform_of(i));
      if (!map.exists || (parts.scene.mask_of(i) & mask) == 0) continue;
      for (std::size_t ray = 0; ray < rays.size(); ++ray) add(parts, rays[ray], i, map, ray);
    }
    const auto sort = [](auto& lists) {
      for (auto& list : lists)
        std::ranges::sort(list, {}, [](const auto& x) { return std::tuple(x.t, x.instance, x.primitive); });
    };
    sort(hits), sort(closest_crossings), sort(crossings);
  }
  // The first hit that a rule keeps, or a miss.
  template <class Keeps>
  SceneHitD first(std::size_t ray, const Keeps& keeps) const {
    const auto kept = std::ranges::find_if(hits[ray], keeps);
    return kept != hits[ray].end() ? *kept : SceneHitD();
  }
  SceneHitD nearest(std::size_t ray) const { return first(ray, &SceneHitD::operator bool); }

 private:
  void add(const PartsD& parts, const RayD& given, std::uint32_t instance, const ExactMap& map,
           std::size_t ray) {
    const std::uint32_t geometry = parts.scene.geometry_of(instance);
    const DoubleMesh mesh = parts.seen(geometry, mask);
    const RayD mapped = map.of_ray(given);
    const bool skips = !skip.empty() && skip[ray].instance == instance;
    const std::uint32_t without = skips ? skip[ray].primitive : no_primitive;
    const auto in_scene = [&](const HitD& hit) {
      return SceneHitD{hit.t, hit.u, hit.v, hit.primitive, geometry, instance};
    };
    std::vector<HitD> of_ray = oracle_hits(mesh, mapped, facing, without);
    for (const HitD& hit : of_ray) hits[ray].push_back(in_scene(hit));
    for (const HitD& hit : oracle_closest_crossings(mesh, mapped, without))
      if (std::ranges::find(of_ray, hit.primitive, &HitD::primitive) != of_ray.end())
        closest_crossings[ray].push_back(in_scene(hit));
    for (const CrossingD& crossing : oracle::exact_crossings(mesh, mapped))
      if (crossing.primitive != without &&
          (facing == Facing::any || crossing.side == (facing == Facing::front ? -1 : 1)))
        crossings[ray].push_back({crossing, geometry, instance});
  }
};

}  // namespace raylanes::testing
