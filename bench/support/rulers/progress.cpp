#include "progress.hpp"

#include <unistd.h>

#include "../readers/printable.hpp"

namespace raylanes::bench {
namespace {

constexpr std::chrono::milliseconds patience(2000);
constexpr std::chrono::milliseconds terminal_interval(200);
constexpr std::chrono::milliseconds line_interval(5000);

}  // namespace

ProgressLine::ProgressLine(const std::string& label)
    : label_(printable(label)), next_(Clock::now() + patience), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_ && terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::update(double share) {
  if (busy_.test_and_set(std::memory_order_acquire)) return;  // somebody else is writing
  const Clock::time_point now = Clock::now();
  if (now >= next_) {
    next_ = now + (terminal_ ? terminal_interval : line_interval);
    shown_ = true;
    std::fprintf(stderr, terminal_ ? "\r\033[K%s: %.0f %%" : "%s: %.0f %%\n", label_.c_str(), 100.0 * share);
    std::fflush(stderr);
  }
  busy_.clear(std::memory_order_release);
}

}  // namespace raylanes::bench
