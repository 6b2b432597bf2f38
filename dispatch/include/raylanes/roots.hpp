// Square roots for users: arrays of any length by the path in use, chosen by what the result must keep.
#pragma once

#include <span>

#include <raylanes/root_methods.hpp>

namespace raylanes {

// y[i] = sqrt(x[i]) within the bound of `grade`, by the method that is the fastest measured for it on the
// path in use (SquareRootKernels::sqrt_of_grade). x and y have the same size and are the same array or do not
// overlap; 0 elements are allowed; no alignment is needed. Special values as in IEEE 754. In the grades below
// correctly_rounded a value's result may depend on its place in the array; the bound holds for every place.
// Throws std::invalid_argument if the sizes differ or the grade is none, and as active_path does.
void sqrt(std::span<const float> x, std::span<float> y, SqrtGrade grade);
void sqrt(std::span<const double> x, std::span<double> y, SqrtGrade grade);

// The same by a method of your choice, by its name in sqrt_methods, rsqrt_methods, reciprocal_methods or
// double_sqrt_methods.
void sqrt(std::span<const float> x, std::span<float> y, SqrtMethod method);
void sqrt(std::span<const double> x, std::span<double> y, DoubleSqrtMethod method);
void rsqrt(std::span<const float> x, std::span<float> y, RsqrtMethod method);
void reciprocal(std::span<const float> x, std::span<float> y, ReciprocalMethod method);

}  // namespace raylanes
