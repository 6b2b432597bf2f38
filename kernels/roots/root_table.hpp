// The roots of a path's table: which method runs in which mix of registers, and which one serves which grade.
#pragma once

#include "../../dispatch/table.hpp"
#include "array_loop.hpp"
#include "reciprocal_methods.hpp"

namespace raylanes {
namespace {

// Which mix a method runs in: alone, eight registers or six in groups of one, two, …; or beside registers in
// the divider. A root takes it 5 cycles for 4 or 8 floats on Zen 2 to 4 and 6 on Skylake and its
// successors, and 10 to 12 for 16, during which the two multipliers do 8 to 22 operations: the share of the
// divider follows from the operations of the method. Chosen by measurement on Zen 3 for 4 and 8 lanes, by the
// port model for 16.
inline constexpr bool is_wide = native_lanes == 16;
inline constexpr Mix ones{1, 0, 8}, twos{2, 0, 4}, threes{3, 0, 2}, fours{4, 0, 2}, eight{8, 0, 1};
inline constexpr Mix estimate_mix{4, 1, 2};
inline constexpr Mix residual_mix = is_wide ? Mix{4, 1, 2} : Mix{2, 1, 2};
inline constexpr Mix two_residuals_mix = is_wide ? Mix{3, 1, 2} : has_fma ? Mix{3, 2, 1} : Mix{2, 2, 2};
inline constexpr Mix goldschmidt_mix = is_wide ? Mix{5, 2, 1} : Mix{1, 1, 3};

template <class M, Mix mix>
constexpr FloatArrayFunction of_floats() {
  return array_of<M, float, mix>;
}

// Without fused multiply-add its text is the hardware's root: the plain loop is that without the test.
template <Mix mix>
constexpr FloatArrayFunction goldschmidt_array() {
  if constexpr (has_fma)
    return array_of<Goldschmidt, float, mix>;
  else
    return plain_array_of<Hardware, float>;
}

constexpr SquareRootKernels square_root_kernels() {
  SquareRootKernels k{
      // In the order of SqrtMethod.
      {of_floats<Classic<0>, ones>(),
       of_floats<Classic<1>, ones>(),
       of_floats<Classic<2>, ones>(),
       of_floats<Classic<3>, ones>(),
       of_floats<Weighted<1>, ones>(),
       of_floats<Weighted<2>, ones>(),
       of_floats<Halley, fours>(),
       of_floats<Polynomial<1>, threes>(),
       of_floats<Polynomial<2>, threes>(),
       of_floats<Polynomial<3>, fours>(),
       of_floats<PolynomialResidual, threes>(),
       of_floats<Estimate, eight>(),
       of_floats<EstimateNewton, twos>(),
       of_floats<EstimateResidual<1>, twos>(),
       of_floats<EstimateResidual<2>, threes>(),
       goldschmidt_array<twos>(),
       plain_array_of<Hardware, float>,
       of_floats<Estimate, estimate_mix>(),
       of_floats<EstimateResidual<1>, residual_mix>(),
       of_floats<EstimateResidual<2>, two_residuals_mix>(),
       goldschmidt_array<goldschmidt_mix>(),
       plain_array_of<Estimate, float, 8>,
       one_at_a_time<0>,
       one_at_a_time<1>,
       one_at_a_time<2>,
       one_at_a_time<3>,
       four_a_loop<0>,
       four_a_loop<1>,
       four_a_loop<2>,
       four_a_loop<3>,
       arrays_of_four<0>,
       arrays_of_four<1>,
       arrays_of_four<2>,
       arrays_of_four<3>},
      // RsqrtMethod, ReciprocalMethod, DoubleSqrtMethod.
      {of_floats<Quake<1>, threes>(), of_floats<Quake<2>, fours>(), of_floats<Kadlec, threes>(),
       of_floats<ReciprocalRootEstimate, eight>(), of_floats<ReciprocalRootNewton, twos>(),
       plain_array_of<ReciprocalRootHardware, float>},
      {of_floats<ReciprocalEstimate, eight>(), of_floats<ReciprocalNewton, twos>(),
       of_floats<ReciprocalResidual, ones>(), plain_array_of<Division, float>},
      {array_of<Classic<0>, double, ones>, array_of<Classic<1>, double, ones>,
       array_of<Classic<2>, double, ones>, array_of<Classic<3>, double, ones>,
       array_of<Classic<4>, double, ones>, array_of<Polynomial<2>, double, threes>,
       array_of<ScaledEstimate, double, threes>, array_of<ScaledEstimateResidual, double, threes>,
       plain_array_of<Hardware, double>},
      {},
      {}};
  using S = SqrtMethod;
  using D = DoubleSqrtMethod;
  // In the order of SqrtGrade. With one lane nothing is faster than the instruction.
  const S sqrt_of_grade[] = {S::goldschmidt_beside_hardware,       S::estimate_two_residuals_beside_hardware,
                             S::estimate_residual_beside_hardware, S::estimate_residual_beside_hardware,
                             S::estimate_beside_hardware,          S::estimate_beside_hardware};
  const D double_of_grade[] = {D::hardware,          D::hardware, D::estimate_residual,
                               D::estimate_residual, D::estimate, D::classic_0};
  for (std::size_t g = 0; g < sqrt_grade_names.size(); ++g) {
    k.sqrt_of_grade[g] = native_lanes == 1 ? S::hardware : sqrt_of_grade[g];
    k.double_sqrt_of_grade[g] = double_of_grade[g];
  }
  return k;
}

}  // namespace
}  // namespace raylanes
