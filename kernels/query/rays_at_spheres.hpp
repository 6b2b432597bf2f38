// Many rays at a leaf of spheres: a register of rays against one sphere at a time, by the test of SpheresOfRay.
#pragma once

#include "spheres_in_tree.hpp"

namespace raylanes {
namespace {

class RaysAtSpheres {
  static constexpr int N = native_lanes;
  using V = Floats<N>;
  using Test = PerpendicularInLanes<Grade::reproducible, N>;

 public:
  RaysAtSpheres(const SphereLeaves& spheres, const SphereVisit& leaf)
      : row_(spheres.numbers + std::size_t{4} * leaf.first),
        primitives_(spheres.primitives + leaf.first),
        leaf_(leaf) {}

  // The rays of a register from number k on.
  void visit(std::size_t k) const {
    const std::size_t count = leaf_.count - k < std::size_t{N} ? leaf_.count - k : std::size_t{N};
    std::uint32_t number[N];
    const void* records[N];
    for (std::size_t lane = 0; lane < N; ++lane) {
      number[lane] = leaf_.numbers[k + (lane < count ? lane : 0)];
      records[lane] = leaf_.rays + number[lane];
    }
    V ray[row_floats];
    load_rows(records, ray);
    const V origin[3] = {ray[0], ray[1], ray[2]}, direction[3] = {ray[4], ray[5], ray[6]};
    const ScaledRayOf<V> scaled(origin, direction, ray[3], ray[7], scale_of(direction));
    leaf_.hits != nullptr ? find_nearest(scaled, ray[3], finite_tmax(ray[7]), number, count)
                          : find_any(scaled, ray[3], finite_tmax(ray[7]), number, count);
  }

 private:
  struct Found {
    FloatMask<N> hit;
    V t;
  };
  void find_nearest(const ScaledRayOf<V>& ray, V tmin, V tmax, const std::uint32_t (&number)[N],
                    std::size_t count) const {
    float best[N];
    for (int lane = 0; lane < N; ++lane) best[lane] = leaf_.hits[number[lane]].t;
    V nearest = V::load(best);
    for (std::uint32_t i = 0; i < leaf_.size; ++i) {
      const Found found = hits_of(ray, tmin, tmax, number, i);
      const auto hit = found.hit & (found.t <= nearest) & FloatMask<N>::first(count);
      if (!any(hit)) continue;
      nearest = select(hit, found.t, nearest);
      float t[N];
      found.t.store(t);
      for (std::uint32_t lanes = bits(hit); lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        Hit& last = leaf_.hits[number[lane]];
        if (is_better(t[lane], primitives_[i], last)) last = {t[lane], 0, 0, primitives_[i]};
      }
    }
  }
  void find_any(const ScaledRayOf<V>& ray, V tmin, V tmax, const std::uint32_t (&number)[N],
                std::size_t count) const {
    std::uint32_t going = first_lanes<N>(count);
    for (std::uint32_t i = 0; i < leaf_.size && going != 0; ++i) {
      std::uint32_t hit = bits(hits_of(ray, tmin, tmax, number, i).hit) & going;
      going &= ~hit;
      for (; hit != 0; hit &= hit - 1) leaf_.occluded[number[std::countr_zero(hit)]] = 1;
    }
  }
  // The hits of rays and sphere i of the leaf.
  Found hits_of(const ScaledRayOf<V>& ray, V tmin, V tmax, const std::uint32_t (&number)[N],
                std::uint32_t i) const {
    const V sphere[4] = {V(row_[i]), V(row_[leaf_.size + i]), V(row_[2 * leaf_.size + i]),
                         V(row_[3 * leaf_.size + i])};
    const auto meets = Test::hits(ray, sphere);
    if (!any(meets)) return {meets, tmax};
    const SphereDistancesOf<V> d = Test::distances(ray, sphere);
    auto near = d.near >= tmin, far = d.far >= tmin;
    if (leaf_.skip != nullptr) skip(d, tmin, number, primitives_[i], near, far);
    const V t = select(near, d.near, d.far);
    return {d.hit & (near | far) & (t <= tmax), t};
  }
  // Leaves out the nearer side, seen from tmin, for rays that skip the sphere.
  [[gnu::noinline]] void skip(const SphereDistancesOf<V>& d, V tmin, const std::uint32_t (&number)[N],
                              std::uint32_t primitive, FloatMask<N>& near, FloatMask<N>& far) const {
    std::uint32_t skips = 0;
    for (int lane = 0; lane < N; ++lane)
      skips |= std::uint32_t{leaf_.skip[number[lane]] == primitive} << lane;
    const auto skipped = FloatMask<N>::from_bits(skips), is_near = enters_nearer(d, tmin);
    near = near & ~(skipped & is_near), far = far & ~(skipped & ~is_near);
  }

  const float* const row_;
  const std::uint32_t* const primitives_;
  const SphereVisit& leaf_;
};

// As QueryKernels has it. A few rays one by one, with spheres in lanes.
[[gnu::noinline, gnu::flatten]] void visit_spheres(const SphereLeaves& spheres, const SphereVisit& leaf) {
  constexpr std::size_t min_rays = 3;
  if (leaf.count >= min_rays) {
    for (std::size_t k = 0; k < leaf.count; k += native_lanes) RaysAtSpheres(spheres, leaf).visit(k);
    return;
  }
  for (std::size_t k = 0; k < leaf.count; ++k) {
    const std::uint32_t number = leaf.numbers[k];
    const Ray& ray = leaf.rays[number];
    const SphereQuery asked{ray.tmax, leaf.hits == nullptr,
                            leaf.skip != nullptr ? leaf.skip[number] : no_primitive};
    SphereSearch search{{}, finite_tmax(ray.tmax)};
    if (leaf.hits != nullptr) search.best = leaf.hits[number];
    SpheresOfRay(spheres, ray, asked).visit(LeafReference{leaf.first, leaf.size}, search);
    if (leaf.hits != nullptr)
      leaf.hits[number] = search.best;
    else if (search.best)
      leaf.occluded[number] = 1;
  }
}

}  // namespace
}  // namespace raylanes
