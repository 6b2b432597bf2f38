// Memory that runs out while questions are answered: a clean std::bad_alloc, and the next call is right.
#include <fstream>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "../support/limited_memory.hpp"
#include "../support/same_bytes.hpp"
#include "query_trees.hpp"

namespace raylanes::testing {
namespace {

// With no allocation, one, two, … until they suffice; then the answer is right.
void expect_clean(const char* name, const std::function<void()>& call,
                  const std::function<bool()>& is_right) {
  SCOPED_TRACE(name);
  call();
  ASSERT_TRUE(is_right());
  std::size_t allocations = 0;
  while (allocations < 100'000 && runs_out(allocations, unlimited, call)) allocations += 1 + allocations / 8;
  EXPECT_TRUE(is_right());
  EXPECT_GT(allocations, 0u);
  EXPECT_LT(allocations, 100'000u);
}

TEST(QueryMemory, that_runs_out_is_a_clean_exception) {
  const Mesh mesh = triangle_soup(300, 0.5f, 81);
  const std::vector<Ray> few = aimed_rays(mesh, 150, 2, 82), many = repeated(few);
  std::vector<Float3> points;
  for (const Ray& ray : many) points.push_back(ray.origin);
  const Bvh bvh(mesh);
  for (const int threads : {1, 2})
    for (const std::vector<Ray>& rays : {few, many}) {
      const RayLists<Hit> hits = bvh.all_hits(rays);
      const RayLists<Crossing> crossings = bvh.crossings(rays);
      RayLists<Hit> found;
      expect_clean(
          "all_hits", [&] { found = bvh.all_hits(rays, {.threads = threads}); },
          [&] { return found.offsets == hits.offsets && same_bytes(found.items, hits.items); });
      RayLists<Crossing> crossed;
      expect_clean(
          "crossings", [&] { crossed = bvh.crossings(rays, {.threads = threads}); },
          [&] { return crossed.offsets == crossings.offsets && crossed.items == crossings.items; });
      std::vector<CrossingCount> expected(rays.size()), counts(rays.size());
      bvh.count_crossings(rays, expected);
      expect_clean(
          "count_crossings", [&] { bvh.count_crossings(rays, counts, {.threads = threads}); },
          [&] { return counts == expected; });
      std::vector<Hit> first(rays.size()), second(rays.size()), next(rays.size());
      bvh.closest(rays, first);
      bvh.closest(rays, second, {.after = first});
      expect_clean(
          "next hits", [&] { bvh.closest(rays, next, {.threads = threads, .after = first}); },
          [&] { return same_bytes(next, second); });
    }
  std::vector<float> expected(points.size()), distances(points.size());
  bvh.signed_distances(points, expected);
  expect_clean(
      "signed_distances", [&] { bvh.signed_distances(points, distances); },
      [&] { return distances == expected; });
}

// The largest resident size of the process in KB, from now on if `anew`.
std::size_t peak_of_memory(bool anew) {
  if (anew) std::ofstream("/proc/self/clear_refs") << 5;
  std::ifstream status("/proc/self/status");
  std::size_t peak = 0;
  for (std::string word; status >> word;)
    if (word == "VmHWM:") status >> peak;
  EXPECT_GT(peak, 0u);
  return peak;
}

class PeakOfMemory : public ::testing::Test {
  void SetUp() override {
#ifdef RAYLANES_SANITIZED
    GTEST_SKIP() << "sanitizers take memory of their own";
#endif
    if (!std::ifstream("/proc/self/status")) GTEST_SKIP() << "SKIPPED: no /proc tells what a process takes";
  }
};

// Entries of all rays would take 183 MB at once.
TEST_F(PeakOfMemory, that_lists_take_at_a_time_has_a_bound) {
  const Mesh mesh = stack_of(100);
  std::vector<Ray> rays(65536, make_ray({5, 5, -1}, {0, 0, 1}));
  for (std::size_t i = 0; i < rays.size(); ++i)  // many after few, so that samples mislead
    if (i >= 20000 || i % 64 == 0) rays[i].origin = {0, 0, -1};
  const Bvh bvh(mesh);
  std::vector<CrossingCount> counts(rays.size());
  const std::size_t before = peak_of_memory(true);
  bvh.count_crossings(rays, counts);
  EXPECT_LT(peak_of_memory(false), before + (std::size_t{16} << 10)) << "counts need no lists";
  const std::size_t before_lists = peak_of_memory(true);
  std::vector<CrossingCount> by_lists(rays.size());
  Bvh(mesh, {.builder = TreeBuilder::spatial_splits}).count_crossings(rays, by_lists);
  EXPECT_LT(peak_of_memory(false), before_lists + (std::size_t{100} << 10));
  EXPECT_EQ(by_lists, counts);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_EQ(counts[i].crossings, i >= 20000 || i % 64 == 0 ? 100u : 0u) << i;
}

// Entries of all rays would take 230 MB at once; some rays at a time have room for 32 MB.
TEST_F(PeakOfMemory, that_long_lists_take_at_a_time_has_a_bound) {
  const Bvh bvh(stack_of(2000), {.builder = TreeBuilder::spatial_splits});
  const std::vector<Ray> rays(4096, make_ray({0, 0, -1}, {0, 0, 1}));
  std::vector<CrossingCount> counts(rays.size());
  const std::size_t before = peak_of_memory(true);
  bvh.count_crossings(rays, counts);
  EXPECT_LT(peak_of_memory(false), before + (std::size_t{64} << 10));
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(counts[i], (CrossingCount{2000, 2000})) << i;
}

// Kernels keep 1024 entries of a single ray, and add them to its count where there are more.
TEST(QueryMemory, of_counts_holds_less_than_a_ray_crosses) {
  Mesh mesh = stack_of(5000);
  for (std::size_t i = 0; i < 1500; ++i) std::swap(mesh.triangles[i][0], mesh.triangles[i][1]);
  const Bvh bvh(mesh);
  const std::vector<Ray> rays{make_ray({0, 0, -1}, {0, 0, 1}), make_ray({0, 0, 9}, {0, 0, -1})};
  for (const Path* path : supported_paths()) {
    std::vector<CrossingCount> counts(rays.size());
    bvh.count_crossings(rays, counts, {.path = path});
    EXPECT_EQ(counts[0], (CrossingCount{5000, 2000})) << path->name;
    EXPECT_EQ(counts[1], (CrossingCount{5000, -2000})) << path->name;
  }
}

// Lists of two megabytes where there is one at most.
TEST(QueryMemory, that_lists_outgrow_is_a_clean_exception) {
  const Mesh mesh = stack_of(100);
  const std::vector<Ray> rays(rays_for_streams, make_ray({0, 0, -1}, {0, 0, 1}));
  const Bvh bvh(mesh);
  for (const int threads : {1, 2})
    for (const std::size_t bytes : {std::size_t{1} << 18, std::size_t{1} << 20}) {
      EXPECT_TRUE(runs_out(unlimited, bytes, [&] { bvh.all_hits(rays, {.threads = threads}); }));
      EXPECT_TRUE(runs_out(unlimited, bytes, [&] { bvh.crossings(rays, {.threads = threads}); }));
      EXPECT_FALSE(runs_out(unlimited, bytes, [&] {
        EXPECT_EQ(bvh.all_hits(rays, {.max_count = 3, .threads = threads}).items.size(), 3 * rays.size());
      }));
    }
  EXPECT_EQ(bvh.all_hits(rays).items.size(), 100 * rays.size());
}

// A file of one triangle that says that it is the last of 2^28.
TEST(QueryMemory, of_loaded_trees_is_by_the_bytes_of_their_files) {
  constexpr std::size_t checksum_at = 24, checked_from = 32, mesh_triangles_at = 48, nodes_at = 112;
  constexpr std::uint64_t triangles = std::uint64_t{1} << 28;
  constexpr auto last = static_cast<std::uint32_t>(triangles - 1);
  Mesh mesh;
  append(mesh, floor_triangle);
  std::stringstream saved;
  const KdTree tree(mesh);
  tree.save(saved);
  std::string file = saved.str();
  const std::size_t block_at = nodes_at + tree.view().nodes.size() * sizeof(KdNode);
  std::memcpy(file.data() + mesh_triangles_at, &triangles, sizeof triangles);
  std::memcpy(file.data() + block_at + offsetof(LeafBlock<9>, primitive), &last, sizeof last);
  const std::uint64_t sum = XXH3_64bits(file.data() + checked_from, file.size() - checked_from);
  std::memcpy(file.data() + checksum_at, &sum, sizeof sum);
  const auto ask_all = [&] {
    std::istringstream stream(file);
    const KdTree loaded = KdTree::load(stream);
    const std::vector<Float3> points = {{1, 1, 0.5f}, {5, 1, 0.25f}};
    const std::vector<Ray> rays = {make_ray({1, 1, 1}, {0, 0, -1})};
    std::vector<float> numbers(2);
    loaded.winding_numbers(points, numbers);
    loaded.signed_distances(points, numbers);
    EXPECT_EQ(loaded.closest(rays[0]).primitive, last);
    EXPECT_EQ(loaded.all_hits(rays).items[0].primitive, last);
    EXPECT_EQ(loaded.crossings(rays).items[0].primitive, last);
    EXPECT_EQ(loaded.closest_point(points[0]).primitive, last);
  };
  EXPECT_FALSE(runs_out(unlimited, std::size_t{1} << 20, ask_all));
}

}  // namespace
}  // namespace raylanes::testing
