// The calls that public functions refuse, and their messages.
#include <raylanes/roots.hpp>

#include "../support/message_of.hpp"
#include "root_inputs.hpp"

namespace raylanes::testing {
namespace {

template <class T, class... Chosen>
std::string refusal(void (*function)(std::span<const T>, std::span<T>, Chosen..., const Path*),
                    Chosen... chosen, const Path* path = nullptr, std::size_t size = 3) {
  const std::vector<T> x(3, T(4));
  std::vector<T> y(size, T(-7));
  std::string message;
  try {
    function(x, y, chosen..., path);
  } catch (const std::invalid_argument& error) {
    message = error.what();
  }
  if (!message.empty()) {
    EXPECT_EQ(y, std::vector<T>(size, T(-7))) << "written in spite of: " << message;
  }
  return message;
}

TEST(RootFunctions, refuse_sizes_that_differ) {
  EXPECT_EQ((refusal<float, Accuracy>(sqrt, Accuracy::correctly_rounded, nullptr, 2)),
            "sqrt: y has 2 elements, x has 3; they must have the same number");
  EXPECT_NE((refusal<float, Accuracy>(rsqrt, Accuracy::within_1_ulp, nullptr, 4)), "");
  EXPECT_NE((refusal<float, Accuracy>(reciprocal, Accuracy::within_1_ulp, nullptr, 4)), "");
  EXPECT_NE((refusal<double, Accuracy>(sqrt, Accuracy::within_1_ulp, nullptr, 4)), "");
  EXPECT_NE((refusal<float, SqrtMethod>(sqrt, SqrtMethod::hardware, nullptr, 2)), "");
  EXPECT_NE(
      (refusal<double, DoubleReciprocalMethod>(reciprocal, DoubleReciprocalMethod::hardware, nullptr, 2)),
      "");
}

TEST(RootFunctions, refuse_accuracies_and_methods_that_do_not_exist) {
  EXPECT_EQ((refusal<float, Accuracy>(sqrt, static_cast<Accuracy>(8))),
            "sqrt: accuracy 8 does not exist; allowed are 0 to 7");
  EXPECT_EQ((refusal<double, Accuracy>(reciprocal, static_cast<Accuracy>(255))),
            "reciprocal: accuracy 255 does not exist; allowed are 0 to 7");
  EXPECT_EQ((refusal<float, SqrtMethod>(sqrt, static_cast<SqrtMethod>(8))),
            "sqrt: method 8 does not exist; allowed are 0 to 7");
  EXPECT_NE((refusal<float, RsqrtMethod>(rsqrt, static_cast<RsqrtMethod>(rsqrt_methods.size()))), "");
  EXPECT_NE((refusal<float, ReciprocalMethod>(reciprocal, static_cast<ReciprocalMethod>(4))), "");
  EXPECT_NE((refusal<double, DoubleSqrtMethod>(sqrt, static_cast<DoubleSqrtMethod>(8))), "");
  EXPECT_NE((refusal<double, DoubleRsqrtMethod>(rsqrt, static_cast<DoubleRsqrtMethod>(5))), "");
  EXPECT_NE((refusal<double, DoubleReciprocalMethod>(reciprocal, static_cast<DoubleReciprocalMethod>(4))),
            "");
}

TEST(RootFunctions, refuse_a_correctly_rounded_reciprocal_root_of_doubles_alone) {
  EXPECT_EQ((refusal<double, Accuracy>(rsqrt, Accuracy::correctly_rounded)),
            "rsqrt: accuracy correctly_rounded is not offered for double; the tightest is within_1_ulp");
  for (const AccuracyInfo& info : accuracies) {
    EXPECT_EQ((refusal<float, Accuracy>(sqrt, info.accuracy)), "");
    EXPECT_EQ((refusal<float, Accuracy>(rsqrt, info.accuracy)), "");
    EXPECT_EQ((refusal<float, Accuracy>(reciprocal, info.accuracy)), "");
    EXPECT_EQ((refusal<double, Accuracy>(sqrt, info.accuracy)), "");
    EXPECT_EQ((refusal<double, Accuracy>(reciprocal, info.accuracy)), "");
    if (info.accuracy != Accuracy::correctly_rounded) {
      EXPECT_EQ((refusal<double, Accuracy>(rsqrt, info.accuracy)), "");
    }
  }
}

TEST(RootFunctions, refuse_a_path_that_the_machine_lacks) {
  const Path& scalar = paths().front();
  for (const Path& path : paths()) {
    if (supported(path)) continue;
    EXPECT_NE((refusal<float, Accuracy>(sqrt, Accuracy::within_1_ulp, &path)), "") << path.name;
  }
  EXPECT_EQ((refusal<float, Accuracy>(sqrt, Accuracy::within_1_ulp, &scalar)), "");
}

}  // namespace
}  // namespace raylanes::testing
