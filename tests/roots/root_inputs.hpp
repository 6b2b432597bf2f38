// Helpers that the tests of roots share: rows of the table by name, inputs, and errors against wider numbers.
#pragma once

#include "../../dispatch/table/kernel_table.hpp"
#include "../../dispatch/table/roots.hpp"
#include "../support/testing.hpp"
#include "../support/supported_paths.hpp"

namespace raylanes::testing {

inline constexpr std::uint32_t min_normal = 0x00800000, infinity_bits = 0x7f800000;

inline float from_bits(std::uint64_t bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
}
inline std::uint32_t to_bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

// In what exact results are computed: 29 and 11 bits more.
template <class T>
using Wider = std::conditional_t<sizeof(T) == 4, double, long double>;

template <class W>
W exact_root(W a) {
  return std::sqrt(a);
}
template <class W>
W exact_reciprocal_root(W a) {
  return W(1) / std::sqrt(a);
}
template <class W>
W exact_reciprocal(W a) {
  return W(1) / a;
}

// One function of a path's table with its promise and what it approximates.
template <class T>
struct NamedRoot {
  std::string name;  // path, function and method
  const Path* path;
  const RootPromise* promise;
  ArrayFunction<T> function;
  Wider<T> (*exact)(Wider<T>);

  double max_ulp() const { return path->has_fma() ? promise->max_ulp : promise->max_ulp_without_fma; }
  bool is_sqrt() const { return exact == exact_root<Wider<T>>; }
  bool is_reciprocal() const { return exact == exact_reciprocal<Wider<T>>; }
  // Results may depend on the place of a value in the array.
  bool depends_on_place() const {
    return !promise->reproducible && promise->name.ends_with("_beside_hardware");
  }
};

template <class T>
std::vector<NamedRoot<T>> roots_of(const Path& path) {
  std::vector<NamedRoot<T>> list;
  const auto add = [&](const char* function, const auto& methods, const auto& rows, auto exact) {
    for (std::size_t m = 0; m < methods.size(); ++m)
      list.push_back({std::string(path.name) + ' ' + function + ' ' + std::string(methods[m].promise.name),
                      &path, &methods[m].promise, rows.by[m], exact});
  };
  const RootKernels& roots = kernels_of(path).roots;
  if constexpr (sizeof(T) == 4) {
    add("sqrt", sqrt_methods, roots.sqrt, exact_root<Wider<T>>);
    add("rsqrt", rsqrt_methods, roots.rsqrt, exact_reciprocal_root<Wider<T>>);
    add("reciprocal", reciprocal_methods, roots.reciprocal, exact_reciprocal<Wider<T>>);
    if (roots.sqrt_in_two_passes != nullptr)
      list.push_back(
          {std::string(path.name) + " sqrt in two passes", &path,
           &sqrt_methods[static_cast<std::size_t>(SqrtMethod::goldschmidt_beside_hardware)].promise,
           roots.sqrt_in_two_passes, exact_root<Wider<T>>});
  } else {
    add("double sqrt", double_sqrt_methods, roots.double_sqrt, exact_root<Wider<T>>);
    add("double rsqrt", double_rsqrt_methods, roots.double_rsqrt, exact_reciprocal_root<Wider<T>>);
    add("double reciprocal", double_reciprocal_methods, roots.double_reciprocal, exact_reciprocal<Wider<T>>);
  }
  return list;
}

template <class T>
std::vector<NamedRoot<T>> all_roots() {
  std::vector<NamedRoot<T>> list;
  for (const Path* path : supported_paths())
    for (NamedRoot<T>& root : roots_of<T>(*path)) list.push_back(std::move(root));
  return list;
}

template <class T>
std::vector<T> results(ArrayFunction<T> function, const std::vector<T>& x) {
  std::vector<T> y(x.size());
  function(x.data(), y.data(), x.size());
  return y;
}

// IEEE 754 for everything that is no normal number or has no root, whatever the method.
template <class T>
T ieee(const NamedRoot<T>& root, T a) {
  if (root.is_reciprocal()) return T(1) / a;
  return root.is_sqrt() ? std::sqrt(a) : T(1) / std::sqrt(a);
}

template <class T>
bool same_bits(T a, T b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (a != a && b != b);  // NaN is NaN
}

// Index of the first element whose bits differ, or the size.
template <class T>
std::size_t first_difference(const std::vector<T>& a, const std::vector<T>& b) {
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), same_bits<T>).first -
                                  a.begin());
}

struct Worst {
  double ulp = 0, relative = 0;
};

// Errors in units of the last place of the binade of the exact result, which is normal; NaN counts as infinitely
// wrong.
template <class T>
void measure_one(T y, Wider<T> exact, Worst& worst) {
  const double error = static_cast<double>(std::abs(static_cast<Wider<T>>(y) - exact));
  const double size = static_cast<double>(std::abs(exact));
  constexpr int digits = std::numeric_limits<T>::digits;
  // Nearly always; an ULP is 2^-digits of the result at least.
  if (error <= worst.relative * size && std::ldexp(error, digits) <= worst.ulp * size) return;
  const double ulp = std::ldexp(error, digits - 1 - std::ilogb(exact)), relative = error / size;
  worst.ulp = std::isnan(ulp) ? HUGE_VAL : std::max(ulp, worst.ulp);
  worst.relative = std::isnan(ulp) ? HUGE_VAL : std::max(relative, worst.relative);
}
template <class T>
void measure(const std::vector<T>& x, const std::vector<T>& y, Wider<T> (*exact)(Wider<T>), Worst& worst) {
  for (std::size_t i = 0; i < x.size(); ++i) measure_one(y[i], exact(static_cast<Wider<T>>(x[i])), worst);
}

// `check` gets bit patterns in blocks: all of them, or every 251st and all near the borders of binades, where
// the mantissa is 0, and where the special values lie.
template <class Check>
void sweep(Check check) {
  constexpr std::size_t block = 1 << 13;  // in and out fit the second-level cache
  std::vector<float> x;
  x.reserve(block);
  const auto add = [&](std::uint64_t bits) {
    x.push_back(from_bits(bits));
    if (x.size() == block) check(x), x.clear();
  };
  const std::uint64_t step = exhaustive() ? 1 : (quick() ? 65521 : 251);
  for (std::uint64_t bits = 0; bits < 0x100000000; bits += step) add(bits);
  const std::uint64_t reach = exhaustive() ? 0 : (quick() ? 4 : 0x1000);
  for (std::uint64_t border = 0; reach > 0 && border <= 0x100000000; border += min_normal)
    for (std::uint64_t offset = 0; offset < 2 * reach; ++offset) add(border - reach + offset);
  check(x);
}

}  // namespace raylanes::testing
