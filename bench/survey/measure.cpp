#include "measure.hpp"

#include <algorithm>
#include <chrono>

namespace raylanes::bench {
namespace {

double seconds_of(const std::function<void()>& work) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::vector<Timing> take_turns(std::span<const std::function<void()>> contenders, int rounds) {
  std::vector<std::vector<double>> seconds(contenders.size());
  for (const auto& work : contenders) work();
  for (int round = 0; round < std::max(rounds, 1); ++round)
    for (std::size_t i = 0; i < contenders.size(); ++i) seconds[i].push_back(seconds_of(contenders[i]));
  std::vector<Timing> timings;
  for (std::vector<double>& s : seconds) {
    std::sort(s.begin(), s.end());
    const double median = s[s.size() / 2];
    timings.push_back({median, (s.back() - s.front()) / median});
  }
  return timings;
}

}  // namespace raylanes::bench
