#include "instruction_counter.hpp"

#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace raylanes::bench {
namespace {

// Stops, then calls. Not inlined, so that two calls differ in `n` alone.
[[gnu::noinline]] void stop_and_run(const std::function<void(std::size_t)>& work, std::size_t n) {
  raise(SIGSTOP);
  work(n);
}

// Stops before, between and after the two calls.
[[noreturn]] void run_between_stops(const std::function<void(std::size_t)>& work, std::size_t n) {
  if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(1);
  // Once unseen: functions of shared libraries are looked up at their first call.
  raise(0);
  work(n);
  const std::size_t sizes[] = {n, 2 * n, 0};
  for (std::size_t i = 0; i < std::size(sizes); ++i) {
    asm volatile("" : "+r"(i));  // a loop that stays one, the same instructions each time
    stop_and_run(work, sizes[i]);
  }
  _exit(0);
}

// The child under the tracer.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() {
    if (gone_) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // The signal that it stops for, or 0 if it ends.
  int wait_for_stop() {
    int status = 0;
    while (waitpid(pid_, &status, 0) != pid_)
      if (errno != EINTR) return 0;
    gone_ = !WIFSTOPPED(status);
    return gone_ ? 0 : WSTOPSIG(status);
  }

  // Instructions up to the next stop that it makes by itself.
  std::optional<std::uint64_t> count_steps() {
    for (std::uint64_t steps = 1;; ++steps) {
      if (ptrace(PTRACE_SINGLESTEP, pid_, nullptr, nullptr) != 0) return std::nullopt;
      const int signal = wait_for_stop();
      if (signal == SIGSTOP) return steps;
      if (signal != SIGTRAP) return std::nullopt;
    }
  }

 private:
  pid_t pid_;
  bool gone_ = false;
};

}  // namespace

std::optional<double> instructions_per_primitive(const std::function<void(std::size_t)>& work,
                                                 std::size_t n) {
  const pid_t child = fork();
  if (child == -1) return std::nullopt;
  if (child == 0) run_between_stops(work, n);
  Child traced(child);
  if (traced.wait_for_stop() != SIGSTOP) return std::nullopt;
  const auto few = traced.count_steps(), many = few ? traced.count_steps() : std::nullopt;
  if (!many) return std::nullopt;
  return (static_cast<double>(*many) - static_cast<double>(*few)) / static_cast<double>(n);
}

}  // namespace raylanes::bench
