// The order of a Morton tree's primitives, against a sort of codes that the test makes itself.
#include "../../accel/builders/builder_table.hpp"
#include "../support/random_input.hpp"

namespace raylanes::testing {
namespace {

// The code of whole numbers from 0 to 4096, which is in the last of 4096 cells.
std::uint64_t code_of(const Float3& at) {
  std::uint64_t code = 0;
  for (int bit = 11; bit >= 0; --bit)
    for (const float x : at)
      code = code << 1 | (std::min(static_cast<std::uint64_t>(x), std::uint64_t{4095}) >> bit & 1);
  return code;
}

LargeVector<std::uint32_t> built_order(const std::vector<Float3>& points, int threads) {
  const Progress nobody;
  ProgressMeter progress(nobody);
  MemoryMeter memory;
  Array<Reference> references(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    references[i] = Reference::make(four_box({points[i], points[i]}), i);
  LargeVector<std::uint32_t> order;
  on_threads(threads, [&](int of_arena) {
    order = build_morton({std::move(references), nullptr, {of_arena, progress, memory}}).order;
  });
  return order;
}

LargeVector<std::uint32_t> expected_order(const std::vector<Float3>& points) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> codes;
  for (std::uint32_t i = 0; i < points.size(); ++i) codes.push_back({code_of(points[i]), i});
  std::sort(codes.begin(), codes.end());
  LargeVector<std::uint32_t> order;
  for (const auto& [code, i] : codes) order.push_back(i);
  return order;
}

// Many points are sorted in buckets by their highest bits: also where nearly all are in one bucket, where many have one
// code, and where the codes differ in one bit.
TEST(Morton, is_in_the_order_of_the_codes) {
  Random random(95);
  for (const std::size_t count : {std::size_t{2}, std::size_t{1000}, std::size_t{40000}})
    for (const int most : {4096, 40, 1}) {
      std::vector<Float3> points(count);
      for (Float3& point : points)
        for (float& x : point) x = static_cast<float>(random.integer(0, most));
      points[0] = {0, 0, 0}, points[1] = {4096, 4096, 4096};
      if (count > 2) points[2] = {2048, 0, 0};
      for (const int threads : {1, 2})
        EXPECT_EQ(built_order(points, threads), expected_order(points)) << count << " up to " << most;
    }
}

}  // namespace
}  // namespace raylanes::testing
