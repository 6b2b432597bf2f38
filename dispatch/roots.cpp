#include <stdexcept>
#include <string>

#include <raylanes/paths.hpp>
#include <raylanes/roots.hpp>

#include "table.hpp"

namespace raylanes {
namespace {

void require_same_size(const char* function, std::size_t x, std::size_t y) {
  if (x != y)
    throw std::invalid_argument(std::string(function) + ": x has " + std::to_string(x) + " elements, y has " +
                                std::to_string(y) + "; they must have the same number");
}

// The element of a row of the table, for an enumerator that may have been cast from anything.
template <class Entry, std::size_t Count, class Enumerator>
Entry entry_of(const char* function, const char* what, const Entry (&entries)[Count], Enumerator enumerator) {
  const auto index = static_cast<std::size_t>(enumerator);
  if (index >= Count)
    throw std::invalid_argument(std::string(function) + ": " + what + ' ' + std::to_string(index) +
                                " does not exist; allowed are 0 to " + std::to_string(Count - 1));
  return entries[index];
}

template <class T, class Function, std::size_t Count, class Method>
void run(const char* function, const Function (&methods)[Count], Method method, std::span<const T> x,
         std::span<T> y) {
  require_same_size(function, x.size(), y.size());
  entry_of(function, "method", methods, method)(x.data(), y.data(), x.size());
}

}  // namespace

void sqrt(std::span<const float> x, std::span<float> y, SqrtGrade grade) {
  const SquareRootKernels& roots = active_path().kernels.roots;
  run("sqrt", roots.sqrt, entry_of("sqrt", "grade", roots.sqrt_of_grade, grade), x, y);
}
void sqrt(std::span<const double> x, std::span<double> y, SqrtGrade grade) {
  const SquareRootKernels& roots = active_path().kernels.roots;
  run("sqrt", roots.sqrt_double, entry_of("sqrt", "grade", roots.double_sqrt_of_grade, grade), x, y);
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
