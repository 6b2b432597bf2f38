// The ray–triangle tests of one path over arrays: compiled once per path with its flags and back end; the table
// is the only symbol that leaves the object.
#include <limits>

#include "../../dispatch/table/triangles.hpp"
#include "../exact/exact_hit.hpp"
#include "../ray/nearest.hpp"
#include "../ray/ray_columns.hpp"
#include "all_tests.hpp"
#include "prepared_shear.hpp"

namespace raylanes {
namespace {

using F = Floats<W>;
using M = FloatMask<W>;

// The numbers that the test reads of n triangles, from their corners.
template <class Test>
[[gnu::flatten]] void prepare(Soa corners, std::size_t n, LaneBits active, const float* direction,
                              float* const* out) {
  Vec3<F> d{};
  if (direction != nullptr) d = {F(direction[0]), F(direction[1]), F(direction[2])};
  for_each_slice(0, n, active, [&](const auto& slice) {
    F corner[9], number[Test::floats];
    for (int k = 0; k < 9; ++k) corner[k] = slice.load(corners[k]);
    Test::numbers_of(corner, d, number);
    for (int k = 0; k < Test::floats; ++k) slice.store(number[k], out[k]);
  });
}

// A test that screens may need the numbers again, and loads them itself: kept for that they would take the registers of
// the loop. It decides the lanes of occupied() and no others: other lanes would be undecided.
template <class Test, class Ray, class Load, class Range, class Occupied>
inline auto test_lanes(const Ray& ray, Load load, const Range& range, Occupied occupied) {
  if constexpr (screens<Test>)
    return Test::test_loaded(ray, load, occupied(), range);
  else
    return test_triangle<Test>(ray, load, range);
}

// --- One ray × N triangles

// The ray as a test wants it, and the triangles' numbers in the order that belongs to it.
template <class Test>
class RayOverTriangles {
 public:
  RayOverTriangles(const Ray& ray, Soa triangles)
      : RayOverTriangles(ray, triangles, AxesOfRay<Test>(ray.direction)) {}
  // For the exact test.
  RayOverTriangles(const detail::RayAmong& among, Soa triangles)
      : RayOverTriangles(among, triangles,
                         SharedAxes(ShearAxes{among.order[0], among.order[1], among.order[2]})) {}
  template <class Slice, class Range>
  auto test(const Slice& slice, const Range& range) const {
    return test_lanes<Test>(
        ray_, [&](int k) { return slice.load(number_[k]); }, range, [&] { return slice.taken(); });
  }
  // For a test that screens.
  template <class Slice, class Range>
  auto classify(const Slice& slice, const Range& range) const {
    return Test::template classify<false>(
        ray_, [&](int k) { return slice.load(number_[k]); }, slice.taken(), [&] { return range; });
  }

 private:
  using Axes = AxesOfRay<Test>;
  RayOverTriangles(const Ray& ray, Soa triangles, const Axes& axes)
      : ray_(Test::prepare(in_order(ray.origin, axes), in_order(ray.direction, axes), axes)) {
    take_numbers(triangles, axes);
  }
  RayOverTriangles(const detail::RayAmong& among, Soa triangles, const Axes& axes)
      : ray_(Test::of_shear(in_order(among.ray.origin, axes), in_order(among.ray.direction, axes),
                            {F(among.shear[0]), F(among.shear[1])}, axes)) {
    take_numbers(triangles, axes);
  }
  void take_numbers(Soa triangles, [[maybe_unused]] const Axes& axes) {
    if constexpr (Test::id == TriangleTest::directional)  // all in registers
      for (int k = 0; k < Test::floats; ++k) number_[k] = triangles[k];
    else  // less code
      for (int axis = 0; axis < 3; ++axis)
        for (int k = axis; k < Test::floats; k += 3) number_[k] = triangles[k - axis + axes.order[axis]];
  }
  static Vec3<F> in_order(const Float3& v, const Axes& axes) {
    return {F(v[axes.order[0]]), F(v[axes.order[1]]), F(v[axes.order[2]])};
  }

  PreparedRayOf<Test, F, Axes> ray_;
  const float* number_[Test::floats];
};

template <class Test, class Run>
[[gnu::flatten, gnu::noinline]] void decide_triangles(Run run, const Ray& ray, Soa triangles,
                                                      std::uint8_t* bits) {
  RayOverTriangles<Test> over(ray, triangles);
  Segment<F, true> segment{F(finite_tmin(ray.tmin)), F(finite_tmax(ray.tmax))};
  store_decisions(run, bits, [&](const auto& slice) { return over.test(slice, segment).hit; });
}
template <class Test>
void any_of_triangles(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, std::uint8_t* bits) {
  if (!is_valid(ray)) return store_no_hits(n, active, bits);
  in_runs(0, n, active, [&](const auto& run) { decide_triangles<Test>(run, ray, triangles, bits); });
}

template <class Test>
[[gnu::flatten]] Hit nearest_of_triangles(const Ray& ray, Soa triangles, std::size_t n, LaneBits active) {
  RayOverTriangles<Test> over(ray, triangles);
  F tmin(finite_tmin(ray.tmin));
  LaneBests best(ray.tmax);
  for_each_slice(0, n, active, [&](const auto& slice) {
    auto h = over.test(slice, Nearer<F>{tmin, best.t});
    if (!Test::eager && !any(h.hit)) return;
    best.keep(h.hit, h.t(), slice.i);
    best.u = select(h.hit, h.u(), best.u);
    best.v = select(h.hit, h.v(), best.v);
  });
  return best.nearest();
}

// For a test that screens: a leaf triangle is an index.
struct ArrayTriangles {
  Soa corners;
  float number(int k, std::uint32_t leaf_triangle) const { return corners[k][leaf_triangle]; }
  static std::uint32_t primitive(std::uint32_t leaf_triangle) { return leaf_triangle; }
};
template <class Test>
[[gnu::flatten, gnu::noinline]] void closest_among_triangles(const detail::RayAmong& among, Soa corners,
                                                             std::size_t n, LaneBits active, Hit& hit) {
  const Ray& ray = among.ray;
  if (!(ray.tmin <= ray.tmax)) return;
  RayOverTriangles<Test> over(among, corners);
  const ArrayTriangles triangles{corners};
  F tmin(finite_tmin(ray.tmin));
  Candidate nearest(ray);
  for_each_slice(0, n, active, [&](const auto& slice) {
    auto verdict = over.classify(slice, SegmentToHit<F>{{tmin, F(nearest.tmax)}, F(nearest.t_lo)});
    if ((verdict.certain | verdict.undecided) == 0) return;
    keep_nearest(triangles, ray, verdict, static_cast<std::uint32_t>(slice.i), nearest);
  });
  if (nearest.leaf_triangle != no_leaf_triangle) hit = known_hit(triangles, ray, nearest.leaf_triangle);
}

template <class Test>
void closest_of_triangles(const Ray& ray, Soa triangles, std::size_t n, LaneBits active, Hit& nearest) {
  nearest = Hit();
  if (!is_valid(ray)) return;
  if constexpr (screens<Test>) {
    detail::RayAmong prepared;
    prepared.ray = ray;
    prepare_for_triangles(ray.direction, prepared);
    closest_among_triangles<Test>(prepared, triangles, n, active, nearest);
  } else {
    nearest = nearest_of_triangles<Test>(ray, triangles, n, active);
  }
}

// --- N rays × one triangle

template <class Test>
struct TriangleUnderRays {
  F number[Test::floats];
  explicit TriangleUnderRays(const float* triangle) { broadcast(triangle, number); }
  template <bool only_decides, class Slice>
  auto test(const RayColumns& rays, const Slice& slice) const {
    Vec3<F> origin = vec3(rays.origin), direction = vec3(rays.direction);
    auto ray = Test::prepare(origin, direction, AxesOfLanes<Test, F>(direction));
    Segment<F, only_decides> segment{finite_tmin(rays.tmin), finite_tmax(rays.tmax)};
    return test_lanes<Test>(
        ray, [&](int k) { return number[k]; }, segment,
        [&] { return slice.taken() & bits(rays.are_valid()); });
  }
};

template <class Test, class Run>
[[gnu::flatten, gnu::noinline]] void decide_rays(Run run, const RayArrays& rays, const float* triangle,
                                                 std::uint8_t* bits) {
  TriangleUnderRays<Test> under(triangle);
  store_decisions(run, bits, [&](const auto& slice) {
    RayColumns loaded(rays, slice);
    return under.template test<true>(loaded, slice).hit & loaded.are_valid();
  });
}
template <class Test>
void any_of_rays(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits) {
  in_runs(0, rays.size, active, [&](const auto& run) { decide_rays<Test>(run, rays, triangle, bits); });
}

template <class Test, class Run>
[[gnu::flatten, gnu::noinline]] void hit_by_rays(Run run, const RayArrays& rays, const float* triangle,
                                                 std::uint8_t* bits, float* t, float* u, float* v) {
  TriangleUnderRays<Test> under(triangle);
  F zero(0.0f), infinity(std::numeric_limits<float>::infinity());
  store_decisions(run, bits, [&](const auto& slice) {
    RayColumns loaded(rays, slice);
    auto h = under.template test<false>(loaded, slice);
    M hit = h.hit & loaded.are_valid();
    slice.store(select(hit, h.t(), infinity), t);
    if (u != nullptr) slice.store(select(hit, h.u(), zero), u);
    if (v != nullptr) slice.store(select(hit, h.v(), zero), v);
    return hit;
  });
}
template <class Test>
void closest_of_rays(const RayArrays& rays, const float* triangle, LaneBits active, std::uint8_t* bits,
                     float* t, float* u, float* v) {
  in_runs(0, rays.size, active,
          [&](const auto& run) { hit_by_rays<Test>(run, rays, triangle, bits, t, u, v); });
}

struct MakeRow {
  template <class Test>
  constexpr TriangleRow operator()() const {
    return {prepare<Test>, any_of_triangles<Test>, any_of_rays<Test>, closest_of_triangles<Test>,
            closest_of_rays<Test>};
  }
};
static_assert(is_complete(TriangleTests{}, triangle_tests));

constexpr TriangleKernels all_kernels(TriangleKernels rows) {
  rows.closest_among = closest_among_triangles<Exact<Grade::reproducible>>;
  return rows;
}

}  // namespace

RAYLANES_UNIT_TABLE(TriangleKernels, triangles,
                    all_kernels(rows_of<TriangleKernels>(TriangleTests{}, MakeRow())))
}  // namespace raylanes
