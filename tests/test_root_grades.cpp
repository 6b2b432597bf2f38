// The grades that users ask for, by the public functions; and the roots of doubles.
#include <gtest/gtest.h>

#include <limits>

#include "../dispatch/paths.hpp"
#include "../dispatch/roots.hpp"
#include "generators.hpp"
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

// All inputs with RAYLANES_EXHAUSTIVE=1; every value in two places of a block, of which one is likely the
// method's own.
TEST_P(Grades, keep_their_bounds_for_all_normal_numbers_and_ieee_for_the_rest) {
  for (std::size_t g = 0; g < sqrt_grade_names.size(); ++g) {
    SCOPED_TRACE(sqrt_grade_names[g]);
    const auto grade = static_cast<SqrtGrade>(g);
    Worst worst;
    std::uint64_t wrong_specials = 0;
    sweep([&](const std::vector<float>& x) {
      std::vector<float> y(x.size());
      sqrt(x, y, grade);
      std::vector<float> normal, root;
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isnormal(x[i]) && x[i] > 0)
          normal.push_back(x[i]), root.push_back(y[i]);
        else
          wrong_specials += first_difference({y[i]}, {std::sqrt(x[i])}) == 0 ? 1u : 0u;
      }
      measure(normal, root, exact_root, worst);
    });
    EXPECT_TRUE(keeps(grade, worst)) << worst.ulp << " ULP, relative " << worst.relative;
    EXPECT_EQ(wrong_specials, 0u);
  }
}

TEST_P(Grades, of_doubles_keep_their_bounds_over_the_whole_range) {
  Random random(7);
  std::vector<double> x{std::numeric_limits<double>::min(), std::numeric_limits<double>::max(), 1.0, 4.0};
  for (int binade = -1022; binade < 1024; ++binade)
    for (int i = 0; i < (quick() ? 2 : 50); ++i) x.push_back(std::ldexp(random.real(1.0, 2.0), binade));
  std::vector<double> y(x.size());
  for (std::size_t g = 0; g < sqrt_grade_names.size(); ++g) {
    sqrt(x, y, static_cast<SqrtGrade>(g));
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double root = std::sqrt(x[i]);
      if (sqrt_grade_relative_error[g] == 0)
        ASSERT_EQ(y[i], root) << sqrt_grade_names[g] << " of " << x[i];
      else
        ASSERT_LE(std::abs(y[i] - root), sqrt_grade_relative_error[g] * root)
            << sqrt_grade_names[g] << " of " << x[i];
    }
  }
}

TEST_P(Grades, double_methods_keep_their_promises_and_ieee_special_values) {
  Random random(8);
  std::vector<double> x;
  for (int i = 0; i < (quick() ? 1000 : 200000); ++i) x.push_back(random.real(1.0, 4.0));
  for (int e = -1022; e < 1024; ++e) x.push_back(std::ldexp(random.real(1.0, 2.0), e));
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<double> specials{0.0, -0.0, 5e-324, 1e-310,  -1e-310,
                                     inf, -inf, -1.0,   -1e-300, std::nan("")};
  for (std::size_t m = 0; m < double_sqrt_methods.size(); ++m) {
    SCOPED_TRACE(double_sqrt_methods[m].name);
    const auto method = static_cast<DoubleSqrtMethod>(m);
    std::vector<double> y(x.size()), z(specials.size());
    sqrt(x, y, method);
    long double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double exact = std::sqrt(static_cast<long double>(x[i]));
      const long double ulp = std::ldexp(std::abs(y[i] - exact), 52 - std::ilogb(exact));
      worst = std::max(worst, ulp);
      ASSERT_LE(ulp, double_sqrt_methods[m].max_ulp) << x[i];
    }
    if (!quick() && double_sqrt_methods[m].reproducible) {
      EXPECT_GE(worst, 0.6 * double_sqrt_methods[m].max_ulp);
    }
    sqrt(specials, z, method);
    for (std::size_t i = 0; i < specials.size(); ++i) {
      const double expected = std::sqrt(specials[i]);
      EXPECT_TRUE(std::bit_cast<std::uint64_t>(z[i]) == std::bit_cast<std::uint64_t>(expected) ||
                  (std::isnan(z[i]) && std::isnan(expected)))
          << specials[i] << " gave " << z[i];
    }
  }
}

TEST_P(Grades, of_any_length_and_in_place) {
  for (std::size_t n = 0; n < 200; ++n) {
    std::vector<double> x(n), y(n);
    for (std::size_t i = 0; i < n; ++i) x[i] = 0.5 + static_cast<double>(i);
    for (std::size_t m = 0; m < double_sqrt_methods.size(); ++m) {
      std::vector<double> both = x;
      sqrt(x, y, static_cast<DoubleSqrtMethod>(m));
      sqrt(both, both, static_cast<DoubleSqrtMethod>(m));
      EXPECT_EQ(both, y) << double_sqrt_methods[m].name << ' ' << n;
      for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(y[i], std::sqrt(x[i]), 0.04 * std::sqrt(x[i]));
    }
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
