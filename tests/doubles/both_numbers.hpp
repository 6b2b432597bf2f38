// The numbers of coordinates, for tests of floats and of doubles by one text.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <type_traits>

namespace raylanes::testing {

using Numbers = ::testing::Types<float, double>;
struct NumberNames {
  template <class T>
  static std::string GetName(int) {
    return std::is_same_v<T, float> ? "float" : "double";
  }
};

}  // namespace raylanes::testing
