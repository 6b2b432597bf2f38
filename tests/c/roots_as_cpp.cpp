// The C functions of roots write the bytes of the functions of C++, at the end of readable memory.
#include <gtest/gtest.h>
#include <raylanes/raylanes.h>

#include <span>
#include <vector>

#include <raylanes/roots.hpp>

#include "../support/random_input.hpp"
#include "../support/same_bytes.hpp"
#include "../support/supported_paths.hpp"
#include "apart.hpp"

namespace raylanes::testing {
namespace {

TEST(CRoots, are_those_of_the_functions) {
  const auto check = [](auto number, auto of_c, auto of_cpp, std::int32_t first) {
    using T = decltype(number);
    Random random(14);
    for (const std::size_t n : {0, 1, 15, 16, 17, 1000})
      for (std::int32_t accuracy = first; accuracy < 7; ++accuracy)
        for (const Path* path : supported_paths()) {
          std::vector<T> x(n), expected(n);
          for (T& v : x) v = static_cast<T>(random.real(-1, 100));
          Apart<T> given(x, 0), roots(n);
          of_cpp(std::span<const T>(x), std::span<T>(expected), static_cast<Accuracy>(accuracy), path);
          ASSERT_EQ(of_c(static_cast<const T*>(given.data()), static_cast<T*>(roots.data()), n, accuracy,
                         path->name),
                    RAYLANES_OK);
          EXPECT_TRUE(same_bytes(roots.values(), expected));
        }
  };
  const auto cpp_sqrt = [](auto... arguments) { raylanes::sqrt(arguments...); };
  const auto cpp_rsqrt = [](auto... arguments) { raylanes::rsqrt(arguments...); };
  const auto cpp_reciprocal = [](auto... arguments) { raylanes::reciprocal(arguments...); };
  check(0.0f, raylanes_sqrt, cpp_sqrt, 0);
  check(0.0, raylanes_sqrtd, cpp_sqrt, 0);
  check(0.0f, raylanes_rsqrt, cpp_rsqrt, 0);
  check(0.0, raylanes_rsqrtd, cpp_rsqrt, 1);
  check(0.0f, raylanes_reciprocal, cpp_reciprocal, 0);
  check(0.0, raylanes_reciprocald, cpp_reciprocal, 0);
}

}  // namespace
}  // namespace raylanes::testing
