// The roots of one path: which method runs in which mix of registers, and which one serves which accuracy. Compiled
// once per path with its flags and back end; the table is the only symbol that leaves the object.
#include "../../dispatch/table/roots.hpp"
#include "array_loop.hpp"
#include "reciprocal_methods.hpp"

namespace raylanes {
namespace {

// Which mix a method runs in: alone, eight registers or six in groups of one, two, …; or beside registers in the
// divider. A root takes it 5 cycles for 4 or 8 floats on Zen 2 to 4 and 6 on Skylake and its successors, and 10 to 12
// for 16, during which the two multipliers do 8 to 22 operations: the share of the divider follows from the
// operations of the method. Chosen by measurement on Zen 3 for 4 and 8 lanes, by counting for 16.
inline constexpr bool is_wide = native_lanes == 16;
inline constexpr Mix ones{1, 0, 8}, twos{2, 0, 4}, threes{3, 0, 2}, eight{8, 0, 1};
inline constexpr Mix estimate_mix{4, 1, 2};
inline constexpr Mix residual_mix = is_wide ? Mix{4, 1, 2} : Mix{2, 1, 2};
inline constexpr Mix two_residuals_mix = is_wide ? Mix{3, 1, 2} : has_fma ? Mix{3, 2, 1} : Mix{2, 2, 2};
inline constexpr Mix goldschmidt_mix = is_wide ? Mix{5, 2, 1} : Mix{1, 1, 3};
// For 16 lanes where multipliers take two passes, as the divider does: by measurement on Zen 4, of 24 mixes.
inline constexpr Mix two_passes_mix{4, 3, 1};

// An enumerator and the function that goes into its place: the type of the method names it, so that the order of a
// list means nothing.
template <class T, class Method>
struct Row {
  Method method;
  ArrayFunction<T> function;
};
template <class M, Mix mix>
constexpr Row<float, std::remove_const_t<decltype(M::id)>> floats() {
  return {M::id, array_of<M, float, mix>};
}
template <class M, Mix mix>
constexpr Row<double, std::remove_const_t<decltype(M::double_id)>> doubles() {
  return {M::double_id, array_of<M, double, mix>};
}

// Without fused multiply-add these texts are the hardware's: the plain loop is that without the test.
template <Mix mix>
constexpr ArrayFunction<float> goldschmidt() {
  if constexpr (has_fma)
    return array_of<Goldschmidt, float, mix>;
  else
    return plain_array_of<Hardware, float>;
}
constexpr ArrayFunction<float> sqrt_in_two_passes() {
  if constexpr (is_wide)
    return goldschmidt<two_passes_mix>();
  else
    return nullptr;
}
constexpr ArrayFunction<float> corrected() {
  if constexpr (has_fma)
    return array_of<ReciprocalRootCorrected, float, twos>;
  else
    return plain_array_of<ReciprocalRootInDouble, float>;
}

constexpr Row<float, SqrtMethod> sqrt_rows[] = {
    floats<Classic<2>, ones>(),
    {Goldschmidt::id, goldschmidt<twos>()},
    {Hardware::id, plain_array_of<Hardware, float>},
    floats<Estimate, estimate_mix>(),
    floats<EstimateResidual<1>, residual_mix>(),
    floats<EstimateResidual<2>, two_residuals_mix>(),
    {SqrtMethod::goldschmidt_beside_hardware, goldschmidt<goldschmidt_mix>()},
    {SqrtMethod::estimate_unchecked, plain_array_of<Estimate, float, 8>},
};
constexpr Row<float, RsqrtMethod> rsqrt_rows[] = {
    floats<ReciprocalRootEstimate, eight>(),
    floats<ReciprocalRootNewton, twos>(),
    {ReciprocalRootCorrected::id, corrected()},
    {ReciprocalRootHardware::id, plain_array_of<ReciprocalRootHardware, float>},
    {ReciprocalRootInDouble::id, plain_array_of<ReciprocalRootInDouble, float>},
};
constexpr Row<float, ReciprocalMethod> reciprocal_rows[] = {
    floats<ReciprocalEstimate, eight>(),
    floats<ReciprocalNewton, twos>(),
    floats<ReciprocalResidual, ones>(),
    {Division::id, plain_array_of<Division, float>},
};
constexpr Row<double, DoubleSqrtMethod> double_sqrt_rows[] = {
    doubles<Classic<0>, ones>(),        doubles<Classic<1>, ones>(),
    doubles<Classic<2>, ones>(),        doubles<Polynomial, threes>(),
    doubles<ScaledEstimate, threes>(),  doubles<ScaledEstimateResidual, threes>(),
    doubles<ScaledGoldschmidt, twos>(), {Hardware::double_id, plain_array_of<Hardware, double>},
};
constexpr Row<double, DoubleRsqrtMethod> double_rsqrt_rows[] = {
    doubles<ScaledReciprocalRoot<0>, threes>(),
    doubles<ScaledReciprocalRoot<1>, threes>(),
    doubles<ScaledReciprocalRootInTwoSteps, twos>(),
    doubles<ScaledReciprocalRootCorrected, twos>(),
    {ReciprocalRootHardware::double_id, plain_array_of<ReciprocalRootHardware, double>},
};
constexpr Row<double, DoubleReciprocalMethod> double_reciprocal_rows[] = {
    doubles<ScaledReciprocal<0>, threes>(),
    doubles<ScaledReciprocal<1>, threes>(),
    doubles<ScaledReciprocal<2>, threes>(),
    {Division::double_id, plain_array_of<Division, double>},
};

// For each accuracy, from the tightest on, the fastest method measured that keeps it.
constexpr std::size_t accuracy_count = accuracies.size();
template <class Method>
struct Choice {
  Method within[accuracy_count];
};
using S = SqrtMethod;
using Q = RsqrtMethod;
using R = ReciprocalMethod;
using DS = DoubleSqrtMethod;
using DQ = DoubleRsqrtMethod;
using DR = DoubleReciprocalMethod;

// With one lane nothing is faster than the instruction.
constexpr Choice<S> sqrt_choice =
    native_lanes == 1
        ? Choice<S>{{S::hardware, S::hardware, S::hardware, S::hardware, S::hardware, S::hardware,
                     S::hardware, S::hardware}}
        : Choice<S>{{S::goldschmidt_beside_hardware, S::estimate_two_residuals_beside_hardware,
                     S::estimate_two_residuals_beside_hardware, S::estimate_two_residuals_beside_hardware,
                     S::estimate_residual_beside_hardware, S::estimate_residual_beside_hardware,
                     S::estimate_beside_hardware, S::estimate_beside_hardware}};
constexpr Choice<Q> rsqrt_choice{{Q::in_double, Q::corrected, has_fma ? Q::corrected : Q::hardware,
                                  Q::corrected, Q::estimate_newton, Q::estimate_newton, Q::estimate,
                                  Q::estimate}};
// Without fused multiply-add the rounding of 1 − a y takes what 2^-22 leaves.
constexpr R two_to_minus_22 = has_fma ? R::estimate_residual : R::hardware;
constexpr Choice<R> reciprocal_choice{{R::hardware, R::hardware, R::hardware, R::hardware, two_to_minus_22,
                                       R::estimate_newton, R::estimate, R::estimate}};

// Doubles: the way to the estimate and back is long by way of float, too long for 2 ULP. It is longest where
// AVX has no integers as wide as its floats. The first reciprocal root is not offered (see roots.hpp).
constexpr Choice<DS> double_sqrt_choice =
    estimates_span_doubles
        ? Choice<DS>{{DS::hardware, DS::goldschmidt, DS::goldschmidt, DS::goldschmidt, DS::estimate_residual,
                      DS::estimate_residual, DS::estimate, DS::estimate}}
    : has_fma
        ? Choice<DS>{{DS::hardware, DS::hardware, DS::hardware, DS::hardware, DS::estimate_residual,
                      DS::estimate_residual, DS::polynomial_2, DS::classic_0}}
        : Choice<DS>{{DS::hardware, DS::hardware, DS::hardware, DS::hardware, DS::hardware, DS::hardware,
                      native_lanes == 1 ? DS::hardware : DS::polynomial_2, DS::classic_0}};
constexpr DQ within_2_ulp = has_fma ? DQ::estimate_two_steps : DQ::hardware;
constexpr Choice<DQ> double_rsqrt_choice{{DQ::corrected, DQ::corrected, within_2_ulp, within_2_ulp,
                                          DQ::estimate_newton, DQ::estimate_newton, DQ::estimate,
                                          DQ::estimate}};
constexpr DR two_to_minus_44 = estimates_span_doubles ? DR::estimate_two_residuals : DR::hardware;
constexpr Choice<DR> double_reciprocal_choice =
    has_fma ? Choice<DR>{{DR::hardware, DR::hardware, DR::hardware, two_to_minus_44, DR::estimate_residual,
                          DR::estimate_residual, DR::estimate, DR::estimate}}
            : Choice<DR>{{DR::hardware, DR::hardware, DR::hardware, DR::hardware, DR::hardware, DR::hardware,
                          DR::hardware, DR::hardware}};

template <class T, class Method, std::size_t Count>
constexpr RootRows<T, Method, Count> rows_of(const Row<T, Method> (&rows)[Count],
                                             const Choice<Method>& choice) {
  RootRows<T, Method, Count> placed{};
  for (const Row<T, Method>& row : rows) placed.by[static_cast<std::size_t>(row.method)] = row.function;
  for (std::size_t a = 0; a < accuracy_count; ++a) placed.within[a] = choice.within[a];
  return placed;
}
// Each method has one row. A missing row or one too many differs in length from the list of methods.
template <class T, class Method, std::size_t Count>
constexpr bool is_complete(const Row<T, Method> (&rows)[Count],
                           const std::array<RootMethodInfo<Method>, Count>& methods) {
  for (std::size_t m = 0; m < Count; ++m) {
    int named = 0;
    for (const Row<T, Method>& row : rows) named += row.method == static_cast<Method>(m) ? 1 : 0;
    if (named != 1 || methods[m].method != static_cast<Method>(m)) return false;
  }
  for (std::size_t a = 0; a < accuracy_count; ++a)
    if (accuracies[a].accuracy != static_cast<Accuracy>(a)) return false;
  return true;
}

}  // namespace

static_assert(is_complete(sqrt_rows, sqrt_methods) && is_complete(rsqrt_rows, rsqrt_methods) &&
              is_complete(reciprocal_rows, reciprocal_methods));
static_assert(is_complete(double_sqrt_rows, double_sqrt_methods) &&
              is_complete(double_rsqrt_rows, double_rsqrt_methods) &&
              is_complete(double_reciprocal_rows, double_reciprocal_methods));
RAYLANES_UNIT_TABLE(RootKernels, roots, rows_of(sqrt_rows, sqrt_choice), rows_of(rsqrt_rows, rsqrt_choice),
                    rows_of(reciprocal_rows, reciprocal_choice),
                    rows_of(double_sqrt_rows, double_sqrt_choice),
                    rows_of(double_rsqrt_rows, double_rsqrt_choice),
                    rows_of(double_reciprocal_rows, double_reciprocal_choice), sqrt_in_two_passes())

}  // namespace raylanes
