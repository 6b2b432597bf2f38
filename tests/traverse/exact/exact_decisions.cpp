// The exact test where floats are hardest, against rational numbers: over arrays and in trees, on every path, in both
// grades and every mode, with and without FTZ and DAZ. The first failure is all that is printed.
#include "../../../accel/batch/shared_points.hpp"
#include "../../../bench/support/oracles/exact_rays.hpp"
#include "../../support/float_modes.hpp"
#include "../../support/same_bytes.hpp"
#include "../../support/soa.hpp"
#include "../../support/supported_paths.hpp"
#include "../../support/triangle_scenes.hpp"
#include "../reference/traced.hpp"
#include "exact_cases.hpp"

namespace raylanes::testing {
namespace {

// Both array shapes on one path: bytes of `expected`, per triangle and of all.
void expect_arrays(const ExactCase& c, const std::vector<std::vector<Hit>>& of_triangle,
                   const std::vector<Hit>& nearest, const TriangleOptions& options, FloatMode mode) {
  std::vector<Triangle> triangles;
  for (const Index3& index : c.mesh.triangles) triangles.push_back(triangle_of(c.mesh.vertices, index));
  TriangleColumns columns(triangles);
  RayColumns rays{std::span<const Ray>(c.rays)};
  TriangleHitColumns out(rays.size());
  std::vector<std::uint8_t> bits((rays.size() + 7) / 8);
  const FloatModeScope scope(mode);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    closest_hits(rays.arrays(), triangles[k], out.hits(), options);
    hit_mask(rays.arrays(), triangles[k], bits, options);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit& hit = of_triangle[k][i];
      const TriangleResult result{hit.t, hit.u, hit.v, hit ? hit_flag : 0};
      ASSERT_EQ(out[i], result) << "rays on " << options.path->name << ' ' << name_of(mode) << " triangle "
                                << k << " ray " << i << " t " << out[i].t << " for " << hit.t;
      ASSERT_EQ(is_set(bits, i), !!hit)
          << "yes or no on " << options.path->name << " triangle " << k << " ray " << i;
    }
  }
  bits.assign((triangles.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < c.rays.size(); ++i) {
    const Hit hit = closest_hit(c.rays[i], columns.arrays(), options);
    ASSERT_TRUE(same_bytes(hit, nearest[i])) << "triangles on " << options.path->name << " ray " << i;
    hit_mask(c.rays[i], columns.arrays(), bits, options);
    for (std::size_t k = 0; k < triangles.size(); ++k)
      ASSERT_EQ(is_set(bits, k), !!of_triangle[k][i])
          << "triangles, yes or no on " << options.path->name << " ray " << i;
  }
}

// Every twelfth ray with neighbours a few units in the last place beside it.
std::vector<Ray> with_neighbours(const std::vector<Ray>& rays, Random& random) {
  constexpr int widest = 16;
  std::vector<Ray> all;
  for (std::size_t i = 0; i < rays.size(); i += 12)
    for (int k = 0; k < widest; ++k) {
      Ray ray = rays[i];
      for (float& x : ray.direction)
        for (int step = random.integer(0, k % 4); step > 0 && x != 0; --step) x = std::nextafter(x, 2 * x);
      all.push_back(ray);
    }
  return all;
}

// To the same points, but all from the first one's origin and near: what packets take. Rays of one major axis
// side by side.
std::vector<Ray> from_one_origin(const std::vector<Ray>& rays) {
  std::vector<Ray> shared = rays;
  for (Ray& ray : shared) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      ray.direction[axis] += ray.origin[axis] - rays[0].origin[axis];
    ray.origin = rays[0].origin;
    if (ray.tmin < 0) ray.tmin = 0;
  }
  const auto face = [](const Ray& ray) {
    const auto larger = [](float a, float b) { return std::fabs(a) < std::fabs(b); };
    const auto major = std::max_element(ray.direction.begin(), ray.direction.end(), larger);
    return std::pair(major - ray.direction.begin(), std::signbit(*major));
  };
  std::stable_sort(shared.begin(), shared.end(),
                   [&](const Ray& a, const Ray& b) { return face(a) < face(b); });
  return shared;
}

// Through the same points to where the first one begins, from behind them or before: what packets of a shared end take,
// which want more rays than there are. Some segments end at a point, or begin there. All but those that are looked at
// miss the end by about as much as they may, beside a line that does not.
std::vector<Ray> to_one_end(const std::vector<Ray>& rays, Random& random) {
  const Float3& first = rays[0].origin;
  constexpr float parts[] = {2.0f, 32.0f, 0.75f};
  const auto way_of = [&](const Ray& ray, std::size_t axis) {
    return ray.origin[axis] + ray.direction[axis] - first[axis];
  };
  float reach = 0;
  for (const Ray& ray : rays)
    for (std::size_t axis = 0; axis < 3; ++axis) reach = std::max(reach, std::abs(way_of(ray, axis)));
  const std::size_t looked_at = rays.size() * std::size(parts) / 16;
  std::vector<Ray> shared;
  for (const float part : parts)
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const float miss = shared.size() % looked_at == 0 ? 0.0f : 0x1p-19f * reach;
      Ray ray;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float way = way_of(rays[i], axis), end = first[axis] + random.number(-miss, miss);
        ray.origin[axis] = end + part * way, ray.direction[axis] = end - ray.origin[axis];
      }
      const float at_point = 1 - 1 / part;
      ray.tmin = part > 1 && i % 5 == 1 ? at_point : 0.0f;
      ray.tmax = part > 1 && i % 5 == 2 ? at_point : 1 - 0x1p-10f;
      shared.push_back(ray);
    }
  return shared;
}

class ExactDecisions : public ::testing::TestWithParam<ExactSet> {};

TEST_P(ExactDecisions, are_those_of_rational_numbers) {
  Random random(2026);
  std::size_t hits = 0, ends = 0;
  const int rounds = exhaustive() ? 24'000 : by_level(4, 24, 140);
  for (int round = 0; round < rounds; ++round) {
    const ExactCase c = GetParam().make(random);
    std::vector<std::vector<Hit>> of_triangle;
    for (const Index3& index : c.mesh.triangles)
      of_triangle.push_back(oracle::nearest_hits({c.mesh.vertices, {index}}, c.rays));
    const std::vector<Hit> nearest = oracle::nearest_hits(c.mesh, c.rays);
    hits += static_cast<std::size_t>(
        std::count_if(nearest.begin(), nearest.end(), [](const Hit& h) { return !!h; }));
    const Bvh bvh(c.mesh);
    if (round % 4 == 1) {
      const std::vector<Ray> shared = from_one_origin(c.rays);
      const std::vector<Hit> expected = oracle::nearest_hits(c.mesh, shared);
      expect_hits(bvh, shared, expected, {});
      const FloatModeScope scope(FloatMode::flush);
      expect_hits(bvh, shared, expected, {});
    }
    if (round % 4 == 2) {
      const std::vector<Ray> shared = to_one_end(c.rays, random);
      ends += shared_end_of(shared) ? 1u : 0u;
      expect_hits(bvh, shared, oracle::nearest_hits(c.mesh, shared), {});
    }
    if (round % 4 == 0) {
      const std::vector<Ray> rays = with_neighbours(c.rays, random);
      expect_hits(bvh, rays, oracle::nearest_hits(c.mesh, rays), {});
    }
    for (const Grade grade : {Grade::reproducible, Grade::fast}) {
      for (const Path* path : supported_paths())
        for (const FloatMode mode : float_modes)
          expect_arrays(c, of_triangle, nearest, {.grade = grade, .path = path}, mode);
      expect_hits(bvh, c.rays, nearest, {.grade = grade});
      if (round % 4 == 3 && grade == Grade::reproducible)
        for (const KdBuilder builder : {KdBuilder::sah, KdBuilder::midpoint})
          expect_exact_hits(KdTree(c.mesh, {.builder = builder}), c.mesh, c.rays);
      const FloatModeScope scope(FloatMode::flush);
      expect_hits(bvh, c.rays, nearest, {.grade = grade});
    }
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
  EXPECT_GT(hits, static_cast<std::size_t>(rounds) * 4) << "the rays are aimed badly";
  // Subnormal directions have none.
  EXPECT_TRUE(ends > 0 || quick() || std::string_view(GetParam().name) == "components_that_vanish");
}

INSTANTIATE_TEST_SUITE_P(Sets, ExactDecisions, ::testing::ValuesIn(exact_sets().begin(), exact_sets().end()),
                         [](const auto& set) { return std::string(set.param.name); });

// The wall that showed that rounded decisions depend on the tree: nine triangles of a tilted strip, and a ray nearly in
// its plane that hits the inside of triangle 5.
TEST(ExactDecisions, find_the_triangle_of_the_wall) {
  const Mesh wall{
      {{0x1.333334p-1f, -0x1.03bbc2p+0f, -0x1.64b3cp-5f},
       {0x1p+0f, -0x1.03bbc2p+0f, -0x1.64b3cp-5f},
       {0x1p+0f, -0x1.3ca2f8p+0f, -0x1.811fa2p-2f},
       {0x1.333334p-1f, -0x1.95a918p-1f, 0x1.27f2b2p-2f},
       {0x1p+0f, -0x1.95a918p-1f, 0x1.27f2b2p-2f},
       {0x1.333334p-1f, -0x1.23daacp-1f, 0x1.3e3deep-1f},
       {0x1p+0f, -0x1.23daacp-1f, 0x1.3e3deep-1f},
       {0x1.333334p-1f, -0x1.64187cp-2f, 0x1.e88282p-1f},
       {0x1p+0f, -0x1.64187cp-2f, 0x1.e88282p-1f},
       {0x1.333334p-1f, -0x1.00f746p-3f, 0x1.49638cp+0f},
       {0x1p+0f, -0x1.00f746p-3f, 0x1.49638cp+0f}},
      {{0, 1, 2}, {0, 3, 1}, {3, 4, 1}, {3, 5, 4}, {5, 6, 4}, {5, 7, 6}, {7, 8, 6}, {7, 9, 8}, {9, 10, 8}}};
  const Ray ray = make_ray({0x1.7459c8p-1f, -0x1.720ce8p-2f, 0x1.de122p-1f},
                           {-0x1.69b856p-1f, -0x1.92b85p-2f, -0x1.2d4234p-1f});
  const Bvh bvh(wall);
  for (const Grade grade : {Grade::reproducible, Grade::fast})
    for (const TraceOptions& options : ways_to_trace({.grade = grade})) {
      const Hit hit = bvh.closest(ray, options);
      EXPECT_EQ(hit.primitive, 5u) << name_of(options);
      EXPECT_EQ(hit.t, 0.0806634164f) << name_of(options);
    }
}

// t is a mean of two corners' depths, halfway between two floats, but for a third corner whose weight is 2^-60.
TEST(ExactDecisions, round_once_beside_halfway) {
  constexpr float ulp = 0x1p-23f;
  for (const bool above : {false, true})
    for (const float first : {1 + ulp, 1 + 2 * ulp, -1 - ulp, -1 - 2 * ulp}) {
      const Ray ray = make_ray({0, 0, 0}, {0, 0, 1}, -infinity, infinity);
      const float second = first + ulp;
      const Mesh mesh{{{-1, 0x1p-60f, first}, {1, 0x1p-60f, second}, {0, -1, above ? 3.0f : -3.0f}},
                      {{0, 1, 2}}};
      const std::vector<Hit> hits = oracle::nearest_hits(mesh, std::span(&ray, 1));
      ASSERT_EQ(hits[0].t, above ? second : first);
      expect_hits(Bvh(mesh), std::span(&ray, 1), hits, {});
      for (const Path* path : supported_paths())
        expect_arrays({mesh, {ray}}, {hits}, hits, {.path = path}, FloatMode::ieee);
    }
}

// A component whose reciprocal is infinite moves a ray yet, if it goes far enough: out of a box that it starts beside.
TEST(ExactDecisions, find_what_tiny_components_reach) {
  const Mesh mesh = triangles_beside_z();
  const std::vector<Ray> rays{make_ray({0, 0, 0}, {0x1p-140f, 0, 1}), make_ray({0, 8, 0}, {0x1p-142f, 0, 1})};
  const std::vector<Hit> hits = oracle::nearest_hits(mesh, rays);
  ASSERT_EQ(hits[0].primitive, 0u);
  ASSERT_FALSE(hits[1]);
  expect_hits(Bvh(mesh), rays, hits, {});
  for (const KdBuilder builder : {KdBuilder::sah, KdBuilder::midpoint})
    expect_hits(KdTree(mesh, {.builder = builder}), rays, hits, {});
}

}  // namespace
}  // namespace raylanes::testing
