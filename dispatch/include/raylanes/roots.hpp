// Square roots, reciprocal roots and reciprocals of arrays of any length, by the accuracy that they must keep or by
// a method.
#pragma once

#include <span>

#include <raylanes/paths.hpp>
#include <raylanes/root_methods.hpp>

namespace raylanes {

// y[i] = √x[i], 1/√x[i] or 1/x[i] within the bound of `accuracy`, by the method that is the fastest measured for it
// on the path. x and y have the same size and are the same array or do not overlap; 0 elements are allowed; no
// alignment is needed. Special values as in IEEE 754. Below correctly_rounded a value's result may depend on its
// place in the array, and on the processor; the bound holds for every place.
//
// All accuracies are offered but one: no reciprocal root of a double is correctly rounded (nothing proves it).
//
// `path`: on which path, null for the one in use.
// Throws std::invalid_argument, and leaves y alone, if the sizes differ, if the accuracy or method does not exist or
// is not offered, if this machine lacks the path, and as active_path does.
void sqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy = Accuracy::correctly_rounded,
          const Path* path = nullptr);
void sqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy = Accuracy::correctly_rounded,
          const Path* path = nullptr);
void rsqrt(std::span<const float> x, std::span<float> y, Accuracy accuracy = Accuracy::within_1_ulp,
           const Path* path = nullptr);
void rsqrt(std::span<const double> x, std::span<double> y, Accuracy accuracy = Accuracy::within_1_ulp,
           const Path* path = nullptr);
void reciprocal(std::span<const float> x, std::span<float> y, Accuracy accuracy = Accuracy::correctly_rounded,
                const Path* path = nullptr);
void reciprocal(std::span<const double> x, std::span<double> y,
                Accuracy accuracy = Accuracy::correctly_rounded, const Path* path = nullptr);

// The same by a method of your choice.
void sqrt(std::span<const float> x, std::span<float> y, SqrtMethod method, const Path* path = nullptr);
void sqrt(std::span<const double> x, std::span<double> y, DoubleSqrtMethod method,
          const Path* path = nullptr);
void rsqrt(std::span<const float> x, std::span<float> y, RsqrtMethod method, const Path* path = nullptr);
void rsqrt(std::span<const double> x, std::span<double> y, DoubleRsqrtMethod method,
           const Path* path = nullptr);
void reciprocal(std::span<const float> x, std::span<float> y, ReciprocalMethod method,
                const Path* path = nullptr);
void reciprocal(std::span<const double> x, std::span<double> y, DoubleReciprocalMethod method,
                const Path* path = nullptr);

}  // namespace raylanes
