// Tells people on standard error that something long is under way.
#pragma once

#include <atomic>
#include <chrono>
#include <string>

namespace raylanes::bench {

// Silent for the first two seconds; then a line "label: 42 %" that is rewritten on a terminal, or a new line
// every five seconds elsewhere. `update` may be called from any thread, as often as one likes.
class ProgressLine {
 public:
  explicit ProgressLine(const std::string& label);
  ~ProgressLine();  // wipes the line of a terminal
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void update(double share);  // 0 … 1

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  Clock::time_point next_;
  bool terminal_;
  bool shown_ = false;
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
};

}  // namespace raylanes::bench
