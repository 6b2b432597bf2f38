// Roots as functions on arrays: lengths, places, what lies around them, modes of the processor.
#include "../../dispatch/table/roots.hpp"
#include "../support/float_modes.hpp"
#include "../support/guarded_array.hpp"
#include "root_inputs.hpp"

namespace raylanes::testing {
namespace {

// Numbers of all kinds, some in each register; or ordinary ones, no powers of two, for which blocks take the short
// way.
template <class T>
std::vector<T> numbers(std::size_t n, bool ordinary) {
  using Limits = std::numeric_limits<T>;
  const T kinds[] = {
      T(2),       T(0),    T(3.7e5), Limits::quiet_NaN(), Limits::min() / 256, T(-1), Limits::infinity(),
      T(1.5e-20), T(-0.0), T(7)};
  std::vector<T> x;
  for (std::size_t i = 0; i < n; ++i)
    x.push_back(ordinary ? T(0.35) + T(1.7) * static_cast<T>(i)
                         : kinds[i % std::size(kinds)] * (i % 7 == 0 ? T(1.25) : T(1)));
  return x;
}

template <class T>
std::vector<T> one_by_one(ArrayFunction<T> function, const std::vector<T>& x) {
  std::vector<T> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) function(&x[i], &y[i], 1);
  return y;
}

// Within the promise of each other's exact value where places matter, else the same bits.
template <class T>
bool agree(const NamedRoot<T>& root, const std::vector<T>& x, const std::vector<T>& y,
           const std::vector<T>& expected) {
  if (!root.depends_on_place()) return first_difference(y, expected) == y.size();
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (same_bits(y[i], expected[i])) continue;
    Worst worst;
    measure<T>({x[i]}, {y[i]}, root.exact, worst);
    if (worst.ulp > root.max_ulp()) return false;
  }
  return true;
}

template <class T>
std::vector<T> contents(GuardedArray<T>& array, std::size_t n) {
  return {array.data(), array.data() + n};
}

// Arrays of one length in one place, for all functions.
template <class T>
struct Arrays {
  GuardedArray<T> in, out, both;

  Arrays(std::size_t n, Place place) : in(n, place), out(n, place), both(n, place) {}
};

template <class T>
void expect_touches_its_elements_only(const NamedRoot<T>& root, Arrays<T>& arrays, bool ordinary) {
  const std::size_t n = arrays.in.size();
  const std::vector<T> x = numbers<T>(n, ordinary);
  const std::vector<T> expected = one_by_one(root.function, x);
  arrays.in.fill(x), arrays.both.fill(x);
  root.function(arrays.in.data(), arrays.out.data(), n);
  root.function(arrays.both.data(), arrays.both.data(), n);
  EXPECT_TRUE(arrays.in.holds(x)) << "input changed";
  EXPECT_TRUE(agree(root, x, contents(arrays.out, n), expected)) << "differs from one by one";
  EXPECT_TRUE(agree(root, x, contents(arrays.both, n), expected)) << "in place differs";
  EXPECT_TRUE(arrays.in.is_intact() && arrays.out.is_intact() && arrays.both.is_intact())
      << "written outside";
}

std::vector<std::size_t> lengths_for(std::size_t lanes) {
  std::vector<std::size_t> lengths;
  for (std::size_t n = 0; n <= 3 * lanes + 1; ++n) lengths.push_back(n);
  // Blocks have up to ten registers: around one and two of them.
  for (std::size_t registers = 4; registers <= 21; ++registers)
    for (const std::size_t rest : {std::size_t{0}, std::size_t{1}, lanes - 1})
      lengths.push_back(registers * lanes + rest);
  return lengths;
}

template <class T>
class RootArrays : public ::testing::Test {};
using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(RootArrays, Numbers);

TYPED_TEST(RootArrays, of_any_length_and_alignment_touch_their_elements_only) {
  using T = TypeParam;
  for (const Path* path : supported_paths()) {
    const std::vector<NamedRoot<T>> roots = roots_of<T>(*path);
    const std::size_t lanes = std::max<std::size_t>(static_cast<std::size_t>(path->lanes) * 4 / sizeof(T), 1);
    // Emulated, each function gets a seventh of the lengths, and each length some functions.
    const std::size_t step = quick() ? 7 : 1;
    std::size_t turn = 0;
    for (const std::size_t n : lengths_for(lanes))
      // Flush with the rear guard the address is an element more off an aligned one as n grows.
      for (const Place place : {Place::before_guard, Place::after_guard}) {
        Arrays<T> arrays(n, place);
        for (std::size_t r = ++turn % step; r < roots.size(); r += step)
          for (const bool ordinary : {false, true}) {
            SCOPED_TRACE(roots[r].name + ", n = " + std::to_string(n));
            expect_touches_its_elements_only(roots[r], arrays, ordinary);
          }
      }
  }
}

TYPED_TEST(RootArrays, do_not_depend_on_neighbours_or_place_unless_they_say_so) {
  using T = TypeParam;
  for (const NamedRoot<T>& root : all_roots<T>()) {
    if (root.depends_on_place()) continue;
    std::vector<T> ordinary = numbers<T>(1000, true);
    if (root.is_reciprocal())
      for (std::size_t i = 0; i < ordinary.size(); i += 3) ordinary[i] = -ordinary[i];
    std::vector<T> disturbed = ordinary;
    for (std::size_t i = 0; i < disturbed.size(); i += 13)
      disturbed[i] = i % 2 == 0 ? std::numeric_limits<T>::quiet_NaN() : T(-0.0);
    const std::vector<T> y = results(root.function, ordinary), z = results(root.function, disturbed);
    for (std::size_t i = 0; i < y.size(); ++i) {
      if (i % 13 == 0) continue;
      ASSERT_TRUE(same_bits(y[i], z[i])) << root.name << " element " << i;
    }
    EXPECT_EQ(first_difference(y, one_by_one(root.function, ordinary)), y.size()) << root.name;
  }
}

// Ordinary numbers, from the 700th on a zero in so many places, and the other special values in so many.
template <class T>
std::vector<T> with_specials(std::size_t n, std::size_t zeros_every, std::size_t others_every) {
  using Limits = std::numeric_limits<T>;
  const T others[] = {Limits::quiet_NaN(), Limits::infinity(),  -Limits::infinity(), T(-3),
                      Limits::min() / 256, -Limits::min() / 256};
  std::vector<T> x = numbers<T>(n, true);
  for (std::size_t i = 700; i < n; i += zeros_every) x[i] = i % 3 == 0 ? T(-0.0) : T(0);
  for (std::size_t i = others_every; i < n; i += others_every)
    x[i] = others[i / others_every % std::size(others)];
  return x;
}

template <class T>
std::size_t wrong_specials(const NamedRoot<T>& root, const std::vector<T>& x, const std::vector<T>& y) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    wrong += (x[i] == T(0) || !std::isfinite(x[i])) && !same_bits(y[i], ieee(root, x[i])) ? 1u : 0u;
  return wrong;
}

// Blocks with zeros are taken in another way than those without, blocks with other special values in a third, and so
// are some blocks behind each of them.
TYPED_TEST(RootArrays, serve_zeros_and_what_else_is_special_among_them) {
  using T = TypeParam;
  constexpr std::size_t n = 12000;
  for (const std::size_t zeros_every : {1u, 5u, 1000u})
    for (const std::size_t others_every : {std::size_t{2999}, n}) {
      const std::vector<T> x = with_specials<T>(n, zeros_every, others_every);
      for (const NamedRoot<T>& root : all_roots<T>()) {
        if (root.promise->unchecked) continue;
        const std::vector<T> y = results(root.function, x);
        EXPECT_TRUE(agree(root, x, y, one_by_one(root.function, x)))
            << root.name << ", a zero every " << zeros_every;
        EXPECT_EQ(wrong_specials(root, x, y), 0u) << root.name << ", a zero every " << zeros_every;
      }
    }
}

TYPED_TEST(RootArrays, leave_rounding_and_flush_modes_alone) {
  using T = TypeParam;
  const std::vector<T> x = numbers<T>(370, false);
  for (const FloatMode mode : float_modes)
    for (const NamedRoot<T>& root : all_roots<T>()) {
      SCOPED_TRACE(root.name);
      const FloatModeScope scope(mode);
      results(root.function, x);
    }
}

// With subnormals off.
template <class T>
std::vector<T> flushed_results(const NamedRoot<T>& root, const std::vector<T>& x) {
  const FloatModeScope scope(FloatMode::flush);
  return results(root.function, x);
}

// With subnormals off, those are zeros, and nothing else changes.
TYPED_TEST(RootArrays, with_subnormals_off_take_them_as_zero) {
  using T = TypeParam;
  std::vector<T> x = numbers<T>(300, true);
  for (std::size_t i = 0; i < x.size(); i += 5)
    x[i] = std::numeric_limits<T>::min() * (T(0.25) + static_cast<T>(i) / T(1000));
  std::vector<T> zeroed = x;
  for (std::size_t i = 0; i < x.size(); i += 5) zeroed[i] = 0;
  for (const NamedRoot<T>& root : all_roots<T>()) {
    if (root.depends_on_place()) continue;
    const std::vector<T> expected = results(root.function, zeroed), y = flushed_results(root, x);
    EXPECT_EQ(first_difference(y, expected), y.size()) << root.name;
  }
}

// The least normal numbers are no subnormals, and no method's way to their roots leads through any.
TYPED_TEST(RootArrays, with_subnormals_off_keep_the_roots_of_the_least_normal_numbers) {
  using T = TypeParam;
  std::vector<T> x;
  for (int i = 0; i < 496; ++i)
    x.push_back(std::numeric_limits<T>::min() * (T(1) + static_cast<T>(i) / T(16)));
  for (const NamedRoot<T>& root : all_roots<T>()) {
    const std::vector<T> expected = results(root.function, x), y = flushed_results(root, x);
    EXPECT_EQ(first_difference(y, expected), y.size()) << root.name;
  }
}

}  // namespace
}  // namespace raylanes::testing
