// The results that the tool calls a broken promise.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "../rows/kernels/kernel_rows.hpp"
#include "../rows/point_rows.hpp"
#include "../rows/roots/root_rows.hpp"
#include "../support/roots/double_survey.hpp"

namespace raylanes::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Promises, of_square_roots) {
  const RootRow row{RootFunction::sqrt, 0, &paths().front()};
  const auto kept = [&](double max_ulp, std::uint64_t wrong_specials) {
    RootResult result(row, {});
    result.accuracy.max_ulp = max_ulp, result.accuracy.wrong_specials = wrong_specials;
    return result.keeps_promise();
  };
  const double promised = row.max_ulp_promised();
  EXPECT_TRUE(kept(promised, 0));
  EXPECT_FALSE(kept(2 * promised, 0));
  EXPECT_FALSE(kept(nan, 0));
  EXPECT_EQ(kept(promised, 1), row.promise().unchecked);
}

TEST(Promises, of_roots_of_doubles) {
  const Path* const path = &paths().front();
  const std::vector<JudgedDoubleRoot> rows = judged_double_roots(std::span(&path, 1), 2000);
  for (const JudgedDoubleRoot& row : rows) {
    EXPECT_TRUE(row.keeps_promise()) << row.function() << ' ' << row.method() << ' ' << row.largest_ulp;
    if (row.method() == "hardware" && row.function() != "double_rsqrt") {
      EXPECT_EQ(row.rounded_correctly, row.inputs) << row.function();
    }
    JudgedDoubleRoot worse = row;
    worse.largest_ulp = 2 * row.max_ulp_promised();
    EXPECT_FALSE(worse.keeps_promise());
    worse = row, worse.specials_ok = false;
    EXPECT_FALSE(worse.keeps_promise());
  }
}

TEST(Promises, of_kernels) {
  const auto kept = [](const char* test, double wrong, double leaks, const char* kernel = "triangle") {
    KernelAccuracy accuracy;
    accuracy.wrong_per_million[1] = wrong;
    KernelRow row{};
    row.kernel = kernel, row.test = test, row.accuracy = &accuracy, row.leaks = leaks;
    return keeps_promise(row);
  };
  EXPECT_TRUE(kept("exact", 0, 0));
  EXPECT_FALSE(kept("exact", 1, 0));
  EXPECT_FALSE(kept("exact", nan, 0));
  EXPECT_FALSE(kept("exact", 0, 1));
  EXPECT_FALSE(kept("integers", 1, 0));
  EXPECT_TRUE(kept("watertight", 1, 0));
  EXPECT_FALSE(kept("watertight", 0, 1));
  EXPECT_FALSE(kept("conservative", 1, 0, "box"));
  EXPECT_TRUE(kept("plain", 1, 0, "box"));
  EXPECT_FALSE(kept("directional", 1, 0, "box"));
  EXPECT_TRUE(kept("directional", 1, 0));
  EXPECT_TRUE(kept("moller_trumbore", 1, 1));
}

TEST(Promises, of_points) {
  const std::vector<double> near{4, 9, infinity}, far{4, 16, infinity}, lost{4, nan, infinity};
  EXPECT_EQ(largest_difference(near, near, 10), 0);
  EXPECT_EQ(largest_difference(near, far, 10), 0.1);
  EXPECT_EQ(largest_difference(near, lost, 10), infinity);
  EXPECT_EQ(largest_difference(lost, near, 10), infinity);
  PointRow row{};
  for (const char* ours : {"bvh", "kdtree"}) {
    row.contender = ours, row.largest_difference = 0;
    EXPECT_TRUE(row.is_sound());
    row.largest_difference = infinity;
    EXPECT_FALSE(row.is_sound());
  }
  row.contender = "embree";
  EXPECT_TRUE(row.is_sound());
  // A point that is not where rational numbers have it says nothing where the mesh has holes.
  row.largest_difference = 0, row.wrong = 1;
  EXPECT_TRUE(row.is_sound());
  row.contender = "bvh";
  EXPECT_FALSE(row.is_sound());
  row.is_closed = false;
  EXPECT_TRUE(row.is_sound());
}

}  // namespace
}  // namespace raylanes::bench
