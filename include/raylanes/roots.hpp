// Square roots, reciprocal square roots and reciprocals of arrays, by accuracy or by method.
#pragma once

#include <limits>
#include <span>

#include <raylanes/paths.hpp>
#include <raylanes/root_methods.hpp>
#include <raylanes/short_arrays.hpp>

namespace raylanes {

// All calls here:
// - x and y have the same size, which may be 0, and are the same array or do not overlap. They need the alignment of
//   their number.
// - NaN, infinities, zeros and negative numbers give what IEEE 754 says for the exact operation.
// - `path` is an ISA path that this machine supports; null: the active one. Few numbers take instructions that do not
//   depend on it.
// - Throws std::invalid_argument, before writing anything, if the sizes differ, the accuracy or method does not exist
//   or is not offered, or this machine lacks the path; throws as active_path() does if `path` is null.

/// Computes y[i] = √x[i] within the bound of `accuracy`, by the fastest method measured on the ISA path.
/// Below Accuracy::correctly_rounded, bits may depend on the position in the array, its size and the processor; the
/// bound holds everywhere.
void sqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path);
/// Computes y[i] = √x[i] of doubles within the bound of `accuracy`.
void sqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path);
/// Computes y[i] = 1/√x[i] within the bound of `accuracy`.
void rsqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path);
/// Computes y[i] = 1/√x[i] of doubles within the bound of `accuracy`. Accuracy::correctly_rounded is not offered:
/// nothing proves it.
void rsqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path);
/// Computes y[i] = 1/x[i] within the bound of `accuracy`.
void reciprocal(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path);
/// Computes y[i] = 1/x[i] of doubles within the bound of `accuracy`.
void reciprocal(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path);

// The same calls on the active path. Few numbers, up to 64 floats if the caller is compiled for AVX2, take instructions
// that <raylanes/short_arrays.hpp> inlines: a short array costs what a loop in its place costs. The path does not
// matter to them: nothing is thrown if RAYLANES_PATH is wrong.
inline namespace RAYLANES_SHORT_ARRAYS {

/// Computes y[i] = √x[i] within the bound of `accuracy`, on the active path.
inline void sqrt(std::span<const float> x, std::span<float> y,
                 Accuracy accuracy = Accuracy::correctly_rounded) {
  if (!few::sqrt_of_few(x, y, accuracy)) sqrt(x, y, accuracy, nullptr);
}
/// Computes y[i] = √x[i] within the bound of `accuracy`, on the active path.
inline void sqrt(std::span<const double> x, std::span<double> y,
                 Accuracy accuracy = Accuracy::correctly_rounded) {
  if (!few::sqrt_of_few(x, y, accuracy)) sqrt(x, y, accuracy, nullptr);
}
/// Computes y[i] = 1/√x[i] within the bound of `accuracy`, on the active path.
inline void rsqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy = Accuracy::within_1_ulp) {
  if (!few::rsqrt_of_few(x, y, accuracy)) rsqrt(x, y, accuracy, nullptr);
}
/// Computes y[i] = 1/√x[i] within the bound of `accuracy`, on the active path.
inline void rsqrt(std::span<const double> x, std::span<double> y,
                  Accuracy accuracy = Accuracy::within_1_ulp) {
  if (!few::rsqrt_of_few(x, y, accuracy)) rsqrt(x, y, accuracy, nullptr);
}
/// Computes y[i] = 1/x[i] within the bound of `accuracy`, on the active path.
inline void reciprocal(std::span<const float> x, std::span<float> y,
                       Accuracy accuracy = Accuracy::correctly_rounded) {
  if (!few::reciprocal_of_few(x, y, accuracy)) reciprocal(x, y, accuracy, nullptr);
}
/// Computes y[i] = 1/x[i] within the bound of `accuracy`, on the active path.
inline void reciprocal(std::span<const double> x, std::span<double> y,
                       Accuracy accuracy = Accuracy::correctly_rounded) {
  if (!few::reciprocal_of_few(x, y, accuracy)) reciprocal(x, y, accuracy, nullptr);
}

}  // namespace RAYLANES_SHORT_ARRAYS

namespace detail {
Accuracy accuracy_within(double relative_error, double epsilon);
}  // namespace detail

/// Returns the loosest accuracy that keeps results of type T, float or double, within the relative error.
/// An error of n ULP is at most n times the T's epsilon. The calls then take the fastest method that keeps it.
/// Throws std::invalid_argument if no accuracy does: the least error is that of rounding, epsilon / 2.
template <class T>
Accuracy accuracy_within(double relative_error) {
  return detail::accuracy_within(relative_error, double{std::numeric_limits<T>::epsilon()});
}

/// Computes y[i] = √x[i] by `method`.
void sqrt(std::span<const float> x, std::span<float> y, SqrtMethod method, const Path* path = nullptr);
/// Computes y[i] = √x[i] of doubles by `method`.
void sqrt(std::span<const double> x, std::span<double> y, DoubleSqrtMethod method,
          const Path* path = nullptr);
/// Computes y[i] = 1/√x[i] by `method`.
void rsqrt(std::span<const float> x, std::span<float> y, RsqrtMethod method, const Path* path = nullptr);
/// Computes y[i] = 1/√x[i] of doubles by `method`.
void rsqrt(std::span<const double> x, std::span<double> y, DoubleRsqrtMethod method,
           const Path* path = nullptr);
/// Computes y[i] = 1/x[i] by `method`.
void reciprocal(std::span<const float> x, std::span<float> y, ReciprocalMethod method,
                const Path* path = nullptr);
/// Computes y[i] = 1/x[i] of doubles by `method`.
void reciprocal(std::span<const double> x, std::span<double> y, DoubleReciprocalMethod method,
                const Path* path = nullptr);

}  // namespace raylanes
