// Numbers in messages read back as they were.
#include "../../dispatch/checked.hpp"
#include "../support/testing.hpp"

namespace raylanes::testing {
namespace {

TEST(TextOf, numbers_that_six_decimals_hide) {
  EXPECT_EQ(text_of(-1e-9), "-1e-09");
  EXPECT_EQ(text_of(1e-300), "1e-300");
  EXPECT_EQ(text_of(1e300), "1e+300");
  EXPECT_EQ(text_of(0.1f), "0.1");
  EXPECT_EQ(text_of(0.1), "0.1");
  EXPECT_EQ(text_of(-0.0), "-0");
  EXPECT_EQ(text_of(180.0), "180");
}

TEST(TextOf, numbers_that_are_not_finite) {
  EXPECT_EQ(text_of(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(text_of(-std::numeric_limits<float>::infinity()), "-inf");
}

TEST(TextOf, the_longest_text) {
  EXPECT_EQ(text_of(-std::numeric_limits<double>::max()), "-1.7976931348623157e+308");
  EXPECT_EQ(std::stod(text_of(-2.2250738585072014e-308)), -2.2250738585072014e-308);
}

}  // namespace
}  // namespace raylanes::testing
