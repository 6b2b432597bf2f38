// Memory that runs out: nothing has been written then.
#include <fstream>

#include "../support/limited_memory.hpp"
#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "../traverse/reference/traced.hpp"

namespace raylanes::testing {
namespace {

// Rays of any kind before many that share an origin: their scratch is larger, and needed when some answers could be
// there.
TEST(Memory, that_a_later_part_lacks_is_missed_before_anything_is_written) {
  const Mesh mesh = triangle_soup(100, 0.4f, 80);
  const Bvh bvh(mesh);
  std::vector<Ray> rays = mixed_rays(mesh, 5000, 2, {0, 0, 0}, 81);
  for (std::size_t i = 100; i < rays.size(); ++i) rays[i].origin = {0.5f, 0.25f, 3};
  std::vector<std::uint8_t> all((rays.size() + 7) / 8, 0xff);
  const Hit untouched{-5, -5, -5, 5};
  std::size_t refused = 0;
  for (std::size_t bytes = 64; bytes < 64'000'000; bytes *= 2)
    for (const LaneBits active : {LaneBits(nullptr), LaneBits(all.data())}) {
      std::vector<Hit> hits(rays.size(), untouched);
      const bool is_refused =
          runs_out(unlimited, bytes, [&] { bvh.closest(rays, hits, {.active = active}); });
      const auto written = std::count_if(hits.begin(), hits.end(),
                                         [&](const Hit& hit) { return !same_bytes(hit, untouched); });
      ASSERT_EQ(static_cast<std::size_t>(written), is_refused ? 0 : rays.size()) << bytes;
      refused += is_refused ? 1u : 0u;
    }
  EXPECT_GT(refused, 10u);
}

// Bytes of this process, by a line of /proc/self/status.
std::size_t status(const std::string& name) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(name + ":")) return 1024 * std::stoull(line.substr(name.size() + 1));
  return 0;
}
constexpr std::uint32_t side = 750;  // of a grid of 1,125,000 triangles
Mesh rough_grid() {
  Random random(84);
  Mesh mesh;
  for (std::uint32_t y = 0; y <= side; ++y)
    for (std::uint32_t x = 0; x <= side; ++x)
      mesh.vertices.push_back({static_cast<float>(x), static_cast<float>(y), random.point(2)[2]});
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + side + 1;
      mesh.triangles.push_back({a, a + 1, b});
      mesh.triangles.push_back({b, a + 1, b + 1});
    }
  return mesh;
}
// In a process of its own, whose peak is the build's.
[[noreturn]] void build_in(TreeBuilder builder, std::size_t most_reported, std::size_t most_resident) {
  const Mesh mesh = rough_grid();
  const std::size_t before = status("VmHWM"), triangles = mesh.triangles.size();
  const Bvh bvh(mesh, {.builder = builder});
  const std::size_t reported = bvh.report().peak_bytes, resident = status("VmHWM") - before;
  std::fprintf(stderr, "%s: %zu and %zu bytes", reported <= most_reported * triangles ? "low" : "high",
               reported / triangles, resident / triangles);
  std::exit(resident <= most_resident * triangles ? 0 : 1);
}
TEST(Memory, of_builds_has_a_bound_for_each_triangle) {
#ifdef RAYLANES_SANITIZED
  GTEST_SKIP() << "sanitizers take memory of their own";
#endif
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  using enum TreeBuilder;
  EXPECT_EXIT(build_in(binned_sah, 65, 75), ::testing::ExitedWithCode(0), "low");
  EXPECT_EXIT(build_in(morton, 115, 125), ::testing::ExitedWithCode(0), "low");
  EXPECT_EXIT(build_in(spatial_splits, 75, 85), ::testing::ExitedWithCode(0), "low");
  ::testing::FLAGS_gtest_death_test_style = "fast";
}

}  // namespace
}  // namespace raylanes::testing
