#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>

#include "checked.hpp"
#include "table.hpp"

namespace raylanes {
namespace {

template <class T, class Function, std::size_t Count, class Method>
void run(const char* function, const Function (&methods)[Count], Method method, std::span<const T> x,
         std::span<T> y) {
  require_size(function, "y", y.size(), "x", x.size());
  checked_row(function, "method", methods, method)(x.data(), y.data(), x.size());
}

}  // namespace

void sqrt(std::span<const float> x, std::span<float> y, SqrtGrade grade) {
  const SquareRootKernels& roots = active_path().kernels.roots;
  run("sqrt", roots.sqrt, checked_row("sqrt", "grade", roots.sqrt_of_grade, grade), x, y);
}
void sqrt(std::span<const double> x, std::span<double> y, SqrtGrade grade) {
  const SquareRootKernels& roots = active_path().kernels.roots;
  run("sqrt", roots.sqrt_double, checked_row("sqrt", "grade", roots.double_sqrt_of_grade, grade), x, y);
}
void sqrt(std::span<const float> x, std::span<float> y, SqrtMethod method) {
  run("sqrt", active_path().kernels.roots.sqrt, method, x, y);
}
void sqrt(std::span<const double> x, std::span<double> y, DoubleSqrtMethod method) {
  run("sqrt", active_path().kernels.roots.sqrt_double, method, x, y);
}
void rsqrt(std::span<const float> x, std::span<float> y, RsqrtMethod method) {
  run("rsqrt", active_path().kernels.roots.rsqrt, method, x, y);
}
void reciprocal(std::span<const float> x, std::span<float> y, ReciprocalMethod method) {
  run("reciprocal", active_path().kernels.roots.reciprocal, method, x, y);
}

}  // namespace raylanes
