#include "table/roots.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

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

Accuracy detail::accuracy_within(double relative_error, double epsilon) {
  // Floats get 1 ULP for 2^-44.
  for (std::size_t i = accuracies.size(); i-- > 0;) {
    const AccuracyInfo& info = accuracies[i];
    const double bound =
        info.max_ulp > 0 ? info.max_ulp * epsilon : std::max(info.max_relative_error, epsilon);
    if (bound <= relative_error) return info.accuracy;
  }
  throw std::invalid_argument("accuracy: a relative error of " + text_of(relative_error) +
                              " is too small; the least is " + text_of(epsilon / 2));
}

void sqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path) {
  const RootKernels& roots = roots_of(path);
  if (few::sqrt_of_few(x, y, accuracy)) return;
  run_sqrt(roots, serving_sqrt(roots, accuracy, machine_splits_512_bits()), x, y);
}
void sqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path) {
  const RootKernels& roots = roots_of(path);
  if (!few::sqrt_of_few(x, y, accuracy)) run("sqrt", roots.double_sqrt, accuracy, x, y);
}
void rsqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path) {
  const RootKernels& roots = roots_of(path);
  if (!few::rsqrt_of_few(x, y, accuracy)) run("rsqrt", roots.rsqrt, accuracy, x, y);
}
void rsqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path) {
  if (accuracy == Accuracy::correctly_rounded)
    throw std::invalid_argument(
        "rsqrt: accuracy correctly_rounded is not offered for double; the tightest is within_1_ulp");
  const RootKernels& roots = roots_of(path);
  if (!few::rsqrt_of_few(x, y, accuracy)) run("rsqrt", roots.double_rsqrt, accuracy, x, y);
}
void reciprocal(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path) {
  const RootKernels& roots = roots_of(path);
  if (!few::reciprocal_of_few(x, y, accuracy)) run("reciprocal", roots.reciprocal, accuracy, x, y);
}
void reciprocal(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path) {
  const RootKernels& roots = roots_of(path);
  if (!few::reciprocal_of_few(x, y, accuracy)) run("reciprocal", roots.double_reciprocal, accuracy, x, y);
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
