// Roots as functions on arrays: lengths, places, what lies around them, modes of the processor.
#include <gtest/gtest.h>
#include <xmmintrin.h>

#include "../support/guarded_array.hpp"
#include "../support/random_input.hpp"
#include "roots.hpp"

namespace raylanes::testing {
namespace {

// Numbers of all kinds, some in each register; or ordinary ones, no powers of two, for which blocks take the
// short way.
std::vector<float> numbers(std::size_t n, bool ordinary) {
  const float kinds[] = {2.0f, 0.0f, 3.7e5f, nan, 1e-41f, -1.0f, infinity, 1.5e-20f, -0.0f, 7.0f};
  std::vector<float> x;
  for (std::size_t i = 0; i < n; ++i)
    x.push_back(ordinary ? 0.35f + 1.7f * static_cast<float>(i)
                         : kinds[i % std::size(kinds)] * (i % 7 == 0 ? 1.25f : 1.0f));
  return x;
}

std::vector<float> one_by_one(FloatArrayFunction function, const std::vector<float>& x) {
  std::vector<float> y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) function(&x[i], &y[i], 1);
  return y;
}

// Within the promise of each other's exact value where places matter, else the same bits.
bool agree(const NamedRoot& root, const std::vector<float>& x, const std::vector<float>& y,
           const std::vector<float>& expected) {
  if (!root.depends_on_place()) return first_difference(y, expected) == y.size();
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (same_bits(y[i], expected[i])) continue;
    Worst worst;
    measure({x[i]}, {y[i]}, root.exact, worst);
    if (worst.ulp > root.max_ulp()) return false;
  }
  return true;
}

std::vector<float> contents(GuardedArray<float>& array, std::size_t n) {
  return {array.data(), array.data() + n};
}

// Arrays of one length in one place, for all functions.
struct Arrays {
  GuardedArray<float> in, out, both;

  Arrays(std::size_t n, Place place) : in(n, place), out(n, place), both(n, place) {}
};

void expect_touches_its_elements_only(const NamedRoot& root, Arrays& arrays, bool ordinary) {
  const std::size_t n = arrays.in.size();
  const std::vector<float> x = numbers(n, ordinary);
  const std::vector<float> expected = one_by_one(root.function, x);
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

TEST(Roots, of_any_length_and_alignment_touch_their_elements_only) {
  for (const Path* path : supported_paths()) {
    const std::vector<NamedRoot> roots = roots_of(*path);
    // Emulated, each function gets a seventh of the lengths, and each length some functions.
    const std::size_t step = quick() ? 7 : 1;
    std::size_t turn = 0;
    for (const std::size_t n : lengths_for(static_cast<std::size_t>(path->lanes)))
      // Flush with the rear guard the address is 0, 4, 8 … bytes off an aligned one as n varies.
      for (const Place place : {Place::before_guard, Place::after_guard}) {
        Arrays arrays(n, place);
        for (std::size_t r = ++turn % step; r < roots.size(); r += step)
          for (const bool ordinary : {false, true}) {
            SCOPED_TRACE(roots[r].name + ", n = " + std::to_string(n));
            expect_touches_its_elements_only(roots[r], arrays, ordinary);
          }
      }
  }
}

TEST(Roots, do_not_depend_on_neighbours_or_place_unless_they_say_so) {
  for (const NamedRoot& root : all_roots()) {
    if (root.depends_on_place()) continue;
    std::vector<float> ordinary = numbers(1000, true);
    if (root.exact == exact_reciprocal)
      for (std::size_t i = 0; i < ordinary.size(); i += 3) ordinary[i] = -ordinary[i];
    std::vector<float> disturbed = ordinary;
    for (std::size_t i = 0; i < disturbed.size(); i += 13) disturbed[i] = i % 2 == 0 ? nan : -0.0f;
    const std::vector<float> y = results(root.function, ordinary), z = results(root.function, disturbed);
    for (std::size_t i = 0; i < y.size(); ++i) {
      if (i % 13 == 0) continue;
      ASSERT_EQ(to_bits(y[i]), to_bits(z[i])) << root.name << " element " << i;
    }
    EXPECT_EQ(first_difference(y, one_by_one(root.function, ordinary)), y.size()) << root.name;
  }
}

constexpr unsigned sticky_flags = 0x3f;  // exceptions, which any arithmetic sets
constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;

TEST(Roots, leave_rounding_and_flush_modes_alone) {
  const unsigned saved = _mm_getcsr();
  const std::vector<float> x = numbers(370, false);
  for (const unsigned mode : {0u, flush_to_zero | denormals_are_zero})
    for (const NamedRoot& root : all_roots()) {
      _mm_setcsr((saved & ~sticky_flags) | mode);
      const unsigned before = _mm_getcsr() & ~sticky_flags;
      results(root.function, x);
      const unsigned after = _mm_getcsr() & ~sticky_flags;
      _mm_setcsr(saved);
      EXPECT_EQ(after, before) << root.name;
    }
}

// With subnormals off, those are zeros, and nothing else changes.
TEST(Roots, with_subnormals_off_take_them_as_zero) {
  const unsigned saved = _mm_getcsr();
  std::vector<float> x = numbers(300, true);
  for (std::size_t i = 0; i < x.size(); i += 5) x[i] = from_bits(0x00300000u | static_cast<unsigned>(i));
  std::vector<float> zeroed = x;
  for (std::size_t i = 0; i < x.size(); i += 5) zeroed[i] = 0.0f;
  for (const NamedRoot& root : all_roots()) {
    if (root.depends_on_place()) continue;
    const std::vector<float> expected = results(root.function, zeroed);
    _mm_setcsr(saved | flush_to_zero | denormals_are_zero);
    const std::vector<float> y = results(root.function, x);
    _mm_setcsr(saved);
    EXPECT_EQ(first_difference(y, expected), y.size()) << root.name;
  }
}

TEST(KernelTable, states_the_lanes_of_its_path) {
  for (const Path* path : supported_paths()) EXPECT_EQ(path->lanes, path->lanes) << path->name;
}

}  // namespace
}  // namespace raylanes::testing
