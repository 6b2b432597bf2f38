#include "port_model.hpp"

#include <algorithm>
#include <chrono>

namespace raylanes::bench {
namespace {

// Zen 3, per register of 16 or 32 bytes, as measured by loops of independent instructions on one: two pipes
// multiply, fuse and estimate; two others add and take minimum and maximum; integers and logic run on any of
// the four; the divider takes 5 cycles for a root and 3 for a quotient, and each of them two slots of the
// multiplying pipes to start; one store a cycle. What a block's test costs once, a comparison and a branch,
// is left out.
constexpr double root_cycles = 5.0, quotient_cycles = 3.0, divider_slots = 2.0;

// Operations per register: of the two multiplying pipes, of the two adding ones, of any pipe, roots,
// quotients.
struct Operations {
  double multiply, add, any, roots, quotients;
};

constexpr Operations operator+(const Operations& a, const Operations& b) {
  return {a.multiply + b.multiply, a.add + b.add, a.any + b.any, a.roots + b.roots,
          a.quotients + b.quotients};
}
constexpr Operations operator*(double n, const Operations& a) {
  return {n * a.multiply, n * a.add, n * a.any, n * a.roots, n * a.quotients};
}

constexpr Operations trick{0, 0, 2, 0, 0}, heron_step{1, 1, 0, 0, 1}, root{0, 0, 0, 1, 0},
    quotient{0, 0, 0, 0, 1}, multiplication{1, 0, 0, 0, 0}, estimate{1, 0, 0, 0, 0};

// What a path has, and with it what the parts of methods cost.
struct Costs {
  bool fma;
  Operations fused() const { return fma ? multiplication : Operations{1, 1, 0, 0, 0}; }
  Operations half() const { return fma ? Operations{0, 0, 1, 0, 0} : multiplication; }
  // The tests of a block, as in kernels/meant_values.hpp: by minimum and maximum, by bits or comparisons, by
  // the least value, by a witness where bits have a maximum.
  Operations by_extremes() const { return {0, 2, 0, 0, 0}; }
  Operations by_range() const { return fma ? Operations{0, 0, 2, 0, 0} : Operations{0, 2, 2, 0, 0}; }
  Operations by_least() const { return {0, 1, 0, 0, 0}; }
  Operations by_witness() const { return fma ? Operations{0, 0, 1, 0, 0} : by_extremes(); }

  Operations polynomial(double degree) const { return trick + Operations{3 + degree, degree, 0, 0, 0}; }
  Operations residuals(double steps) const {
    return estimate + multiplication + half() + 2 * steps * fused() + by_witness();
  }
};

Operations sqrt_operations(SqrtMethod method, const Costs& c) {
  switch (method) {
    case SqrtMethod::classic_0:
    case SqrtMethod::classic_1:
    case SqrtMethod::classic_2:
    case SqrtMethod::classic_3: {
      const int steps = static_cast<int>(method) - static_cast<int>(SqrtMethod::classic_0);
      return trick + steps * heron_step + (steps == 1 ? c.by_least() : c.by_range());
    }
    case SqrtMethod::weighted_1:
      return trick + Operations{2, 1, 0, 0, 1} + c.by_least();
    case SqrtMethod::weighted_2:
      return trick + Operations{2, 1, 0, 0, 1} + heron_step + c.by_range();
    case SqrtMethod::halley:
      return trick + Operations{4, 2, 0, 0, 1} + c.by_range();
    case SqrtMethod::polynomial_1:
      return c.polynomial(1) + c.by_range();
    case SqrtMethod::polynomial_2:
      return c.polynomial(2) + c.by_least();
    case SqrtMethod::polynomial_3:
      return c.polynomial(3) + c.by_range();
    case SqrtMethod::polynomial_2_residual:
      return c.polynomial(2) + multiplication + c.half() + 2 * c.fused() + c.by_range();
    case SqrtMethod::estimate:
    case SqrtMethod::estimate_beside_hardware:
      return estimate + multiplication + c.by_witness();
    case SqrtMethod::estimate_unchecked:
      return estimate + multiplication;
    case SqrtMethod::estimate_newton:
      return estimate + 2 * multiplication + c.half() + 2 * c.fused() + c.by_witness();
    case SqrtMethod::estimate_residual:
    case SqrtMethod::estimate_residual_beside_hardware:
      return c.residuals(1);
    case SqrtMethod::estimate_two_residuals:
    case SqrtMethod::estimate_two_residuals_beside_hardware:
      return c.residuals(2);
    case SqrtMethod::goldschmidt:
    case SqrtMethod::goldschmidt_beside_hardware:
      return c.fma ? estimate + multiplication + c.half() + 5 * c.fused() + c.by_witness() : root;
    default:
      return root;
  }
}

Operations rsqrt_operations(RsqrtMethod method, const Costs& c) {
  switch (method) {
    case RsqrtMethod::quake_1:
      return trick + Operations{4, 1, 0, 0, 0} + c.by_range();
    case RsqrtMethod::quake_2:
      return trick + Operations{7, 2, 0, 0, 0} + c.by_range();
    case RsqrtMethod::kadlec:
      return trick + Operations{4, 1, 0, 0, 0} + c.by_range();
    case RsqrtMethod::estimate:
      return estimate + c.by_witness();
    case RsqrtMethod::estimate_newton:
      return estimate + multiplication + c.half() + 2 * c.fused() + c.by_witness();
    default:
      return root + quotient;
  }
}

Operations reciprocal_operations(ReciprocalMethod method, const Costs& c) {
  const Operations magnitude{0, 0, 1, 0, 0};
  switch (method) {
    case ReciprocalMethod::estimate:
      return estimate + magnitude + c.by_extremes();
    case ReciprocalMethod::estimate_newton:
      return estimate + multiplication + c.fused() + magnitude + c.by_extremes();
    case ReciprocalMethod::estimate_residual:
      return estimate + 2 * c.fused() + magnitude + c.by_extremes();
    default:
      return quotient;
  }
}

Operations operations_of(const RootRow& row) {
  const Costs costs{row.path->has_fma()};
  if (row.function == RootFunction::sqrt) return sqrt_operations(static_cast<SqrtMethod>(row.method), costs);
  if (row.function == RootFunction::rsqrt)
    return rsqrt_operations(static_cast<RsqrtMethod>(row.method), costs);
  return reciprocal_operations(static_cast<ReciprocalMethod>(row.method), costs);
}

bool shares_with_divider(const RootRow& row) {
  return row.promise().name.ends_with("_beside_hardware") &&
         !(row.promise().reproducible && !row.path->has_fma());
}

bool has_one_lane(const RootRow& row) {
  return row.path->lanes == 1 ||
         (row.function == RootFunction::sqrt &&
          row.method >= static_cast<std::size_t>(SqrtMethod::classic_0_one_at_a_time));
}

}  // namespace

double nanoseconds_per_cycle() {
  using Clock = std::chrono::steady_clock;
  double best = 1e9;
  for (int round = 0; round < 200; ++round) {
    const auto start = Clock::now();
    std::uint64_t x = 1;
    constexpr int steps = 16384;
    for (int i = 0; i < steps; i += 8) {
#pragma GCC unroll 8
      for (int k = 0; k < 8; ++k) {
        x += 3;
        asm volatile("" : "+r"(x));
      }
    }
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count() / steps);
  }
  return best;
}

std::optional<PortBound> port_bound(const RootRow& row) {
  if (!__builtin_cpu_is("znver3") || has_one_lane(row)) return std::nullopt;
  const Operations o = operations_of(row);
  const double multiply = o.multiply + divider_slots * (o.roots + o.quotients);
  const double vector = multiply + o.add + o.any;
  PortBound bound{multiply / 2, "multipliers"};
  const auto at_least = [&](double cycles, const char* unit) {
    if (cycles > bound.cycles) bound = {cycles, unit};
  };
  at_least(o.add / 2, "adders");
  at_least(vector / 4, "vector units");
  at_least(o.roots * root_cycles + o.quotients * quotient_cycles, "divider");
  if (shares_with_divider(row)) {
    // In the time of one root of the divider.
    const double beside =
        std::min((2 * root_cycles - divider_slots) / multiply, (4 * root_cycles - divider_slots) / vector);
    bound = {root_cycles / (1 + beside), "multipliers and divider"};
  }
  at_least(1.0, "stores");
  return PortBound{bound.cycles / row.path->lanes, bound.unit};
}

}  // namespace raylanes::bench
