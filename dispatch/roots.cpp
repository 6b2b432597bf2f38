#include "table/roots.hpp"

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>

#include "checked.hpp"
#include "hardest_roots.hpp"
#include "table/kernel_table.hpp"

namespace raylanes {
namespace {

// Whether Goldschmidt's root is the instruction's for all of them.
bool are_right(const RootKernels& roots) {
  constexpr std::size_t count = std::size(hardest_roots);
  float own[count], correct[count];
  roots.sqrt.by[static_cast<std::size_t>(SqrtMethod::goldschmidt)](hardest_roots, own, count);
  roots.sqrt.by[static_cast<std::size_t>(SqrtMethod::hardware)](hardest_roots, correct, count);
  for (std::size_t i = 0; i < count; ++i)
    if (std::bit_cast<std::uint32_t>(own[i]) != std::bit_cast<std::uint32_t>(correct[i])) return false;
  return true;
}

template <class T>
void run(const char* function, ArrayFunction<T> roots, std::span<const T> x, std::span<T> y) {
  require_size(function, "y", y.size(), "x", x.size());
  roots(x.data(), y.data(), x.size());
}

template <class T, class Method, std::size_t Count>
void run(const char* function, const RootRows<T, Method, Count>& rows, Method method, std::span<const T> x,
         std::span<T> y) {
  run(function, checked_row(function, "method", rows.by, method), x, y);
}

// By the method that serves the accuracy.
template <class T, class Method, std::size_t Count>
void run(const char* function, const RootRows<T, Method, Count>& rows, Accuracy accuracy,
         std::span<const T> x, std::span<T> y) {
  run(function, rows, checked_row(function, "accuracy", rows.within, accuracy), x, y);
}

// By the method, in the mix that suits the machine.
void run_sqrt(const RootKernels& roots, SqrtMethod method, std::span<const float> x, std::span<float> y) {
  const SqrtMethod kept = kept_method(roots, method);
  const bool splits = roots.sqrt_in_two_passes != nullptr && machine_splits_512_bits();
  run("sqrt", fastest_sqrt(roots, kept, splits), x, y);
}

// Arrays of so few numbers go through the instruction, with every accuracy, before they would reach a kernel.
constexpr std::size_t short_array = 16;

template <std::size_t count, class T>
std::array<T, count> instruction_roots(const T* x) {
  std::array<T, count> roots;
  for (std::size_t i = 0; i < count; ++i) roots[i] = std::sqrt(x[i]);
  return roots;
}

// From count to 2·count of them: the first and the last, which may be the same. y may be x.
template <std::size_t count, class T>
void store_instruction_roots(const T* x, T* y, std::size_t n) {
  const auto first = instruction_roots<count>(x), last = instruction_roots<count>(x + n - count);
  std::memcpy(y, first.data(), sizeof first);
  std::memcpy(y + n - count, last.data(), sizeof last);
}

// Whether the arrays are short: then y has the roots.
template <class T>
bool sqrt_of_short(std::span<const T> x, std::span<T> y) {
  const std::size_t n = x.size();
  require_size("sqrt", "y", y.size(), "x", n);
  if (n > short_array) return false;
  if (n > 8)
    store_instruction_roots<8>(x.data(), y.data(), n);
  else if (n >= 4)
    store_instruction_roots<4>(x.data(), y.data(), n);
  else if (n >= 2)
    store_instruction_roots<2>(x.data(), y.data(), n);
  else if (n == 1)
    y[0] = std::sqrt(x[0]);
  return true;
}

const RootKernels& roots_of(const Path* path) {
  return kernels_of(checked_path(path)).roots;
}

}  // namespace

SqrtMethod kept_method(const RootKernels& roots, SqrtMethod method) {
  if (method != SqrtMethod::goldschmidt && method != SqrtMethod::goldschmidt_beside_hardware) return method;
  static std::atomic<const RootKernels*> known_right{nullptr};
  if (known_right.load(std::memory_order_relaxed) == &roots) return method;
  if (!are_right(roots)) return SqrtMethod::hardware;
  known_right.store(&roots, std::memory_order_relaxed);
  return method;
}

ArrayFunction<float> fastest_sqrt(const RootKernels& roots, SqrtMethod method, bool splits_512_bits) {
  const ArrayFunction<float> usual = checked_row("sqrt", "method", roots.sqrt.by, method);
  const bool has_choice =
      method == SqrtMethod::goldschmidt_beside_hardware && roots.sqrt_in_two_passes != nullptr;
  return has_choice && splits_512_bits ? roots.sqrt_in_two_passes : usual;
}

SqrtMethod serving_sqrt(const RootKernels& roots, Accuracy accuracy, bool splits_512_bits) {
  const SqrtMethod usual = checked_row("sqrt", "accuracy", roots.sqrt.within, accuracy);
  const bool has_faster =
      usual == SqrtMethod::estimate_two_residuals_beside_hardware && roots.sqrt_in_two_passes != nullptr;
  return has_faster && splits_512_bits ? SqrtMethod::goldschmidt_beside_hardware : usual;
}

namespace {

// Out of line: short arrays need not save registers for it.
[[gnu::noinline]] void sqrt_within(const RootKernels& roots, Accuracy accuracy, std::span<const float> x,
                                   std::span<float> y) {
  run_sqrt(roots, serving_sqrt(roots, accuracy, machine_splits_512_bits()), x, y);
}

}  // namespace

void sqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path) {
  const RootKernels& roots = roots_of(path);
  checked_row("sqrt", "accuracy", roots.sqrt.within, accuracy);
  if (!sqrt_of_short(x, y)) sqrt_within(roots, accuracy, x, y);
}
void sqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path) {
  const auto& rows = roots_of(path).double_sqrt;
  const DoubleSqrtMethod method = checked_row("sqrt", "accuracy", rows.within, accuracy);
  if (!sqrt_of_short(x, y)) run("sqrt", rows, method, x, y);
}
void rsqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path) {
  run("rsqrt", roots_of(path).rsqrt, accuracy, x, y);
}
void rsqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path) {
  if (accuracy == Accuracy::correctly_rounded)
    throw std::invalid_argument(
        "rsqrt: accuracy correctly_rounded is not offered for double; the tightest is within_1_ulp");
  run("rsqrt", roots_of(path).double_rsqrt, accuracy, x, y);
}
void reciprocal(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path) {
  run("reciprocal", roots_of(path).reciprocal, accuracy, x, y);
}
void reciprocal(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path) {
  run("reciprocal", roots_of(path).double_reciprocal, accuracy, x, y);
}

void sqrt(std::span<const float> x, std::span<float> y, SqrtMethod method, const Path* path) {
  run_sqrt(roots_of(path), method, x, y);
}
void sqrt(std::span<const double> x, std::span<double> y, DoubleSqrtMethod method, const Path* path) {
  run("sqrt", roots_of(path).double_sqrt, method, x, y);
}
void rsqrt(std::span<const float> x, std::span<float> y, RsqrtMethod method, const Path* path) {
  run("rsqrt", roots_of(path).rsqrt, method, x, y);
}
void rsqrt(std::span<const double> x, std::span<double> y, DoubleRsqrtMethod method, const Path* path) {
  run("rsqrt", roots_of(path).double_rsqrt, method, x, y);
}
void reciprocal(std::span<const float> x, std::span<float> y, ReciprocalMethod method, const Path* path) {
  run("reciprocal", roots_of(path).reciprocal, method, x, y);
}
void reciprocal(std::span<const double> x, std::span<double> y, DoubleReciprocalMethod method,
                const Path* path) {
  run("reciprocal", roots_of(path).double_reciprocal, method, x, y);
}

}  // namespace raylanes
