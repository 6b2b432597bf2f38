// How many threads a call may use in this process.
#pragma once

#include <unistd.h>

#include <atomic>

namespace raylanes::python {

// `threads`, or 1 if this process was forked after a call had used several. The threads of oneTBB stay in the parent,
// and a fork may leave its locks locked: one of 550 children of a busy parent hung.
inline int usable_threads(int threads) {
  if (threads == 1 || threads < 0) return threads;
  static std::atomic<pid_t> user{0};  // the process that was first to use several
  const pid_t self = getpid();
  pid_t first = 0;
  return user.compare_exchange_strong(first, self) || first == self ? threads : 1;
}

}  // namespace raylanes::python
