// Square roots and their relatives: the methods, what each promises, and the grades that users ask for.
// Included by the kernel table, hence by the objects of the paths: constants and plain types only.
//
// Common to all methods: x and y have n elements and are equal or do not overlap. Special values are those of
// IEEE 754 whatever the method, the unchecked ones excepted: the root of ±0 is ±0, of +inf +inf, of a
// negative number or NaN NaN, of a subnormal the correctly rounded root; reciprocals and reciprocal roots of
// ±0 are ±inf, of infinity 0. Bounds hold for normal numbers (for the fast grade of `reciprocal` where 2^-126
// <= |x| < 2^125; elsewhere it divides). With DAZ and FTZ set subnormals count as zero, as they do for the
// hardware's own root.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <raylanes/types.hpp>

namespace raylanes {

// r = sqrt(a). s is the approximation, y that of 1/sqrt(a), u = 2^-24.
//   classic_N       bits(s) = 2^29 + (bits(a) >> 1) − 2^22 − 0x4C000, then N times s = (s + a/s)/2 (Heron).
//   weighted_1, _2  the seed 0x1FC00000 + (bits(a) >> 1) and one step s = 0.485386563 s + 0.514830168 a/s:
//                   its weights halve the one-sided error of Heron's step; _2 adds a plain step.
//   halley          the seed of classic and one step s = s (s² + 3a)/(3s² + a) (Halley 1694).
//   polynomial_D    no division: y from bits 0x5F1FFE00 − (bits(a) >> 1) (Lomont 2003, Kadlec 2010), s = a y,
//                   w = s y, then s P(w) with P the minimax polynomial of degree D of 1/sqrt(w).
//   polynomial_2_residual  and then s + (a − s²) y/2, the residual fused.
//   estimate        s = a y with the instruction's y (rsqrtps: 1.5·2^-12; rsqrt14ps: 2^-14).
//   estimate_newton            one Newton step on y first.
//   estimate_residual          s + (a − s²) y/2.
//   estimate_two_residuals     and again, with the same y.
//   goldschmidt     one step that refines s and y/2 side by side, then a residual (Goldschmidt 1964,
//                   Markstein 2004): correctly rounded where the estimate is as good as measured, which
//                   `raylanes sqrt` proves for a machine by all inputs. Without fused multiply-add it is the
//                   hardware's root.
//   hardware        the instruction: correctly rounded.
//   …_beside_hardware   the same, but some registers of every block go to the hardware's divider, which is
//                   idle otherwise. A value may get the method's root or the correctly rounded one,
//                   depending on its place.
//   estimate_unchecked  estimate for positive normal numbers alone: what it makes of others is not defined
//                   (NaN, an infinity or a number). For arrays that are known to hold no others, and to
//                   compare with libraries that ask for that.
//   …_one_at_a_time, …_four_a_loop, …_arrays_of_four   classic_N in the other forms of the course report: one
//                   value after another, four values written out in the body of the loop, and arrays of four
//                   handled by inner loops that the compiler may vectorise. The same bits as classic_N.
enum class SqrtMethod : std::uint8_t {
  classic_0,
  classic_1,
  classic_2,
  classic_3,
  weighted_1,
  weighted_2,
  halley,
  polynomial_1,
  polynomial_2,
  polynomial_3,
  polynomial_2_residual,
  estimate,
  estimate_newton,
  estimate_residual,
  estimate_two_residuals,
  goldschmidt,
  hardware,
  estimate_beside_hardware,
  estimate_residual_beside_hardware,
  estimate_two_residuals_beside_hardware,
  goldschmidt_beside_hardware,
  estimate_unchecked,
  classic_0_one_at_a_time,
  classic_1_one_at_a_time,
  classic_2_one_at_a_time,
  classic_3_one_at_a_time,
  classic_0_four_a_loop,
  classic_1_four_a_loop,
  classic_2_four_a_loop,
  classic_3_four_a_loop,
  classic_0_arrays_of_four,
  classic_1_arrays_of_four,
  classic_2_arrays_of_four,
  classic_3_arrays_of_four,
};

// 1/sqrt(a).
//   quake_N         y from bits 0x5F3759DF − (bits(a) >> 1) and N steps y (1.5 − (a/2) y²) (Walsh, Moler).
//   kadlec          0x5F1FFFF9 and one step 0.703952253 y (2.38924456 − a y²) (Kadlec 2010).
//   estimate        the instruction.
//   estimate_newton the instruction and one Newton step.
//   hardware        1/sqrt(a), both rounded.
enum class RsqrtMethod : std::uint8_t { quake_1, quake_2, kadlec, estimate, estimate_newton, hardware };

// 1/a.
//   estimate           the instruction (rcpps 1.5·2^-12, rcp14ps 2^-14).
//   estimate_newton    y (2 − a y).
//   estimate_residual  y + y (1 − a y).
//   hardware           the division: correctly rounded.
enum class ReciprocalMethod : std::uint8_t { estimate, estimate_newton, estimate_residual, hardware };

// Roots of doubles: as for floats; the constants are those of float at the same relative place.
enum class DoubleSqrtMethod : std::uint8_t {
  classic_0,
  classic_1,
  classic_2,
  classic_3,
  classic_4,
  polynomial_2,
  estimate,
  estimate_residual,
  hardware
};

// What a method promises, on every path.
struct RootMethod {
  std::string_view name;
  bool reproducible;           // the same bits on every path
  double max_ulp;              // largest error of a normal number, in ULP of the exact result, with fused
                               // multiply-add or without need of it
  double max_ulp_without_fma;  // the same on paths without fused multiply-add
  bool unchecked = false;      // whether special values are left to chance
};

inline constexpr std::array<RootMethod, 34> sqrt_methods{{
    {"classic_0", true, 408334.0, 408334.0},
    {"classic_1", true, 6795.0, 6795.0},
    {"classic_2", true, 2.694, 2.694},
    {"classic_3", true, 0.7505, 0.7505},
    {"weighted_1", true, 3638.0, 3638.0},
    {"weighted_2", true, 1.2, 1.2},
    {"halley", true, 118.0, 118.0},
    {"polynomial_1", true, 9460.0, 9460.0},
    {"polynomial_2", true, 254.0, 254.0},
    {"polynomial_3", true, 11.5, 11.5},
    {"polynomial_2_residual", false, 0.507, 1.1},
    {"estimate", false, 6145.0, 6145.0},
    {"estimate_newton", false, 5.0, 5.5},
    {"estimate_residual", false, 3.9, 4.4},
    {"estimate_two_residuals", false, 0.51, 1.1},
    {"goldschmidt", true, 0.5, 0.5},
    {"hardware", true, 0.5, 0.5},
    {"estimate_beside_hardware", false, 6145.0, 6145.0},
    {"estimate_residual_beside_hardware", false, 3.9, 4.4},
    {"estimate_two_residuals_beside_hardware", false, 0.51, 1.1},
    {"goldschmidt_beside_hardware", true, 0.5, 0.5},
    {"estimate_unchecked", false, 6145.0, 6145.0, true},
    {"classic_0_one_at_a_time", true, 408334.0, 408334.0},
    {"classic_1_one_at_a_time", true, 6795.0, 6795.0},
    {"classic_2_one_at_a_time", true, 2.694, 2.694},
    {"classic_3_one_at_a_time", true, 0.7505, 0.7505},
    {"classic_0_four_a_loop", true, 408334.0, 408334.0},
    {"classic_1_four_a_loop", true, 6795.0, 6795.0},
    {"classic_2_four_a_loop", true, 2.694, 2.694},
    {"classic_3_four_a_loop", true, 0.7505, 0.7505},
    {"classic_0_arrays_of_four", true, 408334.0, 408334.0},
    {"classic_1_arrays_of_four", true, 6795.0, 6795.0},
    {"classic_2_arrays_of_four", true, 2.694, 2.694},
    {"classic_3_arrays_of_four", true, 0.7505, 0.7505},
}};

inline constexpr std::array<RootMethod, 6> rsqrt_methods{{
    {"quake_1", true, 29400.0, 29400.0},
    {"quake_2", true, 80.0, 80.0},
    {"kadlec", true, 10920.0, 10920.0},
    {"estimate", false, 6145.0, 6145.0},
    {"estimate_newton", false, 5.0, 5.5},
    {"hardware", true, 1.5, 1.5},
}};

inline constexpr std::array<RootMethod, 4> reciprocal_methods{{
    {"estimate", false, 6145.0, 6145.0},
    {"estimate_newton", false, 3.5, 4.5},
    {"estimate_residual", false, 3.0, 4.5},
    {"hardware", true, 0.5, 0.5},
}};

// Errors in ULP of double, as relative errors times 2^53.
inline constexpr std::array<RootMethod, 9> double_sqrt_methods{{
    {"classic_0", true, 0x1.205p-5 * 0x1p53, 0x1.205p-5 * 0x1p53},
    {"classic_1", true, 6.42e-4 * 0x1p53, 6.42e-4 * 0x1p53},
    {"classic_2", true, 1.05e9, 1.05e9},
    {"classic_3", true, 100.0, 100.0},
    {"classic_4", true, 0.7505, 0.7505},
    {"polynomial_2", true, 1.63e-5 * 0x1p53, 1.63e-5 * 0x1p53},
    {"estimate", false, 3.67e-4 * 0x1p53, 3.67e-4 * 0x1p53},
    {"estimate_residual", false, 2.1e-7 * 0x1p53, 2.1e-7 * 0x1p53},
    {"hardware", true, 0.5, 0.5},
}};

using FloatArrayFunction = void (*)(const float* x, float* y, std::size_t n);
using DoubleArrayFunction = void (*)(const double* x, double* y, std::size_t n);

// What a user asks of a root: a bound, not a method. Relative errors hold for normal numbers; special values
// are those of IEEE 754 in every grade.
enum class SqrtGrade : std::uint8_t {
  correctly_rounded,  // all 2^32 inputs
  within_1_ulp,
  within_2_to_minus_22,
  within_2_to_minus_16,
  within_2_to_minus_11,
  within_2_to_minus_4
};
inline constexpr std::array<std::string_view, 6> sqrt_grade_names{
    "correctly_rounded", "within_1_ulp", "within_2^-22", "within_2^-16", "within_2^-11", "within_2^-4"};
// Where 0 the bound is in ULP alone: 0.5 or 1.
inline constexpr std::array<double, 6> sqrt_grade_relative_error{0.0, 0.0, 0x1p-22, 0x1p-16, 0x1p-11, 0x1p-4};
inline constexpr std::array<double, 6> sqrt_grade_max_ulp{0.5, 1.0, 4.0, 0x1p8, 0x1p13, 0x1p20};

// One path's roots, indexed by the methods, and the method that serves each grade: the fastest one measured
// that keeps the bound.
struct SquareRootKernels {
  FloatArrayFunction sqrt[sqrt_methods.size()];
  FloatArrayFunction rsqrt[rsqrt_methods.size()];
  FloatArrayFunction reciprocal[reciprocal_methods.size()];
  DoubleArrayFunction sqrt_double[double_sqrt_methods.size()];
  SqrtMethod sqrt_of_grade[sqrt_grade_names.size()];
  DoubleSqrtMethod double_sqrt_of_grade[sqrt_grade_names.size()];
};

}  // namespace raylanes
