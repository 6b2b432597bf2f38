#include "measure.hpp"

#include <chrono>
#include <random>

namespace raylanes::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Between the numbers where the position is not whole.
double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  return std::lerp(sorted[below], sorted[std::min(below + 1, sorted.size() - 1)], at - std::floor(at));
}

}  // namespace

double seconds_of(const std::function<void()>& work) {
  const Clock::time_point start = Clock::now();
  work();
  return seconds_since(start);
}

std::vector<Timing> take_turns(std::span<const std::function<void()>> contenders, const Budget& budget,
                               const std::function<void(double)>& after_round) {
  std::vector<std::function<double()>> timed;
  for (const auto& work : contenders) timed.push_back([&work] { return seconds_of(work); });
  return take_timed_turns(timed, budget, after_round);
}

std::vector<Timing> take_timed_turns(std::span<const std::function<double()>> contenders,
                                     const Budget& budget, const std::function<void(double)>& after_round) {
  if (contenders.empty()) return {};
  for (const auto& work : contenders) work();
  std::vector<Timing> timings(contenders.size());
  const Clock::time_point begin = Clock::now();
  const auto min_rounds = static_cast<std::size_t>(std::max(budget.min_rounds, 1));
  std::vector<std::size_t> order(contenders.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(1);
  for (std::size_t round = 0; round < min_rounds || seconds_since(begin) < budget.seconds; ++round) {
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t i : order) timings[i].seconds.push_back(contenders[i]());
    if (after_round) after_round(std::min(1.0, seconds_since(begin) / budget.seconds));
  }
  for (Timing& timing : timings) {
    const Quartiles quartiles = quartiles_of(timing.seconds);
    timing.median_seconds = quartiles.median;
    timing.spread = (quartiles.third - quartiles.first) / quartiles.median;
  }
  return timings;
}

Quartiles quartiles_of(std::vector<double> numbers) {
  std::sort(numbers.begin(), numbers.end());
  return {quantile(numbers, 0.5), quantile(numbers, 0.25), quantile(numbers, 0.75)};
}

double geometric_mean(const std::vector<double>& numbers) {
  double logarithms = 0.0;
  for (const double number : numbers) logarithms += std::log(number);
  return std::exp(logarithms / static_cast<double>(numbers.size()));
}

bool ratios_mean_something() {
#ifdef __OPTIMIZE__
  return true;
#else
  return false;
#endif
}

Quartiles speed_ratio(const Timing& ours, const Timing& theirs) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!ratios_mean_something()) return {none, none, none};
  std::vector<double> ratios;
  for (std::size_t round = 0; round < ours.seconds.size(); ++round)
    ratios.push_back(theirs.seconds[round] / ours.seconds[round]);
  return quartiles_of(std::move(ratios));
}

}  // namespace raylanes::bench
