// Scenes in scenes: every query has the results of a scene that places the same parts itself, in the transforms of all
// levels taken together; and of their trees, one after the other.
#include <gmpxx.h>

#include <raylanes/stretches.hpp>

#include "../../support/filtered.hpp"
#include "../expect_queries.hpp"
#include "nested_cases.hpp"

namespace raylanes::testing {
namespace {

// Near to the parts, and some in faces of the lattice.
std::vector<Ray> rays_to(const NestedCase& nested, std::size_t count, Random& random) {
  std::vector<Ray> rays = rays_to_instances(nested.scene, count, 4, random);
  const std::vector<Ray> others = lattice_rays(random, count);
  rays.insert(rays.end(), others.begin(), others.end());
  return rays;
}

void expect_lists(const NestedCase& nested, const Scene& flat, const std::vector<Ray>& rays,
                  const ListOptions& options) {
  const auto hits = nested.scene.all_hits(rays, options), flat_hits = flat.all_hits(rays, options);
  EXPECT_EQ(hits.offsets, flat_hits.offsets);
  EXPECT_TRUE(same_bytes(hits.items, nested.renamed(flat_hits.items)));
  const auto crossings = nested.scene.crossings(rays, options),
             flat_crossings = flat.crossings(rays, options);
  EXPECT_EQ(crossings.offsets, flat_crossings.offsets);
  EXPECT_EQ(crossings.items, nested.renamed(flat_crossings.items));
  const auto within = stretches(nested.scene, rays, options), flat_within = stretches(flat, rays, options);
  EXPECT_EQ(within.offsets, flat_within.offsets);
  EXPECT_EQ(within.items, nested.renamed(flat_within.items));
  std::vector<CrossingCount> counts(rays.size()), flat_counts(rays.size());
  nested.scene.count_crossings(rays, counts, options);
  flat.count_crossings(rays, flat_counts, options);
  EXPECT_TRUE(same_bytes(counts, flat_counts));
}

void expect_points(const NestedCase& nested, const Scene& flat, const std::vector<Float3>& points,
                   const Path* path, int threads, std::uint32_t mask) {
  const std::size_t n = points.size();
  std::vector<SceneClosestPoint> closest(n), flat_closest(n);
  nested.scene.closest_points(points, closest, {.path = path, .threads = threads, .mask = mask});
  flat.closest_points(points, flat_closest, {.path = path, .threads = threads, .mask = mask});
  EXPECT_TRUE(same_bytes(closest, nested.renamed(flat_closest)));
  for (const InsideRule rule : {InsideRule::parity, InsideRule::winding}) {
    const LocateOptions by{.rule = rule, .path = path, .threads = threads, .mask = mask};
    std::vector<Location> locations(n), flat_locations(n);
    nested.scene.locate(points, locations, by), flat.locate(points, flat_locations, by);
    EXPECT_EQ(locations, flat_locations);
    std::vector<ContainingPart> inner(n), flat_inner(n);
    nested.scene.innermost_parts(points, inner, by), flat.innermost_parts(points, flat_inner, by);
    EXPECT_EQ(inner, nested.renamed(flat_inner));
    const auto all = nested.scene.containing_parts(points, by), flat_all = flat.containing_parts(points, by);
    EXPECT_EQ(all.offsets, flat_all.offsets);
    EXPECT_EQ(all.items, nested.renamed(flat_all.items));
  }
  std::vector<float> numbers(n), flat_numbers(n);
  nested.scene.signed_distances(points, numbers, {.path = path, .threads = threads, .mask = mask});
  flat.signed_distances(points, flat_numbers, {.path = path, .threads = threads, .mask = mask});
  EXPECT_TRUE(same_bytes(numbers, flat_numbers));
  nested.scene.winding_numbers(points, numbers, {.path = path, .threads = threads, .mask = mask});
  flat.winding_numbers(points, flat_numbers, {.path = path, .threads = threads, .mask = mask});
  EXPECT_TRUE(same_bytes(numbers, flat_numbers));
}

void expect_surfaces(const NestedCase& nested, const Scene& flat, const std::vector<SceneHit>& flat_hits) {
  const std::size_t n = flat_hits.size();
  const std::vector<SceneHit> hits = nested.renamed(flat_hits);
  std::vector<Float3> normals(n), flat_normals(n);
  nested.scene.normals(hits, normals), flat.normals(flat_hits, flat_normals);
  EXPECT_TRUE(same_bytes(normals, flat_normals));
  std::vector<Triangle> corners(n), flat_corners(n);
  nested.scene.corners(hits, corners), flat.corners(flat_hits, flat_corners);
  EXPECT_TRUE(same_bytes(corners, flat_corners));
}

TEST(NestedScene, answers_as_its_parts_do_in_one_scene) {
  for (std::uint64_t round = 0; round < by_level<std::uint64_t>(3, 6, 30); ++round) {
    SCOPED_TRACE(round);
    Random random(1700 + round);
    NestedCase nested = nested_case(random, 1 + round % 3, round % 2 == 0);
    nested.scene.update();
    const Scene flat = nested.flat();
    EXPECT_EQ(nested.scene.bounds().lo, flat.bounds().lo);
    EXPECT_EQ(nested.scene.bounds().hi, flat.bounds().hi);
    const std::vector<Ray> rays = rays_to(nested, by_level<std::size_t>(100, 200, 800), random);
    std::vector<Float3> points;
    for (const Ray& ray : rays) points.push_back(ray.origin);
    for (const std::uint32_t mask : {~0u, 0b0011u, 0b0100u}) {
      std::vector<SceneHit> hits(rays.size());
      flat.closest(rays, hits, {.mask = mask});
      if (mask == ~0u) {
        EXPECT_GT(std::ranges::count_if(hits, &SceneHit::operator bool), 20);
      }
      expect_hits(nested.scene, rays, nested.renamed(hits), mask);
      expect_surfaces(nested, flat, hits);
      on_each_path([&](const Path* path, int threads) {
        expect_lists(nested, flat, rays, {.path = path, .threads = threads, .mask = mask});
        expect_points(nested, flat, points, path, threads, mask);
      });
    }
  }
}

TEST(NestedScene, has_the_hits_of_its_trees_one_after_the_other) {
  for (std::uint64_t round = 0; round < by_level<std::uint64_t>(2, 4, 12); ++round) {
    SCOPED_TRACE(round);
    Random random(1750 + round);
    NestedCase nested = nested_case(random, 3, round % 2 == 0);
    nested.scene.update();
    const std::vector<Ray> rays = rays_to(nested, by_level<std::size_t>(30, 60, 200), random);
    for (const Expected& expected : {Expected(nested.scene, rays, Facing::any, ~0u, true),
                                     Expected(nested.scene, rays, Facing::front, 0b0111u, false)})
      on_each_path([&](const Path* path, int threads) {
        expect_queries(nested.scene, rays, expected, {.path = path, .threads = threads});
      });
    const TriangleParts parts = nested.parts();
    for (const Ray& ray : rays) ASSERT_TRUE(same_bytes(nested.scene.closest(ray), parts.by_rationals(ray)));
  }
}

// Each number is the exact sum but for three roundings of doubles and one to float.
TEST(NestedScene, composes_transforms_as_rational_numbers_do) {
  Random random(1780);
  for (int round = 0; round < 300; ++round) {
    Scene inner, outer;
    inner.place(inner.add(Bvh()), random_transform(random, 1, random.magnitude(1, 1e6f)), 0b0110);
    outer.place(outer.add(inner), random_transform(random, 1, random.magnitude(1, 1e6f)), 0b1011);
    const Transform a = outer.transform_of(0), b = inner.transform_of(0), product = outer.transform_of(1);
    EXPECT_EQ(outer.mask_of(1), 0b0010u);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        mpq_class exact = 0, size = 0;
        const auto add = [&](const mpq_class& term) { exact += term, size += abs(term); };
        for (std::size_t k = 0; k < 3; ++k) add(mpq_class(a.row[i][k]) * mpq_class(b.row[k][j]));
        if (j == 3) add(mpq_class(a.row[i][3]));
        const mpq_class bound = abs(exact) * mpq_class(0x1p-24) + size * mpq_class(0x1p-51),
                        error = abs(mpq_class(product.row[i][j]) - exact);
        EXPECT_LE(error, bound) << i << ", " << j;
      }
  }
}

// Numbers of instances rise from level to level, so ties go to the first one of the outermost level that differs.
TEST(NestedScene, names_the_way_to_each_instance) {
  Random random(1790);
  const NestedCase nested = nested_case(random, 3, true);
  std::size_t deepest = 0;
  for (const NestedCase::Leaf& leaf : nested.leaves) {
    EXPECT_EQ(nested.scene.levels_of(leaf.instance), leaf.levels);
    EXPECT_EQ(nested.scene.geometry_of(leaf.instance), leaf.geometry);
    EXPECT_EQ(nested.scene.mask_of(leaf.instance), leaf.mask);
    EXPECT_TRUE(same_bytes(nested.scene.transform_of(leaf.instance), leaf.transform));
    deepest = std::max(deepest, leaf.levels.size());
  }
  EXPECT_EQ(deepest, 4u);
  const auto key = [](const NestedCase::Leaf& leaf) {
    std::vector<std::uint32_t> instances;
    for (const InstanceLevel& level : leaf.levels) instances.push_back(level.instance);
    return instances;
  };
  EXPECT_TRUE(std::ranges::is_sorted(nested.leaves, {}, key));
  EXPECT_THROW(nested.scene.levels_of(static_cast<std::uint32_t>(nested.scene.instance_count())),
               std::out_of_range);
}

}  // namespace
}  // namespace raylanes::testing
