// Reports from loops of many small steps, such as the comparisons of a sort.
#pragma once

#include <chrono>

#include <raylanes/progress.hpp>

#include "../standard.hpp"

namespace raylanes {

// Calls a Progress every 10 ms or so, at one of many steps. Its exceptions pass through the step.
class Pulse {
 public:
  // Nobody is told.
  Pulse() = default;
  // `steps` is about how many steps there will be. A null or empty Progress is told nothing.
  Pulse(const Progress* progress, double steps) : progress_(progress), steps_(std::max(steps, 1.0)) {
    if (progress != nullptr && *progress) left_ = steps_of_a_look;
  }
  void step() {
    if (--left_ == 0) look();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint64_t steps_of_a_look = 1 << 14;
  static constexpr std::chrono::milliseconds between_reports{10};

  [[gnu::noinline]] void look() {
    left_ = steps_of_a_look, done_ += static_cast<double>(steps_of_a_look);
    if (Clock::now() < next_) return;
    (*progress_)(std::min(done_ / steps_, 1.0));
    next_ = Clock::now() + between_reports;
  }

  const Progress* progress_ = nullptr;
  double steps_ = 1.0, done_ = 0.0;
  std::uint64_t left_ = std::numeric_limits<std::uint64_t>::max();
  Clock::time_point next_ = {};
};

}  // namespace raylanes
