// All ways to ask for roots agree, and keep what the accuracies that users name promise: on every path, by the public
// functions.
#include <raylanes/cpu_features.hpp>
#include <raylanes/roots.hpp>

#include "../../bench/rows/roots/course_roots.hpp"
#include "../../bench/support/rulers/of_path.hpp"
#include "../../dispatch/hardest_roots.hpp"
#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../support/random_input.hpp"
#include "root_inputs.hpp"
#include "rounded_root.hpp"

namespace raylanes {

// Defined in the objects of course_roots.cpp; the build lists the paths.
namespace detail {
#define RAYLANES_DECLARE(path) extern const bench::CourseRoots path##_course_roots;
RAYLANES_EACH_PATH(RAYLANES_DECLARE)
}  // namespace detail

namespace testing {
namespace {

// One of the three functions for T: its rows, its promises, and the public calls.
template <class T, class Method, std::size_t count>
struct Function {
  RootRows<T, Method, count> RootKernels::*rows;
  const std::array<RootMethodInfo<Method>, count>& methods;
  void (*within)(std::span<const T>, std::span<T>, Accuracy, const Path*);
  void (*by)(std::span<const T>, std::span<T>, Method, const Path*);
  Wider<T> (*exact)(Wider<T>);
};

template <class F>
void for_each_function(F f) {
  f(Function<float, SqrtMethod, sqrt_methods.size()>{&RootKernels::sqrt, sqrt_methods, sqrt, sqrt,
                                                     exact_root});
  f(Function<float, RsqrtMethod, rsqrt_methods.size()>{&RootKernels::rsqrt, rsqrt_methods, rsqrt, rsqrt,
                                                       exact_reciprocal_root});
  f(Function<float, ReciprocalMethod, reciprocal_methods.size()>{&RootKernels::reciprocal, reciprocal_methods,
                                                                 reciprocal, reciprocal, exact_reciprocal});
  f(Function<double, DoubleSqrtMethod, double_sqrt_methods.size()>{
      &RootKernels::double_sqrt, double_sqrt_methods, sqrt, sqrt, exact_root});
  f(Function<double, DoubleRsqrtMethod, double_rsqrt_methods.size()>{
      &RootKernels::double_rsqrt, double_rsqrt_methods, rsqrt, rsqrt, exact_reciprocal_root});
  f(Function<double, DoubleReciprocalMethod, double_reciprocal_methods.size()>{
      &RootKernels::double_reciprocal, double_reciprocal_methods, reciprocal, reciprocal, exact_reciprocal});
}

template <class T, class Method, std::size_t count>
NamedRoot<T> named(const Function<T, Method, count>& function, const Path& path, std::size_t method) {
  const RootPromise& promise = function.methods[method].promise;
  return {std::string(path.name) + ' ' + std::string(promise.name), &path, &promise,
          (kernels_of(path).roots.*function.rows).by[method], function.exact};
}

// Numbers of all kinds and sizes.
template <class T>
std::vector<T> mixed_numbers(std::size_t n) {
  Random random(11);
  std::vector<T> x{T(0),
                   T(-0.0),
                   std::numeric_limits<T>::infinity(),
                   T(-1),
                   std::numeric_limits<T>::quiet_NaN(),
                   std::numeric_limits<T>::denorm_min(),
                   std::numeric_limits<T>::max()};
  while (x.size() < n)
    x.push_back(static_cast<T>(std::ldexp(random.real(1.0, 2.0), random.integer(-120, 120))));
  return x;
}

template <class T, class Method, std::size_t count>
void expect_all_ways_agree(const Function<T, Method, count>& function, const Path& path) {
  const auto& rows = kernels_of(path).roots.*function.rows;
  const std::vector<T> x = mixed_numbers<T>(333);
  std::vector<T> y(x.size());
  for (std::size_t m = 0; m < count; ++m) {
    const std::vector<T> expected = results(rows.by[m], x);
    function.by(x, y, static_cast<Method>(m), &path);
    EXPECT_EQ(first_difference(y, expected), y.size())
        << path.name << ' ' << function.methods[m].promise.name;
  }
  for (const AccuracyInfo& info : accuracies) {
    if (std::is_same_v<Method, DoubleRsqrtMethod> && info.accuracy == Accuracy::correctly_rounded) continue;
    auto serving = rows.within[static_cast<std::size_t>(info.accuracy)];
    if constexpr (std::is_same_v<Method, SqrtMethod>)
      serving = serving_sqrt(kernels_of(path).roots, info.accuracy, machine_splits_512_bits());
    const std::vector<T> expected = results(rows.by[static_cast<std::size_t>(serving)], x);
    function.within(x, y, info.accuracy, &path);
    EXPECT_EQ(first_difference(y, expected), y.size()) << path.name << ' ' << info.name;
    force_path(path.name);
    function.within(x, y, info.accuracy, nullptr);
    unforce_path();
    EXPECT_EQ(first_difference(y, expected), y.size())
        << path.name << ' ' << info.name << ", as the path in use";
  }
}

TEST(RootFunctions, agree_by_accuracy_by_method_by_path_and_with_the_table) {
  for (const Path* path : supported_paths())
    for_each_function([&](const auto& function) { expect_all_ways_agree(function, *path); });
}

TEST(RootFunctions, have_defaults_that_users_can_rely_on) {
  const std::vector<float> x{4.0f, 0.25f};
  const std::vector<double> d{4.0, 0.25};
  std::vector<float> y(2);
  std::vector<double> z(2);
  sqrt(x, y), sqrt(d, z);
  EXPECT_EQ(y, (std::vector<float>{2.0f, 0.5f}));
  EXPECT_EQ(z, (std::vector<double>{2.0, 0.5}));
  rsqrt(x, y), rsqrt(d, z);
  EXPECT_EQ(y, (std::vector<float>{0.5f, 2.0f}));
  EXPECT_EQ(z, (std::vector<double>{0.5, 2.0}));
  reciprocal(x, y), reciprocal(d, z);
  EXPECT_EQ(y, (std::vector<float>{0.25f, 4.0f}));
  EXPECT_EQ(z, (std::vector<double>{0.25, 4.0}));
}

// Arrays that end before any kernel begins: one number past them on each side, in place, with every accuracy.
template <class T>
void expect_short_roots(const Path* path) {
  for (const AccuracyInfo& info : accuracies)
    for (std::size_t n = 0; n <= 20; ++n) {
      std::vector<T> x = mixed_numbers<T>(40);
      std::rotate(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n), x.end());
      std::vector<T> y(n + 2, T(-7)), both(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n));
      sqrt(std::span<const T>(x.data(), n), std::span<T>(y.data() + 1, n), info.accuracy, path);
      sqrt(std::span<const T>(both), std::span<T>(both), info.accuracy, path);
      EXPECT_TRUE(y.front() == T(-7) && y.back() == T(-7)) << info.name << ", n = " << n;
      for (std::size_t i = 0; i < n; ++i) {
        const bool by_instruction = info.accuracy == Accuracy::correctly_rounded;
        EXPECT_TRUE(!by_instruction || same_bits(y[i + 1], std::sqrt(x[i]))) << info.name << ", n = " << n;
        EXPECT_TRUE(same_bits(both[i], y[i + 1])) << info.name << ", n = " << n;
      }
    }
}

TEST(RootFunctions, take_short_arrays_through_the_instruction) {
  for (const Path* path : supported_paths())
    expect_short_roots<float>(path), expect_short_roots<double>(path);
  float y[3];
  EXPECT_THROW(sqrt(std::span<const float>(y, 2), std::span<float>(y, 3)), std::invalid_argument);
  EXPECT_THROW(sqrt(std::span<const float>(y, 2), std::span<float>(y, 2), static_cast<Accuracy>(8)),
               std::invalid_argument);
}

// --- Bounds.

// The error that an accuracy allows T: no float keeps 2^-44, and 1 ULP is what it gets.
template <class T>
bool keeps(const AccuracyInfo& info, const Worst& worst) {
  if (sizeof(T) == 4 && info.accuracy == Accuracy::within_2_to_minus_44) return worst.ulp <= 1.0;
  // Doubles are held against 64 bits.
  const double slack = sizeof(T) == 4 ? 0 : 0x1p-10;
  return info.max_ulp > 0 ? worst.ulp <= info.max_ulp + slack : worst.relative <= info.max_relative_error;
}

// Errors over all normal numbers of the domain, and how many others are not as IEEE 754 has them.
template <class T>
struct Judgement {
  Worst worst;
  std::uint64_t wrong_specials = 0;

  void add(const NamedRoot<T>& root, T x, T y) {
    const bool normal = std::isnormal(x) && (root.is_reciprocal() ? std::isnormal(T(1) / x) : x > 0);
    if (normal)
      measure_one(y, root.exact(static_cast<Wider<T>>(x)), worst);
    else
      wrong_specials += same_bits(y, ieee(root, x)) || same_bits(y, rounded(root, x)) ? 0u : 1u;
  }
  // If x is subnormal, 1/√x may have been rounded once or twice.
  static T rounded(const NamedRoot<T>& root, T x) {
    return static_cast<T>(root.exact(static_cast<Wider<T>>(x)));
  }
};

// Every value is tried again two registers on: what the divider took in one of the two places the method's own text
// takes in the other.
template <class T>
void judge(Judgement<T>& judgement, const NamedRoot<T>& root, const std::vector<T>& x) {
  const std::vector<T> y = results(root.function, x);
  std::vector<T> moved = y;
  const std::size_t shift = std::min(2 * static_cast<std::size_t>(root.path->lanes), x.size());
  root.function(x.data() + shift, moved.data() + shift, x.size() - shift);
  for (std::size_t i = 0; i < x.size(); ++i) {
    judgement.add(root, x[i], y[i]);
    if (!same_bits(y[i], moved[i])) judgement.add(root, x[i], moved[i]);
  }
}

template <class T>
Judgement<T> judged(const NamedRoot<T>& root) {
  Judgement<T> judgement;
  Random random(12);
  if (sizeof(T) == 4 && exhaustive()) {
    if constexpr (sizeof(T) == 4) sweep([&](const std::vector<float>& x) { judge(judgement, root, x); });
  } else if constexpr (sizeof(T) == 4) {
    // All kinds of numbers, those that are hard to round, and around the borders of binades: root_survey judges more.
    std::vector<float> x = hard_float_roots();
    for (std::uint64_t border = 0; border <= 0x100000000; border += min_normal)
      for (std::uint64_t offset = 0; offset < 64; ++offset) x.push_back(from_bits(border - 32 + offset));
    for (int i = 0; i < (quick() ? 3000 : 100000); ++i)
      x.push_back(from_bits(static_cast<std::uint64_t>(random.real(0.0, 0x1p32))));
    judge(judgement, root, x);
  } else {
    std::vector<double> x = mixed_numbers<double>(1000);
    for (int i = 0; i < (quick() ? 1000 : 100000); ++i)
      x.push_back(
          std::ldexp(random.real(1.0, 2.0), i % 3 == 0 ? random.integer(-1022, 1023) : random.integer(0, 1)));
    judge(judgement, root, x);
  }
  return judgement;
}

class Accuracies : public ::testing::TestWithParam<const Path*> {};

// All floats at level exhaustive. A method that serves several accuracies is judged once.
TEST_P(Accuracies, keep_their_bounds_for_all_normal_numbers_and_ieee_for_the_rest) {
  for_each_function(
      [&]<class T, class Method, std::size_t count>(const Function<T, Method, count>& function) {
        std::map<Method, Judgement<T>> judgements;
        for (const AccuracyInfo& info : accuracies) {
          if (std::is_same_v<Method, DoubleRsqrtMethod> && info.accuracy == Accuracy::correctly_rounded)
            continue;
          const Method method =
              (kernels_of(*GetParam()).roots.*function.rows).within[static_cast<std::size_t>(info.accuracy)];
          const NamedRoot<T> root = named(function, *GetParam(), static_cast<std::size_t>(method));
          if (!judgements.contains(method)) judgements[method] = judged(root);
          const Judgement<T>& judgement = judgements[method];
          EXPECT_TRUE(keeps<T>(info, judgement.worst))
              << info.name << " by " << root.name << ": " << judgement.worst.ulp << " ULP, relative "
              << judgement.worst.relative;
          EXPECT_EQ(judgement.wrong_specials, 0u) << info.name << " by " << root.name;
        }
      });
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, Accuracies, ::testing::ValuesIn(supported_paths()), path_name);

#define RAYLANES_COURSE(path) &detail::path##_course_roots,
const bench::CourseRoots* const all_course_roots[] = {RAYLANES_EACH_PATH(RAYLANES_COURSE)};

TEST(ClassicRoot, has_the_same_bits_in_all_its_forms) {
  std::vector<float> x;
  for (std::uint64_t bits = 0; bits < 0x100000000; bits += quick() ? 1000003 : 65537)
    x.push_back(from_bits(bits));
  for (const Path* path : supported_paths()) {
    const auto method = static_cast<std::size_t>(SqrtMethod::classic_2);
    const std::vector<float> expected = results(kernels_of(*path).roots.sqrt.by[method], x);
    for (const bench::CourseRoot& form : of_path(*path, all_course_roots).form)
      for (std::size_t n : {x.size(), std::size_t{7}, std::size_t{1}, std::size_t{0}}) {
        std::vector<float> y(x.size(), -7.0f), wanted = y;
        std::copy_n(expected.begin(), n, wanted.begin());
        form.run(x.data(), y.data(), n);
        EXPECT_EQ(first_difference(y, wanted), x.size()) << path->name << ' ' << form.name;
      }
  }
}

}  // namespace
}  // namespace testing
}  // namespace raylanes
