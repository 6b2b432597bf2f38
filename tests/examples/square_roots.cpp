// Square roots of arrays: correctly rounded, or within a bound, with the special values of IEEE 754.
#include "example.hpp"

namespace raylanes::testing {
namespace {

TEST(SquareRootsByExample, are_correctly_rounded_on_every_path) {
  const std::vector<float> x{4, 2, 0.25f, 0x1p-149f, 0x1.fffffep127f};
  for (const Path* path : supported_paths()) {
    std::vector<float> y(x.size());
    sqrt(x, y, Accuracy::correctly_rounded, path);
    EXPECT_EQ(y, (std::vector<float>{2, 0x1.6a09e6p0f, 0.5f, 0x1.6a09e6p-75f, 0x1.fffffep63f})) << path->name;
  }
}

TEST(SquareRootsByExample, keep_special_values) {
  for (const Path* path : supported_paths()) {
    std::vector<float> y{0.0f, -0.0f, infinity, -1, nan};
    sqrt(y, y, Accuracy::correctly_rounded, path);  // in place
    EXPECT_TRUE(y[0] == 0 && !std::signbit(y[0])) << path->name;
    EXPECT_TRUE(y[1] == 0 && std::signbit(y[1])) << path->name;
    EXPECT_EQ(y[2], infinity);
    EXPECT_TRUE(std::isnan(y[3]) && std::isnan(y[4])) << path->name;
  }
}

TEST(SquareRootsByExample, may_be_less_accurate_and_faster) {
  const std::vector<float> x(1000, 2);
  for (const Path* path : supported_paths()) {
    std::vector<float> y(x.size());
    sqrt(x, y, Accuracy::within_1_ulp, path);
    for (const float root : y) EXPECT_NEAR(root, std::sqrt(2.0), 0x1p-23) << path->name;
    rsqrt(x, y, Accuracy::within_1_ulp, path);
    for (const float root : y) EXPECT_NEAR(root, std::sqrt(0.5), 0x1p-24) << path->name;
    reciprocal(x, y, Accuracy::correctly_rounded, path);
    EXPECT_EQ(y, std::vector<float>(x.size(), 0.5f)) << path->name;
  }
}

TEST(SquareRootsByExample, of_doubles_too) {
  const std::vector<double> x{2, 0x1p-1074};
  for (const Path* path : supported_paths()) {
    std::vector<double> y(x.size());
    sqrt(x, y, Accuracy::correctly_rounded, path);
    EXPECT_EQ(y, (std::vector<double>{0x1.6a09e667f3bcdp0, 0x1p-537})) << path->name;
  }
}

}  // namespace
}  // namespace raylanes::testing
