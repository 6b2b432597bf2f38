// Arrays of few numbers, which calls without a path take inline: as IEEE 754 has them in every length and place, with
// the flags of each path and -ffast-math.
#include <raylanes/roots.hpp>

#include "../../bench/support/rulers/of_path.hpp"
#include "../support/guarded_array.hpp"
#include "../support/random_input.hpp"
#include "root_inputs.hpp"
#include "short_probe.hpp"

namespace raylanes {

// Defined in the probe objects; the build lists the paths.
namespace detail {
#define RAYLANES_DECLARE(path) extern const ShortCalls path##_short_calls;
RAYLANES_EACH_PATH(RAYLANES_DECLARE)
}  // namespace detail

namespace testing {
namespace {

#define RAYLANES_SHORT_CALLS(path) &detail::path##_short_calls,
constexpr const ShortCalls* all_calls[] = {RAYLANES_EACH_PATH(RAYLANES_SHORT_CALLS)};

template <class T>
using Call = void (*)(const T* x, T* y, std::size_t n, std::uint8_t accuracy);

template <class T>
const Call<T>* calls_of(const Path& path) {
  const ShortCalls& calls = of_path(path, all_calls);
  if constexpr (sizeof(T) == 4)
    return calls.of_floats;
  else
    return calls.of_doubles;
}

enum Function { square_root, reciprocal_root, reciprocal };
template <class T>
constexpr Wider<T> (*exact_of[])(Wider<T>) = {exact_root<Wider<T>>, exact_reciprocal_root<Wider<T>>,
                                              exact_reciprocal<Wider<T>>};

// Special values among numbers of all sizes; every third array has ordinary numbers alone.
template <class T>
std::vector<T> mixed(std::size_t n) {
  using Limits = std::numeric_limits<T>;
  const T special[] = {T(0),
                       T(-0.0),
                       Limits::infinity(),
                       -Limits::infinity(),
                       Limits::quiet_NaN(),
                       T(-2),
                       Limits::denorm_min(),
                       Limits::min() / 3,
                       Limits::min(),
                       Limits::max()};
  Random random(static_cast<unsigned>(n));
  std::vector<T> x(n);
  for (T& number : x) {
    number = static_cast<T>(std::ldexp(random.real(1.0, 2.0), random.integer(-120, 120)));
    if (n % 3 != 0 && random.integer(0, 3) == 0)
      number = special[static_cast<std::size_t>(random.integer(0, 9))];
  }
  return x;
}

// The result of a correctly rounded call.
template <class T>
T correct(Function function, T x) {
  if (function == reciprocal) return T(1) / x;
  return function == square_root ? std::sqrt(x) : static_cast<T>(1 / std::sqrt(static_cast<Wider<T>>(x)));
}

template <class T>
bool is_special(Function function, T x) {
  return !std::isnormal(x) || (function == reciprocal ? !std::isnormal(T(1) / x) : x < 0);
}

template <class T>
void expect_kept(Function function, const AccuracyInfo& info, T x, T y) {
  const T ieee = function == reciprocal_root ? T(1) / std::sqrt(x) : correct(function, x);
  if (is_special(function, x)) {
    EXPECT_TRUE(same_bits(y, ieee) || same_bits(y, correct(function, x))) << x << " gives " << y;
  } else if (info.accuracy == Accuracy::correctly_rounded) {
    EXPECT_EQ(y, correct(function, x)) << x;
  } else {
    Worst worst;
    measure_one(y, exact_of<T>[function](static_cast<Wider<T>>(x)), worst);
    const bool is_beyond_floats = sizeof(T) == 4 && info.accuracy == Accuracy::within_2_to_minus_44;
    const double max_ulp = is_beyond_floats ? 1.0 : info.max_ulp;
    EXPECT_LE(max_ulp > 0 ? worst.ulp : worst.relative,
              max_ulp > 0 ? max_ulp + 0x1p-10 : info.max_relative_error)
        << x << " gives " << y;
  }
}

template <class T>
void expect_all_lengths(const Path& path, Function function) {
  const Call<T> call = calls_of<T>(path)[function];
  for (const AccuracyInfo& info : accuracies) {
    if (sizeof(T) == 8 && function == reciprocal_root && info.accuracy == Accuracy::correctly_rounded)
      continue;
    for (std::size_t n = 0; n <= 70; ++n) {
      SCOPED_TRACE(std::string(path.name) + " function " + std::to_string(function) + ' ' +
                   std::string(info.name) + ", n = " + std::to_string(n));
      const std::vector<T> x = mixed<T>(n);
      for (const Place place : {Place::before_guard, Place::after_guard}) {
        GuardedArray<T> in(n, place), out(n, place), both(n, place);
        std::copy(x.begin(), x.end(), in.data());
        std::copy(x.begin(), x.end(), both.data());
        call(in.data(), out.data(), n, static_cast<std::uint8_t>(info.accuracy));
        call(both.data(), both.data(), n, static_cast<std::uint8_t>(info.accuracy));
        for (std::size_t i = 0; i < n; ++i) {
          EXPECT_TRUE(same_bits(in.data()[i], x[i]));
          EXPECT_TRUE(same_bits(both.data()[i], out.data()[i])) << i;
          expect_kept(function, info, x[i], out.data()[i]);
        }
      }
    }
  }
}

class ShortArrays : public ::testing::TestWithParam<const Path*> {};

TEST_P(ShortArrays, keep_every_accuracy_in_every_length_and_place) {
  for (const Function function : {square_root, reciprocal_root, reciprocal}) {
    expect_all_lengths<float>(*GetParam(), function);
    expect_all_lengths<double>(*GetParam(), function);
  }
}

// The correctly rounded results of all floats, or a sample of them.
TEST_P(ShortArrays, have_the_bytes_of_the_table_if_correctly_rounded) {
  const RootKernels& roots = kernels_of(*GetParam()).roots;
  const ArrayFunction<float> rows[] = {
      roots.sqrt.by[static_cast<std::size_t>(SqrtMethod::hardware)],
      roots.rsqrt.by[static_cast<std::size_t>(RsqrtMethod::in_double)],
      roots.reciprocal.by[static_cast<std::size_t>(ReciprocalMethod::hardware)]};
  sweep([&](const std::vector<float>& x) {
    for (const Function function : {square_root, reciprocal_root, reciprocal}) {
      const std::vector<float> expected = results(rows[function], x);
      std::vector<float> y(x.size());
      for (std::size_t i = 0; i < x.size(); i += 16)
        calls_of<float>(*GetParam())[function](&x[i], &y[i], std::min<std::size_t>(16, x.size() - i), 0);
      ASSERT_EQ(first_difference(y, expected), y.size()) << function;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(OnEveryPath, ShortArrays, ::testing::ValuesIn(supported_paths()), path_name);

}  // namespace
}  // namespace testing
}  // namespace raylanes
