#include "port_model.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace raylanes::bench {
namespace {

// Zen 3, per register of 16 or 32 bytes, as measured by loops of independent instructions on one: two pipes
// multiply, fuse and estimate; four do additions of integers and logic, two of them (not the multipliers)
// additions of floats; the divider takes 5 cycles for a root and 3 or more for a quotient; one store a cycle.
constexpr double root_cycles = 5.0, quotient_cycles = 3.0;

// Operations per register: of the two multiplying pipes, of any pipe beyond these, roots, quotients.
struct Operations {
  double multiply, other, roots, quotients;
};

constexpr Operations without_fma(Operations fused, double fused_count) {
  fused.other += fused_count;  // the addition apart
  return fused;
}

// In the order of the enumerations; `other` includes the operations of the block's test, four or,
// where NaN needs none, two. Additions of
// floats and shifts, which have two pipes, count as any: the bound stays one.
Operations sqrt_operations(std::size_t method, bool fma) {
  const auto plain = [&](Operations o, double fused_count) { return fma ? o : without_fma(o, fused_count); };
  switch (static_cast<SqrtMethod>(method)) {
    case SqrtMethod::classic_0:
      return {0, 6, 0, 0};
    case SqrtMethod::classic_1:
      return {1, 7, 0, 1};
    case SqrtMethod::classic_2:
      return {2, 8, 0, 2};
    case SqrtMethod::classic_3:
      return {3, 9, 0, 3};
    case SqrtMethod::weighted_1:
      return {2, 7, 0, 1};
    case SqrtMethod::weighted_2:
      return {3, 8, 0, 2};
    case SqrtMethod::halley:
      return {4, 8, 0, 1};
    case SqrtMethod::polynomial_1:
      return {4, 7, 0, 0};
    case SqrtMethod::polynomial_2:
      return {5, 8, 0, 0};
    case SqrtMethod::polynomial_3:
      return {6, 9, 0, 0};
    case SqrtMethod::polynomial_2_residual:
      return plain({7, 9, 0, 0}, 2);
    case SqrtMethod::estimate:
    case SqrtMethod::estimate_beside_hardware:
      return {2, 2, 0, 0};
    case SqrtMethod::estimate_newton:
      return plain({5, 3, 0, 0}, 2);
    case SqrtMethod::estimate_residual:
    case SqrtMethod::estimate_residual_beside_hardware:
      return plain({4, 3, 0, 0}, 2);
    case SqrtMethod::estimate_two_residuals:
    case SqrtMethod::estimate_two_residuals_beside_hardware:
      return plain({6, 3, 0, 0}, 4);
    case SqrtMethod::goldschmidt:
    case SqrtMethod::goldschmidt_beside_hardware:
      return fma ? Operations{7, 3, 0, 0} : Operations{1, 0, 1, 0};
    default:
      return {1, 0, 1, 0};
  }
}

Operations other_operations(const RootRow& row) {
  const double fused = row.path->table.has_fma ? 0.0 : 1.0;
  if (row.function == RootFunction::rsqrt) {
    constexpr std::array<Operations, 6> rows{
        {{5, 7, 0, 0}, {9, 8, 0, 0}, {5, 7, 0, 0}, {1, 2, 0, 0}, {4, 3, 0, 0}, {2, 0, 1, 1}}};
    Operations o = rows[row.method];
    if (row.method == 4) o.other += 2 * fused;
    return o;
  }
  constexpr std::array<Operations, 4> rows{{{1, 3, 0, 0}, {3, 3, 0, 0}, {3, 3, 0, 0}, {1, 0, 0, 1}}};
  Operations o = rows[row.method];
  if (row.method == 1 || row.method == 2) o.other += static_cast<double>(row.method) * fused;
  return o;
}

bool shares_with_divider(const RootRow& row) {
  return row.promise().name.ends_with("_beside_hardware") &&
         !(row.promise().reproducible && !row.path->table.has_fma);
}

bool has_one_lane(const RootRow& row) {
  return row.path->table.lanes == 1 ||
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
  const Operations o = row.function == RootFunction::sqrt
                           ? sqrt_operations(row.method, row.path->table.has_fma)
                           : other_operations(row);
  PortBound bound{o.multiply / 2, "multipliers"};
  const auto at_least = [&](double cycles, const char* unit) {
    if (cycles > bound.cycles) bound = {cycles, unit};
  };
  at_least((o.multiply + o.other) / 4, "vector units");
  at_least(o.roots * root_cycles + o.quotients * quotient_cycles, "divider");
  if (shares_with_divider(row)) {
    // In the time of one root of the divider, which takes one slot of a multiplying pipe to start.
    const double beside =
        std::min({(2 * root_cycles - 1) / o.multiply, (4 * root_cycles - 1) / (o.multiply + o.other)});
    bound = {root_cycles / (1 + beside), "multipliers and divider"};
  }
  at_least(1.0, "stores");
  return PortBound{bound.cycles / row.path->table.lanes, bound.unit};
}

}  // namespace raylanes::bench
