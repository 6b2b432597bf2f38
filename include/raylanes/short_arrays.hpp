// Roots and reciprocals of few numbers, inlined into the caller and compiled with its flags, behind the calls of
// <raylanes/roots.hpp>. Each root, quotient and fused operation is an instruction that -ffast-math cannot replace. The
// namespace depends on the instruction set, so that objects compiled with different flags share no function.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include <raylanes/root_methods.hpp>

#if defined(__AVX512F__) && defined(__FMA__)
#define RAYLANES_SHORT_ARRAYS short_arrays_avx512
#define RAYLANES_VECTOR_BYTES 64
#elif defined(__AVX__) && defined(__FMA__)
#define RAYLANES_SHORT_ARRAYS short_arrays_fma
#define RAYLANES_VECTOR_BYTES 32
#elif defined(__AVX__)
#define RAYLANES_SHORT_ARRAYS short_arrays_avx
#define RAYLANES_VECTOR_BYTES 32
#elif defined(__x86_64__) || defined(__aarch64__)
#define RAYLANES_SHORT_ARRAYS short_arrays_base
#define RAYLANES_VECTOR_BYTES 16
#else
#define RAYLANES_SHORT_ARRAYS short_arrays_none
#define RAYLANES_VECTOR_BYTES 0
#endif

namespace raylanes {
inline namespace RAYLANES_SHORT_ARRAYS {
namespace few {

#if RAYLANES_VECTOR_BYTES > 0

template <class T, std::size_t bytes>
struct VectorOf {
  typedef T type __attribute__((vector_size(bytes)));
};

// The text of instructions; t: the suffix for vectors of floats or of doubles.
#if defined(__AVX__)
#define RAYLANES_SQRT(t) "{vsqrtp" t " %1, %0|vsqrtp" t " %0, %1}"
#define RAYLANES_DIVIDE(t) "{vdivp" t " %2, %1, %0|vdivp" t " %0, %1, %2}"
#elif defined(__x86_64__)
#define RAYLANES_SQRT(t) "{sqrtp" t " %1, %0|sqrtp" t " %0, %1}"
#define RAYLANES_DIVIDE(t) "{divp" t " %2, %0|divp" t " %0, %2}"
#else
#define RAYLANES_SQRT(t) "fsqrt %0." t ", %1." t
#define RAYLANES_DIVIDE(t) "fdiv %0." t ", %1." t ", %2." t
#endif
#define RAYLANES_SUBTRACT(t) "{vfmsub231p" t " %2, %1, %0|vfmsub231p" t " %0, %1, %2}"
#define RAYLANES_ADD(t) "{vfmadd231p" t " %2, %1, %0|vfmadd231p" t " %0, %1, %2}"
#define RAYLANES_ADD_NEGATED(t) "{vfnmadd231p" t " %2, %1, %0|vfnmadd231p" t " %0, %1, %2}"
#if defined(__aarch64__)
#define RAYLANES_ASM(text, T, ...)                             \
  if constexpr (sizeof(T) == 4) asm(text("4s") : __VA_ARGS__); \
  if constexpr (sizeof(T) == 8) asm(text("2d") : __VA_ARGS__)
#define RAYLANES_REGISTER "w"
#define RAYLANES_DIVIDEND "w"
#else
#define RAYLANES_ASM(text, T, ...)                            \
  if constexpr (sizeof(T) == 4) asm(text("s") : __VA_ARGS__); \
  if constexpr (sizeof(T) == 8) asm(text("d") : __VA_ARGS__)
#define RAYLANES_REGISTER "x"
#if defined(__AVX__)
#define RAYLANES_DIVIDEND "x"
#else
#define RAYLANES_DIVIDEND "0"
#endif
#endif

// An operation takes a vector of numbers and returns the results. bytes: the size of a vector for which its widest
// registers are full.
template <class T>
struct Root {
  static constexpr std::size_t bytes = RAYLANES_VECTOR_BYTES;
  template <class V>
  static V of(V a) {
    V root;
    RAYLANES_ASM(RAYLANES_SQRT, T, "=" RAYLANES_REGISTER(root) : RAYLANES_REGISTER(a));
    return root;
  }
};

template <class T>
struct Reciprocal {
  static constexpr std::size_t bytes = RAYLANES_VECTOR_BYTES;
  template <class V>
  static V of(V a) {
    V one = V{} + T(1), quotient;
    RAYLANES_ASM(RAYLANES_DIVIDE, T, "=" RAYLANES_REGISTER(quotient)
                 : RAYLANES_DIVIDEND(one), RAYLANES_REGISTER(a));
    return quotient;
  }
};

// Rounded twice: within 1.5 ULP.
template <class T>
struct ReciprocalRoot {
  static constexpr std::size_t bytes = RAYLANES_VECTOR_BYTES;
  template <class V>
  static V of(V a) {
    return Reciprocal<T>::of(Root<T>::of(a));
  }
};

// For floats, in double: correctly rounded, as the method `in_double`.
struct RoundedReciprocalRoot {
  static constexpr std::size_t bytes = RAYLANES_VECTOR_BYTES / 2;
  template <class V>
  static V of(V a) {
    using Doubles = typename VectorOf<double, 2 * sizeof(V)>::type;
    return __builtin_convertvector(ReciprocalRoot<double>::of(__builtin_convertvector(a, Doubles)), V);
  }
};

#if defined(__FMA__)
template <class T>
inline constexpr std::int64_t infinity_bits = 0x7ff0000000000000;
template <>
inline constexpr std::int32_t infinity_bits<float> = 0x7f800000;

// And a Newton step whose residual 1 − a y² is exact but for its last bits: within 0.50001 ULP, as the method
// `corrected`. No product here leaves the range of normal numbers, whatever the number is.
template <class T>
struct CorrectedReciprocalRoot {
  static constexpr std::size_t bytes = RAYLANES_VECTOR_BYTES;
  template <class V>
  static V of(V a) {
    using Bits = decltype(a < a);
    V y = ReciprocalRoot<T>::of(a), product = a * y, error = product, residual = V{} + T(1);
    V half = y * T(0.5), root = y;
    RAYLANES_ASM(RAYLANES_SUBTRACT, T, "+x"(error) : "x"(a), "x"(y));
    RAYLANES_ASM(RAYLANES_ADD_NEGATED, T, "+x"(residual) : "x"(product), "x"(y));
    RAYLANES_ASM(RAYLANES_ADD_NEGATED, T, "+x"(residual) : "x"(error), "x"(y));
    RAYLANES_ASM(RAYLANES_ADD, T, "+x"(root) : "x"(half), "x"(residual));
    // Zeros, infinities and NaN stay what they are.
    const Bits of_y = reinterpret_cast<Bits>(y), of_root = reinterpret_cast<Bits>(root);
    const Bits infinite = Bits{} + infinity_bits<T>;
    const Bits is_ordinary = (of_y > 0) & (of_y < infinite);
    return reinterpret_cast<V>((of_root & is_ordinary) | (of_y & ~is_ordinary));
  }
};
#endif

// The results of n > 0 numbers; y may be x. The last vector overlaps the one before it.
template <class Operation, std::size_t bytes, class T>
inline void take_vectors(const T* x, T* y, std::size_t n) {
  using V = typename VectorOf<T, bytes>::type;
  constexpr std::size_t lanes = bytes / sizeof(T);
  const auto load = [x](std::size_t i) {
    V a;
    std::memcpy(&a, x + i, bytes);
    return a;
  };
  if (n >= lanes) {
    const V last = Operation::of(load(n - lanes));
    for (std::size_t i = 0; i + lanes < n; i += lanes) {
      const V now = Operation::of(load(i));
      std::memcpy(y + i, &now, bytes);
    }
    std::memcpy(y + n - lanes, &last, bytes);
  } else if constexpr (bytes > 16) {
    take_vectors<Operation, bytes / 2>(x, y, n);
  } else if (n == 1) {
    V a{};
    for (std::size_t lane = 0; lane < lanes; ++lane) a[lane] = x[0];
    y[0] = Operation::of(a)[0];
  } else {  // 2 or 3
    V a{};
    for (std::size_t lane = 0; lane < lanes; ++lane) a[lane] = x[lane == 0 ? 0 : lane == 1 ? n / 2 : n - 1];
    const V now = Operation::of(a);
    y[0] = now[0], y[n / 2] = now[lanes > 1 ? 1 : 0], y[n - 1] = now[lanes - 1];
  }
}

// Takes the results of up to `vectors` full vectors, if the accuracy exists; returns whether it did. How many: by
// measurement, until the library's kernels are faster.
template <class Operation, class T>
inline bool taken(std::span<const T> x, std::span<T> y, Accuracy accuracy, std::size_t vectors) {
  if (x.size() - 1 >= vectors * Operation::bytes / sizeof(T) || y.size() != x.size() ||
      static_cast<std::size_t>(accuracy) >= accuracies.size())
    return false;
  take_vectors<Operation, Operation::bytes>(x.data(), y.data(), x.size());
  return true;
}

// A call of the kernels takes the time of more vectors, if these are narrow.
inline constexpr bool is_narrow = RAYLANES_VECTOR_BYTES == 16;

inline bool sqrt_of_few(std::span<const float> x, std::span<float> y, Accuracy accuracy) {
  return taken<Root<float>>(x, y, accuracy, is_narrow ? 12 : 8);
}
inline bool sqrt_of_few(std::span<const double> x, std::span<double> y, Accuracy accuracy) {
  return taken<Root<double>>(x, y, accuracy, accuracy == Accuracy::correctly_rounded ? 8 : 3);
}
template <class T>
inline bool reciprocal_of_few(std::span<const T> x, std::span<T> y, Accuracy accuracy) {
  return taken<Reciprocal<T>>(x, y, accuracy, 8);
}
inline bool rsqrt_of_few(std::span<const float> x, std::span<float> y, Accuracy accuracy) {
  if (accuracy == Accuracy::correctly_rounded) return taken<RoundedReciprocalRoot>(x, y, accuracy, 8);
  if (accuracy != Accuracy::within_1_ulp && accuracy != Accuracy::within_2_to_minus_44)
    return taken<ReciprocalRoot<float>>(x, y, accuracy, is_narrow ? 6 : 3);
#if defined(__FMA__)
  return taken<CorrectedReciprocalRoot<float>>(x, y, accuracy, 2);
#else
  return taken<RoundedReciprocalRoot>(x, y, accuracy, 1);
#endif
}
inline bool rsqrt_of_few(std::span<const double> x, std::span<double> y, Accuracy accuracy) {
  if (accuracy > Accuracy::within_1_ulp) return taken<ReciprocalRoot<double>>(x, y, accuracy, 2);
#if defined(__FMA__)
  if (accuracy == Accuracy::within_1_ulp) return taken<CorrectedReciprocalRoot<double>>(x, y, accuracy, 2);
#endif
  return false;
}

#undef RAYLANES_SQRT
#undef RAYLANES_DIVIDE
#undef RAYLANES_DIVIDEND
#undef RAYLANES_REGISTER
#undef RAYLANES_ASM
#undef RAYLANES_ADD
#undef RAYLANES_ADD_NEGATED
#undef RAYLANES_SUBTRACT
#else
template <class T>
inline bool sqrt_of_few(std::span<const T>, std::span<T>, Accuracy) {
  return false;
}
template <class T>
inline bool rsqrt_of_few(std::span<const T>, std::span<T>, Accuracy) {
  return false;
}
template <class T>
inline bool reciprocal_of_few(std::span<const T>, std::span<T>, Accuracy) {
  return false;
}
#endif

}  // namespace few
}  // namespace RAYLANES_SHORT_ARRAYS
}  // namespace raylanes
