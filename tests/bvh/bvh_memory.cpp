// Memory that runs out: nothing has been written then.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

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

}  // namespace
}  // namespace raylanes::testing
