#include "double_survey.hpp"

#include <random>

#include "../../../dispatch/table/kernel_table.hpp"

namespace raylanes::bench {
namespace {

using DoubleLimits = std::numeric_limits<double>;

// The residual of a rounded result is exact but for its last bits, and says what is left.
ExactResult exact_root(long double a) {
  const long double root = std::sqrt(a);
  return {root, std::fma(-root, root, a) / (2 * root)};
}
ExactResult exact_reciprocal_root(long double a) {
  const long double y = 1 / std::sqrt(a), product = a * y;
  return {y, (std::fma(-product, y, 1.0L) - std::fma(a, y, -product) * y) * y / 2};
}
ExactResult exact_reciprocal(long double a) {
  const long double y = 1 / a;
  return {y, std::fma(-a, y, 1.0L) * y};
}

// One offers fewer accuracies: a correctly rounded reciprocal root would need more than anybody knows.
template <class Method, std::size_t count>
void add_rows(std::vector<JudgedDoubleRoot>& rows, const char* function, const Path& path,
              const RootRows<double, Method, count>& table,
              const std::array<RootMethodInfo<Method>, count>& methods, ExactRoot exact) {
  for (std::size_t m = 0; m < count; ++m) {
    JudgedDoubleRoot row;
    row.function_name = function, row.promise = &methods[m].promise, row.on_path = &path;
    row.kernel = table.by[m], row.exact = exact;
    for (const AccuracyInfo& info : accuracies)
      if (table.within[static_cast<std::size_t>(info.accuracy)] == methods[m].method &&
          (exact != exact_reciprocal_root || info.accuracy != Accuracy::correctly_rounded))
        row.served.push_back(info.accuracy);
    rows.push_back(std::move(row));
  }
}

std::vector<double> sample_of_doubles(std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-1000, 1000), number(1, 4);
  std::vector<double> x(count);
  for (std::size_t i = 0; i < count; ++i) x[i] = i % 2 == 0 ? number(random) : std::exp2(exponent(random));
  return x;
}

bool same_special(double one, double other) {
  return std::isnan(other) ? std::isnan(one)
                           : std::bit_cast<std::uint64_t>(one) == std::bit_cast<std::uint64_t>(other);
}

bool are_specials_right(const JudgedDoubleRoot& row) {
  for (const double x :
       {0.0, -0.0, DoubleLimits::infinity(), -DoubleLimits::infinity(), DoubleLimits::quiet_NaN(), -2.0})
    for (const std::size_t place : {0, 5, 16, 99}) {
      std::array<double, 100> in, out;
      in.fill(3), in[place] = x;
      row.kernel(in.data(), out.data(), in.size());
      if (x != -2.0 || row.exact != exact_reciprocal) {
        if (!same_special(out[place], static_cast<double>(row.exact(static_cast<long double>(x)).value)))
          return false;
      }
    }
  return true;
}

void judge(JudgedDoubleRoot& row, const std::vector<double>& x, const std::vector<ExactResult>& exact,
           std::vector<double>& y) {
  row.kernel(x.data(), y.data(), x.size());
  row.inputs = x.size(), row.specials_ok = are_specials_right(row);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto [value, rest] = exact[i];
    const long double off = std::fabs(static_cast<long double>(y[i]) - value - rest);
    const long double unit = std::ldexp(1.0L, std::ilogb(value) - (DoubleLimits::digits - 1));
    const double ulp = std::isnan(y[i]) ? DoubleLimits::infinity() : static_cast<double>(off / unit);
    if (ulp <= 0.5) ++row.rounded_correctly;
    if (ulp > row.largest_ulp) row.largest_ulp = ulp, row.largest_ulp_at = x[i];
    row.largest_relative_error = std::max(row.largest_relative_error, static_cast<double>(off / value));
  }
}

}  // namespace

bool JudgedDoubleRoot::serves(Accuracy wanted) const {
  return std::find(served.begin(), served.end(), wanted) != served.end();
}

bool JudgedDoubleRoot::keeps_promise() const {
  return largest_ulp <= max_ulp_promised() && specials_ok;
}

std::vector<JudgedDoubleRoot> judged_double_roots(std::span<const Path* const> paths, std::size_t count) {
  std::vector<JudgedDoubleRoot> rows;
  for (const Path* path : paths) {
    const RootKernels& roots = kernels_of(*path).roots;
    add_rows(rows, "double_sqrt", *path, roots.double_sqrt, double_sqrt_methods, exact_root);
    add_rows(rows, "double_rsqrt", *path, roots.double_rsqrt, double_rsqrt_methods, exact_reciprocal_root);
    add_rows(rows, "double_reciprocal", *path, roots.double_reciprocal, double_reciprocal_methods,
             exact_reciprocal);
  }
  const std::vector<double> x = sample_of_doubles(count);
  std::vector<double> y(count);
  std::vector<ExactResult> exact(count);
  ExactRoot known = nullptr;
  for (JudgedDoubleRoot& row : rows) {
    if (row.exact != std::exchange(known, row.exact))
      std::ranges::transform(x, exact.begin(),
                             [&](double a) { return row.exact(static_cast<long double>(a)); });
    judge(row, x, exact, y);
  }
  return rows;
}

}  // namespace raylanes::bench
