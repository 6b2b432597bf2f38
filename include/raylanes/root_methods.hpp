// Square roots, reciprocal square roots and reciprocals: methods, what each promises, and accuracies to ask for
// instead.
// The kernels of every ISA path include this header: it has constants and plain types only.
//
// All methods but the unchecked one return what IEEE 754 says for special values: the root of ±0 is ±0, of +inf +inf,
// of a negative number or NaN NaN, of a subnormal the correctly rounded root. Reciprocals and reciprocal roots of ±0
// are ±inf, of infinity 0. Bounds hold for normal numbers; for `reciprocal` the exact result must be at least 2^-125
// (double: 2^-1021). Other numbers get the result of method `hardware`, or the exact result rounded once. With DAZ and
// FTZ subnormals count as zeros, as for the hardware's own root.
//
// An error is |y − exact| in units of the last place (ULP) of the binade in which the exact result lies: 2^(e−23) for
// float, 2^(e−52) for double, 2^e <= exact < 2^(e+1). A relative error of δ is at most δ·2^24, δ·2^53 of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <raylanes/types.hpp>

namespace raylanes {

/// Methods of √a in floats. s is the approximation, y that of 1/sqrt(a), u = 2^-24.
///   classic_2       bits(s) = 2^29 + (bits(a) >> 1) − 2^22 − 0x4C000, then twice s = (s + a/s)/2 (Heron).
///   goldschmidt     one step that refines s and y/2 side by side, then a residual (Goldschmidt 1964, Markstein
///                   2004): correctly rounded for every estimate within 2^-14, as all of them show; within 1.5·2^-12
///                   for all floats but 17 and their multiples by powers of 4, which are tried before the first call:
///                   it is the hardware's root where one of them fails, and without fused multiply-add.
///   hardware        the instruction: correctly rounded.
///   …_beside_hardware   some registers of every block take the method, the others the hardware's divider, which is
///                   idle otherwise. A value may get the method's root or the correctly rounded one, depending on its
///                   place. The methods are goldschmidt and:
///     estimate      s = a y with the instruction's y (rsqrtps 1.5·2^-12, rsqrt14ps 2^-14, FRSQRTE + FRSQRTS 2^-15.9).
///     estimate_residual        s + s (1/2 − s y/2), one step whose one-sided error is shifted to both sides.
///     estimate_two_residuals   s + (a − s²) y/2, and again with the same y.
///   estimate_unchecked  estimate for positive normal numbers alone: what it makes of others is not defined (NaN, an
///                   infinity or a number). For arrays that are known to hold no others, and to compare with
///                   libraries that ask for that.
enum class SqrtMethod : std::uint8_t {
  classic_2,
  goldschmidt,
  hardware,
  estimate_beside_hardware,
  estimate_residual_beside_hardware,
  estimate_two_residuals_beside_hardware,
  goldschmidt_beside_hardware,
  estimate_unchecked,
};

/// Methods of 1/√a in floats. y is the approximation of 1/√a.
///   estimate        the instruction.
///   estimate_newton the instruction and one Newton step, whose one-sided error is shifted to both sides.
///   corrected       and a step whose residual 1 − a y² is exact but for its last bits: the rounding error of a y is
///                   computed too (Dekker 1971). Without fused multiply-add it is in_double.
///   hardware        1/sqrt(a), both rounded.
///   in_double       1/sqrt(a) in double, rounded to float: correctly rounded, which all 2^32 inputs prove (on every
///                   path the same operations).
enum class RsqrtMethod : std::uint8_t { estimate, estimate_newton, corrected, hardware, in_double };

/// Methods of 1/a in floats. y is the approximation of 1/a.
///   estimate           the instruction (rcpps 1.5·2^-12, rcp14ps 2^-14, FRECPE and FRECPS 2^-16.8).
///   estimate_newton    y (2 − a y).
///   estimate_residual  y + y (1 − a y).
///   hardware           the division: correctly rounded.
enum class ReciprocalMethod : std::uint8_t { estimate, estimate_newton, estimate_residual, hardware };

/// Methods of √a in doubles, as for floats: the constants are at the same relative place, and estimates are made of the
/// significand as a float.
///   classic_N          as classic_2, with N steps.
///   polynomial_2       no division: y from bits as for floats 0x5F1FFE00 − (bits(a) >> 1) (Lomont 2003, Kadlec 2010),
///                      s = a y, w = s y, then s P(w) with P the minimax polynomial of degree 2 of 1/sqrt(w).
///   goldschmidt        as for floats, the first step shifted as in estimate_newton, or of third order if the estimate
///                      has 12 bits: not proved to be correctly rounded.
enum class DoubleSqrtMethod : std::uint8_t {
  classic_0,
  classic_1,
  classic_2,
  polynomial_2,
  estimate,
  estimate_residual,
  goldschmidt,
  hardware
};

/// Methods of 1/√a in doubles, as for floats.
///   estimate_two_steps    a second step: a plain Newton step, or one of third order if the estimate has 12 bits.
///   corrected             as for floats: after two Newton steps, or without fused multiply-add after the hardware's
///                         root and division.
enum class DoubleRsqrtMethod : std::uint8_t {
  estimate,
  estimate_newton,
  estimate_two_steps,
  corrected,
  hardware
};

/// Methods of 1/a in doubles, as for floats.
///   estimate_two_residuals   y + y (1 − a y) twice.
enum class DoubleReciprocalMethod : std::uint8_t {
  estimate,
  estimate_residual,
  estimate_two_residuals,
  hardware
};

/// The promise of a method, on every ISA path.
struct RootPromise {
  std::string_view name;
  bool reproducible;           ///< whether bits are the same on every ISA path
  double max_ulp;              ///< largest error of a normal number in ULP, on paths with fused multiply-add
  double max_ulp_without_fma;  ///< largest error of a normal number in ULP, on other paths
  bool unchecked = false;      ///< whether results of special values are undefined
};

/// A method and its promise.
template <class Method>
struct RootMethodInfo {
  Method method;  ///< also its index in the array
  RootPromise promise;
};

/// The promises of each SqrtMethod, by enumerator.
inline constexpr std::array<RootMethodInfo<SqrtMethod>, 8> sqrt_methods{{
    {SqrtMethod::classic_2, {"classic_2", true, 2.694, 2.694}},
    {SqrtMethod::goldschmidt, {"goldschmidt", true, 0.5, 0.5}},
    {SqrtMethod::hardware, {"hardware", true, 0.5, 0.5}},
    {SqrtMethod::estimate_beside_hardware, {"estimate_beside_hardware", false, 6145.0, 6145.0}},
    {SqrtMethod::estimate_residual_beside_hardware, {"estimate_residual_beside_hardware", false, 3.9, 4.4}},
    {SqrtMethod::estimate_two_residuals_beside_hardware,
     {"estimate_two_residuals_beside_hardware", false, 0.51, 1.1}},
    {SqrtMethod::goldschmidt_beside_hardware, {"goldschmidt_beside_hardware", true, 0.5, 0.5}},
    {SqrtMethod::estimate_unchecked, {"estimate_unchecked", false, 6145.0, 6145.0, true}},
}};

/// The promises of each RsqrtMethod, by enumerator.
inline constexpr std::array<RootMethodInfo<RsqrtMethod>, 5> rsqrt_methods{{
    {RsqrtMethod::estimate, {"estimate", false, 6145.0, 6145.0}},
    {RsqrtMethod::estimate_newton, {"estimate_newton", false, 3.6, 4.1}},
    {RsqrtMethod::corrected, {"corrected", false, 0.50001, 0.5}},
    {RsqrtMethod::hardware, {"hardware", true, 1.5, 1.5}},
    {RsqrtMethod::in_double, {"in_double", true, 0.5, 0.5}},
}};

/// The promises of each ReciprocalMethod, by enumerator.
inline constexpr std::array<RootMethodInfo<ReciprocalMethod>, 4> reciprocal_methods{{
    {ReciprocalMethod::estimate, {"estimate", false, 6145.0, 6145.0}},
    {ReciprocalMethod::estimate_newton, {"estimate_newton", false, 3.76, 4.5}},
    {ReciprocalMethod::estimate_residual, {"estimate_residual", false, 3.0, 4.5}},
    {ReciprocalMethod::hardware, {"hardware", true, 0.5, 0.5}},
}};

// Doubles cannot be tried exhaustively. The error of a bit trick repeats in every other binade: for classic_0 to
// classic_2 and polynomial_2 the bound is the largest error found on 6·10^7 numbers in [1, 4) in extended precision,
// rounded up; roundings of double add less than one ULP. The other bounds follow from ε <= 1.5·2^-12 + 2^-24, the
// relative error of an estimate by way of float:
//   estimate                 ε·2^53
//   estimate_residual        s = √a (1 + ε) becomes √a (1 − 1.5 ε² − ε³/2)
//   estimate_newton          so does 1/√a, plus κ = 0.75·(1.5·2^-12)²: |δ| <= 1.0071e-7
//   goldschmidt, estimate_two_steps     tests/proofs/double_roots.gappa; without fused multiply-add one rounding more
//   estimate_residual of a reciprocal   1/a (1 − ε²); estimate_two_residuals ε⁴, and 1.5 for roundings
//   corrected                0.5, the error of the residual, at most 2^-75, and 1.5 δ² of what comes before
/// The promises of each DoubleSqrtMethod, by enumerator.
inline constexpr std::array<RootMethodInfo<DoubleSqrtMethod>, 8> double_sqrt_methods{{
    {DoubleSqrtMethod::classic_0, {"classic_0", true, 2.193e14, 2.193e14}},
    {DoubleSqrtMethod::classic_1, {"classic_1", true, 3.648e12, 3.648e12}},
    {DoubleSqrtMethod::classic_2, {"classic_2", true, 1.044e9, 1.044e9}},
    {DoubleSqrtMethod::polynomial_2, {"polynomial_2", true, 1.3482e11, 1.3482e11}},
    {DoubleSqrtMethod::estimate, {"estimate", false, 3.3e12, 3.3e12}},
    {DoubleSqrtMethod::estimate_residual, {"estimate_residual", false, 1.82e9, 1.82e9}},
    {DoubleSqrtMethod::goldschmidt, {"goldschmidt", false, 0.63, 1.1}},
    {DoubleSqrtMethod::hardware, {"hardware", true, 0.5, 0.5}},
}};

/// The promises of each DoubleRsqrtMethod, by enumerator.
inline constexpr std::array<RootMethodInfo<DoubleRsqrtMethod>, 5> double_rsqrt_methods{{
    {DoubleRsqrtMethod::estimate, {"estimate", false, 3.3e12, 3.3e12}},
    {DoubleRsqrtMethod::estimate_newton, {"estimate_newton", false, 9.08e8, 9.08e8}},
    {DoubleRsqrtMethod::estimate_two_steps, {"estimate_two_steps", false, 1.62, 2.2}},
    {DoubleRsqrtMethod::corrected, {"corrected", false, 0.50001, 0.50001}},
    {DoubleRsqrtMethod::hardware, {"hardware", true, 1.5, 1.5}},
}};

/// The promises of each DoubleReciprocalMethod, by enumerator.
inline constexpr std::array<RootMethodInfo<DoubleReciprocalMethod>, 4> double_reciprocal_methods{{
    {DoubleReciprocalMethod::estimate, {"estimate", false, 3.3e12, 3.3e12}},
    {DoubleReciprocalMethod::estimate_residual, {"estimate_residual", false, 1.21e9, 1.21e9}},
    {DoubleReciprocalMethod::estimate_two_residuals, {"estimate_two_residuals", false, 164.0, 164.0}},
    {DoubleReciprocalMethod::hardware, {"hardware", true, 0.5, 0.5}},
}};

/// Error bounds to ask for, from the tightest on. If a function has no method between two bounds, the method of the
/// tighter one is used. No float can keep 2^-44: the method within 1 ULP is used. Special values are as in IEEE 754.
enum class Accuracy : std::uint8_t {
  correctly_rounded,
  within_1_ulp,
  within_2_ulp,
  within_2_to_minus_44,
  within_2_to_minus_22,
  within_2_to_minus_16,
  within_2_to_minus_11,
  within_2_to_minus_4
};

/// A bound and its name.
struct AccuracyInfo {
  Accuracy accuracy;
  std::string_view name;
  double max_ulp;             ///< the bound in ULP; 0: the bound is a relative error
  double max_relative_error;  ///< the bound for normal numbers; 0: the bound is in ULP
};

/// The bounds, by enumerator.
inline constexpr std::array<AccuracyInfo, 8> accuracies{{
    {Accuracy::correctly_rounded, "correctly_rounded", 0.5, 0.0},
    {Accuracy::within_1_ulp, "within_1_ulp", 1.0, 0.0},
    {Accuracy::within_2_ulp, "within_2_ulp", 2.0, 0.0},
    {Accuracy::within_2_to_minus_44, "within_2^-44", 0.0, 0x1p-44},
    {Accuracy::within_2_to_minus_22, "within_2^-22", 0.0, 0x1p-22},
    {Accuracy::within_2_to_minus_16, "within_2^-16", 0.0, 0x1p-16},
    {Accuracy::within_2_to_minus_11, "within_2^-11", 0.0, 0x1p-11},
    {Accuracy::within_2_to_minus_4, "within_2^-4", 0.0, 0x1p-4},
}};

}  // namespace raylanes
