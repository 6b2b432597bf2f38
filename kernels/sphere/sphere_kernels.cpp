// The ray–sphere tests of one path, over spheres and over rays: compiled once per path with its flags and back end;
// the table is the only symbol that leaves the object.
#include <limits>

#include "../../dispatch/table/spheres.hpp"
#include "../ray/nearest.hpp"
#include "../ray/ranges.hpp"
#include "../simd/table_rows.hpp"
#include "line.hpp"
#include "perpendicular.hpp"
#include "prepare_ray.hpp"
#include "textbook.hpp"

namespace raylanes {
namespace {

// --- 1 ray × N spheres

// The ray and its own scale, computed in one lane; what is not valid hits nothing.
inline detail::RayAmong in_scale(const Ray& ray) {
  detail::RayAmong prepared;
  prepared.ray = ray;
  if (!is_valid(ray)) prepared.ray.tmin = prepared.ray.tmax = std::numeric_limits<float>::quiet_NaN();
  prepare_for_spheres(ray.direction, prepared);
  return prepared;
}
inline ScaledRay scaled(const detail::RayAmong& prepared) {
  const Ray& ray = prepared.ray;
  Floats<W> o[3], d[3];
  broadcast(ray.origin.data(), o);
  broadcast(ray.direction.data(), d);
  return {o,
          d,
          Floats<W>(ray.tmin),
          Floats<W>(ray.tmax),
          {Floats<W>(prepared.scale), Floats<W>(prepared.unit), Floats<W>(prepared.square),
           Floats<W>(prepared.inverse_square)}};
}
inline ScaledRay scaled(const Ray& ray) {
  return scaled(in_scale(ray));
}

struct SphereSoa {
  const float* array[4];
  explicit SphereSoa(Soa spheres) : array{spheres[0], spheres[1], spheres[2], spheres[3]} {}
  template <class Slice>
  void load(const Slice& slice, Floats<W> (&out)[4]) const {
    for (int k = 0; k < 4; ++k) out[k] = slice.load(array[k]);
  }
};

template <class Test>
[[gnu::flatten]] void any_of_spheres(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                                     std::uint8_t* out) {
  ScaledRay prepared = scaled(ray);
  SphereSoa soa(spheres);
  store_decisions(0, n, active, out, [&](const auto& slice) {
    Floats<W> sphere[4];
    soa.load(slice, sphere);
    return Test::hits(prepared, sphere);
  });
}

// Tests a slice; returns the decisions.
template <class Slice>
inline FloatMask<W> store_distances(const SphereDistances& d, FloatMask<W> hit, const Slice& slice,
                                    float* near, float* far) {
  Floats<W> infinity(std::numeric_limits<float>::infinity());
  slice.store(select(hit, d.near, infinity), near);
  slice.store(select(hit, d.far, -infinity), far);
  return hit;
}

template <class Test>
[[gnu::flatten]] void distances_of_spheres(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                                           std::uint8_t* out, float* near, float* far) {
  ScaledRay prepared = scaled(ray);
  SphereSoa soa(spheres);
  store_decisions(0, n, active, out, [&](const auto& slice) {
    Floats<W> sphere[4];
    soa.load(slice, sphere);
    SphereDistances d = Test::distances(prepared, sphere);
    return store_distances(d, d.hit, slice, near, far);
  });
}

// The first of the two distances that lies in the segment, of those spheres that the segment meets at all.
template <class Test>
[[gnu::flatten, gnu::noinline]] void closest_among_spheres(const detail::RayAmong& ray, Soa spheres,
                                                           std::size_t n, LaneBits active, Hit& nearest) {
  ScaledRay prepared = scaled(ray);
  SphereSoa soa(spheres);
  Floats<W> tmin(finite_tmin(ray.ray.tmin));
  LaneBests best(ray.ray.tmax);
  for_each_slice(0, n, active, [&](const auto& slice) {
    Floats<W> sphere[4];
    soa.load(slice, sphere);
    if (!any(Test::hits(prepared, sphere))) return;
    SphereDistances d = Test::distances(prepared, sphere);
    Floats<W> t = select(d.near >= tmin, d.near, d.far);
    best.keep(d.hit & Nearer<Floats<W>>{tmin, best.t}.holds(t), t, slice.i);
  });
  nearest = best.nearest();
}
template <class Test>
[[gnu::flatten]] void closest_of_spheres(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                                         Hit& nearest) {
  closest_among_spheres<Test>(in_scale(ray), spheres, n, active, nearest);
}

// Decides within the same bound as perpendicular, not with the same bits.
template <Grade grade>
[[gnu::flatten]] void line_of_spheres(const Ray& ray, Soa spheres, std::size_t n, LaneBits active,
                                      std::uint8_t* out) {
  if (!is_valid(ray)) return store_no_hits(n, active, out);
  LineFrame frame = line_frame(ray.direction);
  Floats<W> origin[3], first[3], second[3];
  broadcast(frame.first, first);
  broadcast(frame.second, second);
  const float* centre[3];
  for (int k = 0; k < 3; ++k) {
    origin[k] = Floats<W>(ray.origin[frame.axis[k]]);
    centre[k] = spheres[frame.axis[k]];
  }
  const float* const squared_radius = spheres[3];
  store_decisions(0, n, active, out, [&](const auto& slice) {
    Vec3<Floats<W>> to_origin{origin[0] - slice.load(centre[0]), origin[1] - slice.load(centre[1]),
                              origin[2] - slice.load(centre[2])};
    return line_hits<grade>(vec3(first), vec3(second), to_origin, slice.load(squared_radius));
  });
}

// --- N rays × 1 sphere

// The numbers that the directions of a block of rays determine, in memory.
struct BlockOfScales {
  static constexpr std::size_t size = 8 * W;
  float number[4][size];
  void store(const DirectionScale<Floats<W>>& s, std::size_t i) {
    s.scale.store(number[0] + i), s.unit.store(number[1] + i);
    s.square.store(number[2] + i), s.inverse_square.store(number[3] + i);
  }
  DirectionScale<Floats<W>> load(std::size_t i) const {
    return {Floats<W>::load(number[0] + i), Floats<W>::load(number[1] + i), Floats<W>::load(number[2] + i),
            Floats<W>::load(number[3] + i)};
  }
};

// decide(slice, rays, scaled rays) for the rays of a run, in blocks and two passes: what a ray costs by itself, two
// divisions one after the other, is computed for a block of registers and kept in memory, then the tests are made. Each
// pass is a loop of short chains, of which the processor overlaps more than of the long chain through both. Does not
// pay before boxes and triangles.
template <class Run, class Decide>
inline void decide_in_blocks(Run run, const RayArrays& rays, std::uint8_t* out, Decide decide) {
  BlockOfScales scales;
  for (const std::size_t end = run.end; run.first < end; run.first = run.end) {
    run.end = end - run.first < scales.size ? end : run.first + scales.size;
    for_each_slice(run, [&](const auto& slice) {
      Floats<W> direction[3];
      for (int axis = 0; axis < 3; ++axis) direction[axis] = slice.load(rays.direction[axis]);
      scales.store(scale_of(direction), slice.i - run.first);
    });
    store_decisions(run, out, [&](const auto& slice) {
      RayColumns loaded(rays, slice);
      ScaledRay ray(loaded.origin, loaded.direction, loaded.tmin, loaded.tmax,
                    scales.load(slice.i - run.first));
      return decide(slice, loaded, ray);
    });
  }
}

template <class Test, class Run>
[[gnu::flatten, gnu::noinline]] void decide_rays(const Run& run, const RayArrays& rays, const float* sphere,
                                                 std::uint8_t* out) {
  Floats<W> one[4];
  broadcast(sphere, one);
  decide_in_blocks(run, rays, out, [&](const auto&, const RayColumns& loaded, const ScaledRay& ray) {
    return Test::hits(ray, one) & loaded.are_valid();
  });
}
template <class Test>
void any_of_rays(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* out) {
  in_runs(0, rays.size, active, [&](const auto& run) { decide_rays<Test>(run, rays, sphere, out); });
}

template <class Test, class Run>
[[gnu::flatten, gnu::noinline]] void distances_in_run(const Run& run, const RayArrays& rays,
                                                      const float* sphere, std::uint8_t* out, float* near,
                                                      float* far) {
  Floats<W> one[4];
  broadcast(sphere, one);
  decide_in_blocks(run, rays, out, [&](const auto& slice, const RayColumns& loaded, const ScaledRay& ray) {
    SphereDistances d = Test::distances(ray, one);
    return store_distances(d, d.hit & loaded.are_valid(), slice, near, far);
  });
}
template <class Test>
void distances_of_rays(const RayArrays& rays, const float* sphere, LaneBits active, std::uint8_t* out,
                       float* near, float* far) {
  in_runs(0, rays.size, active,
          [&](const auto& run) { distances_in_run<Test>(run, rays, sphere, out, near, far); });
}

struct MakeRow {
  template <class Test>
  constexpr SphereRow operator()() const {
    return {any_of_spheres<Test>, any_of_rays<Test>, closest_of_spheres<Test>, distances_of_spheres<Test>,
            distances_of_rays<Test>};
  }
};

using SphereTests = TestList<PerpendicularSphere, TextbookSphere>;
static_assert(is_complete(SphereTests{}, sphere_tests),
              "each sphere test needs one type, with the numbers it reads");

constexpr SphereKernels all_kernels() {
  SphereKernels all = rows_of<SphereKernels>(SphereTests{}, MakeRow{});
  all.line_of_spheres[static_cast<std::size_t>(Grade::reproducible)] = line_of_spheres<Grade::reproducible>;
  all.line_of_spheres[static_cast<std::size_t>(Grade::fast)] =
      line_of_spheres < has_fma ? Grade::fast : Grade::reproducible > ;
  all.prepare = prepare;
  all.closest_among = closest_among_spheres<PerpendicularSphere<Grade::reproducible>>;
  return all;
}

}  // namespace

RAYLANES_UNIT_TABLE(SphereKernels, spheres, all_kernels())
}  // namespace raylanes
