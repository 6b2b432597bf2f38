// What the tests of square roots share: rows of the table by name, inputs, and errors against double.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "../../dispatch/table.hpp"
#include "../support/estimate_fault.hpp"

namespace raylanes::testing {

inline constexpr std::uint32_t least_normal = 0x00800000, infinity_bits = 0x7f800000;

inline float from_bits(std::uint64_t bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
}
inline std::uint32_t to_bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

// RAYLANES_EXHAUSTIVE=1: all 2^32 inputs where otherwise a sample is tested.
inline bool exhaustive() {
  const char* value = std::getenv("RAYLANES_EXHAUSTIVE");
  return value != nullptr && std::string_view(value) == "1";
}

// One function of a path's table with its promise and what it approximates.
struct NamedRoot {
  std::string name;  // path, function and method
  const Path* path;
  const RootMethod* promise;
  FloatArrayFunction function;
  double (*exact)(double);

  double max_ulp() const { return path->has_fma() ? promise->max_ulp : promise->max_ulp_without_fma; }
  // Results may depend on the place of a value in the array.
  bool depends_on_place() const {
    return !promise->reproducible && promise->name.ends_with("_beside_hardware");
  }
};

inline double exact_root(double a) {
  return std::sqrt(a);
}
inline double exact_reciprocal_root(double a) {
  return 1.0 / std::sqrt(a);
}
inline double exact_reciprocal(double a) {
  return 1.0 / a;
}

inline std::vector<NamedRoot> roots_of(const Path& path) {
  std::vector<NamedRoot> list;
  const auto add = [&](const char* function, const auto& methods, const auto& functions, auto exact) {
    for (std::size_t m = 0; m < methods.size(); ++m)
      list.push_back({std::string(path.name) + ' ' + function + ' ' + std::string(methods[m].name), &path,
                      &methods[m], functions[m], exact});
  };
  add("sqrt", sqrt_methods, path.kernels.roots.sqrt, exact_root);
  add("rsqrt", rsqrt_methods, path.kernels.roots.rsqrt, exact_reciprocal_root);
  add("reciprocal", reciprocal_methods, path.kernels.roots.reciprocal, exact_reciprocal);
  return list;
}

inline std::vector<NamedRoot> all_roots() {
  std::vector<NamedRoot> list;
  for (const Path* path : supported_paths())
    for (NamedRoot& root : roots_of(*path)) list.push_back(std::move(root));
  return list;
}

inline std::vector<float> results(FloatArrayFunction function, const std::vector<float>& x) {
  std::vector<float> y(x.size());
  function(x.data(), y.data(), x.size());
  return y;
}

inline bool same_bits(float a, float b) {
  return to_bits(a) == to_bits(b) || (a != a && b != b);  // NaN is NaN
}

// Index of the first element whose bits differ, or the size.
inline std::size_t first_difference(const std::vector<float>& a, const std::vector<float>& b) {
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), same_bits).first - a.begin());
}

struct Worst {
  double ulp = 0, relative = 0;
};

// Errors in units of the last place of the binade of the exact result, which is normal; NaN counts as
// infinitely wrong.
inline void measure_one(float y, double exact, Worst& worst) {
  const double error = std::abs(static_cast<double>(y) - exact), size = std::abs(exact);
  // Nearly always; an ULP is 2^-24 of the result at least.
  if (error <= worst.relative * size && error * 0x1p24 <= worst.ulp * size) return;
  const double ulp = std::ldexp(error, 23 - std::ilogb(exact)), relative = error / size;
  worst.ulp = std::isnan(ulp) ? HUGE_VAL : std::max(ulp, worst.ulp);
  worst.relative = std::isnan(ulp) ? HUGE_VAL : std::max(relative, worst.relative);
}
inline void measure(const std::vector<float>& x, const std::vector<float>& y, double (*exact)(double),
                    Worst& worst) {
  for (std::size_t i = 0; i < x.size(); ++i) measure_one(y[i], exact(static_cast<double>(x[i])), worst);
}

// `check` gets bit patterns in blocks: all of them, or every 251st and all near the borders of binades, where
// the mantissa is 0, and those of the special values lie.
template <class Check>
void sweep(Check check) {
  constexpr std::size_t block = 1 << 13;  // in and out fit the second-level cache
  std::vector<float> x;
  x.reserve(block);
  const bool no_powers = has_wrong_estimates();
  const auto add = [&](std::uint64_t bits) {
    const bool power = bits % least_normal == 0 && bits > 0 && bits < infinity_bits;
    if (!(power && no_powers)) x.push_back(from_bits(bits));
    if (x.size() == block) check(x), x.clear();
  };
  const std::uint64_t step = exhaustive() ? 1 : (quick() ? 65521 : 251);
  for (std::uint64_t bits = 0; bits < 0x100000000; bits += step) add(bits);
  const std::uint64_t reach = exhaustive() ? 0 : (quick() ? 4 : 0x1000);
  for (std::uint64_t border = 0; reach > 0 && border <= 0x100000000; border += least_normal)
    for (std::uint64_t offset = 0; offset < 2 * reach; ++offset) add(border - reach + offset);
  check(x);
}

}  // namespace raylanes::testing
