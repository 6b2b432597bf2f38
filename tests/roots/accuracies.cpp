// The grades that users ask for, by the public functions. Those of doubles: test_root_doubles.cpp.
#include <gtest/gtest.h>

#include <map>

#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>

#include "../support/random_input.hpp"
#include "roots.hpp"

namespace raylanes::testing {
namespace {

class Grades : public ::testing::TestWithParam<const Path*> {
 protected:
  void SetUp() override { force_path(GetParam()->name); }
  void TearDown() override { unforce_path(); }
};

bool keeps(SqrtGrade grade, const Worst& worst) {
  const auto g = static_cast<std::size_t>(grade);
  return sqrt_grade_relative_error[g] > 0 ? worst.relative <= sqrt_grade_relative_error[g]
                                          : worst.ulp <= sqrt_grade_max_ulp[g];
}

// Errors of a grade's roots over all normal numbers, and how many others are not as IEEE 754 has them.
struct Judgement {
  Worst worst;
  std::uint64_t wrong_specials = 0;

  void add(float x, float y) {
    if (std::isnormal(x) && x > 0)
      measure_one(y, exact_root(static_cast<double>(x)), worst);
    else
      wrong_specials += same_bits(y, std::sqrt(x)) ? 0u : 1u;
  }
};

// Every value is tried again two registers on: what the divider took in one of the two places the method's
// own text takes in the other.
Judgement judge(SqrtGrade grade, std::size_t lanes) {
  Judgement judgement;
  sweep([&](const std::vector<float>& x) {
    std::vector<float> y(x.size());
    sqrt(x, y, grade);
    std::vector<float> moved = y;
    const std::size_t shift = std::min(2 * lanes, x.size());
    sqrt(std::span(x).subspan(shift), std::span(moved).subspan(shift), grade);
    for (std::size_t i = 0; i < x.size(); ++i) {
      judgement.add(x[i], y[i]);
      if (!same_bits(y[i], moved[i])) judgement.add(x[i], moved[i]);
    }
  });
  return judgement;
}

// All inputs with RAYLANES_EXHAUSTIVE=1; grades that one method serves are then judged once.
TEST_P(Grades, keep_their_bounds_for_all_normal_numbers_and_ieee_for_the_rest) {
  std::map<SqrtMethod, Judgement> judged;
  for (std::size_t g = 0; g < sqrt_grade_names.size(); ++g) {
    SCOPED_TRACE(sqrt_grade_names[g]);
    const auto grade = static_cast<SqrtGrade>(g);
    const SqrtMethod method = GetParam()->kernels.roots.sqrt_of_grade[g];
    if (!exhaustive() || !judged.contains(method))
      judged[method] = judge(grade, static_cast<std::size_t>(GetParam()->lanes));
    const Judgement& judgement = judged[method];
    EXPECT_TRUE(keeps(grade, judgement.worst))
        << judgement.worst.ulp << " ULP, relative " << judgement.worst.relative;
    EXPECT_EQ(judgement.wrong_specials, 0u);
  }
}

TEST(RootFunctions, refuse_sizes_that_differ_and_methods_that_do_not_exist) {
  const std::vector<float> x(5, 1.0f);
  std::vector<float> y(4), same(5);
  EXPECT_THROW(sqrt(x, y, SqrtGrade::correctly_rounded), std::invalid_argument);
  EXPECT_THROW(sqrt(x, y, SqrtMethod::hardware), std::invalid_argument);
  EXPECT_THROW(rsqrt(x, y, RsqrtMethod::hardware), std::invalid_argument);
  EXPECT_THROW(reciprocal(x, y, ReciprocalMethod::hardware), std::invalid_argument);
  EXPECT_THROW(sqrt(x, same, static_cast<SqrtGrade>(6)), std::invalid_argument);
  EXPECT_THROW(sqrt(x, same, static_cast<SqrtMethod>(200)), std::invalid_argument);
  rsqrt(x, same, RsqrtMethod::hardware);
  EXPECT_EQ(same, x);
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Grades, ::testing::ValuesIn(supported_paths()),
                         [](const ::testing::TestParamInfo<const Path*>& tested) {
                           std::string name = tested.param->name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace raylanes::testing
