// The results that the tool calls a broken promise.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "../rows/kernels/kernel_rows.hpp"
#include "../rows/point_rows.hpp"

namespace raylanes::bench {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Promises, of_kernels) {
  struct Case {
    const char *kernel, *test;
    double wrong, leaks;
    bool kept;
  };
  for (const Case& one : {Case{"triangle", "exact", 0, 0, true},
                          {"triangle", "exact", nan, 0, false},
                          {"triangle", "exact", 0, 1, false},
                          {"triangle", "integers", 1, 0, false},
                          {"triangle", "watertight", 1, 0, true},
                          {"triangle", "watertight", 0, 1, false},
                          {"triangle", "moller_trumbore", 1, 1, true},
                          {"box", "conservative", 1, 0, false},
                          {"box", "plain", 1, 0, true}}) {
    KernelAccuracy accuracy;
    accuracy.wrong_per_million[1] = one.wrong;
    KernelRow row{};
    row.kernel = one.kernel, row.test = one.test, row.accuracy = &accuracy, row.leaks = one.leaks;
    EXPECT_EQ(keeps_promise(row), one.kept) << one.kernel << ' ' << one.test;
  }
}

TEST(Promises, of_points) {
  const std::vector<double> near{4, 9, infinity}, far{4, 16, infinity}, lost{4, nan, infinity};
  EXPECT_EQ(largest_difference(near, near, 10), 0);
  EXPECT_EQ(largest_difference(near, far, 10), 0.1);
  EXPECT_EQ(largest_difference(near, lost, 10), infinity);
  EXPECT_EQ(largest_difference(lost, near, 10), infinity);
  struct Case {
    const char* contender;
    double difference;
    std::uint32_t wrong;
    bool is_closed, is_sound;
  };
  // A point that is not where rational numbers have it says nothing where the mesh has holes.
  for (const Case& one : {Case{"bvh", 0, 0, true, true},
                          {"kdtree", infinity, 0, true, false},
                          {"embree", infinity, 1, true, true},
                          {"bvh", 0, 1, true, false},
                          {"bvh", 0, 1, false, true}}) {
    PointRow row{};
    row.contender = one.contender, row.largest_difference = one.difference, row.is_closed = one.is_closed;
    row.wrong = one.wrong;
    EXPECT_EQ(row.is_sound(), one.is_sound) << one.contender;
  }
}

}  // namespace
}  // namespace raylanes::bench
