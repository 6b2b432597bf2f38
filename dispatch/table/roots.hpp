// Kernels for roots and reciprocals. Contracts and bounds: <raylanes/root_methods.hpp>.
#pragma once

#include <cstddef>

#include <raylanes/root_methods.hpp>

namespace raylanes {

// One function of roots: its methods, numbered as in the enumeration, and the fastest one measured for each accuracy.
template <class T>
using ArrayFunction = void (*)(const T* x, T* y, std::size_t n);
template <class T, class Method, std::size_t Count>
struct RootRows {
  ArrayFunction<T> by[Count];
  Method within[accuracies.size()];
};

struct RootKernels {
  RootRows<float, SqrtMethod, sqrt_methods.size()> sqrt;
  RootRows<float, RsqrtMethod, rsqrt_methods.size()> rsqrt;
  RootRows<float, ReciprocalMethod, reciprocal_methods.size()> reciprocal;
  RootRows<double, DoubleSqrtMethod, double_sqrt_methods.size()> double_sqrt;
  RootRows<double, DoubleRsqrtMethod, double_rsqrt_methods.size()> double_rsqrt;
  RootRows<double, DoubleReciprocalMethod, double_reciprocal_methods.size()> double_reciprocal;
  // The square root goldschmidt_beside_hardware, bit for bit, with more of it in the divider: the faster one where
  // operations of 512 bits take two passes. Null on paths of narrower registers.
  ArrayFunction<float> sqrt_in_two_passes;
};

}  // namespace raylanes
