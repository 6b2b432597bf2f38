#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>

#include "checked.hpp"
#include "table.hpp"

namespace raylanes {
namespace {

template <class T, class Method, std::size_t Count>
void run(const char* function, const RootRows<T, Method, Count>& rows, Method method, std::span<const T> x,
         std::span<T> y) {
  require_size(function, "y", y.size(), "x", x.size());
  checked_row(function, "method", rows.by, method)(x.data(), y.data(), x.size());
}

// By the method that serves the accuracy.
template <class T, class Method, std::size_t Count>
void run(const char* function, const RootRows<T, Method, Count>& rows, Accuracy accuracy,
         std::span<const T> x, std::span<T> y) {
  run(function, rows, checked_row(function, "accuracy", rows.within, accuracy), x, y);
}

const RootKernels& roots_of(const Path* path) {
  return checked_path(path).kernels.roots;
}

}  // namespace

void sqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy, const Path* path) {
  run("sqrt", roots_of(path).sqrt, accuracy, x, y);
}
void sqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy, const Path* path) {
  run("sqrt", roots_of(path).double_sqrt, accuracy, x, y);
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
  run("sqrt", roots_of(path).sqrt, method, x, y);
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
