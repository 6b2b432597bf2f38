// How many threads a call may use in this process.
#pragma once

#include <pthread.h>

#include <atomic>

namespace raylanes::python {

// `threads`, or 1 if this process was forked after a call had used several. The threads of oneTBB stay in the parent,
// and a fork may leave its locks locked: one of 550 children of a busy parent hung. To ask for the process's number
// instead of hearing of forks takes longer than a call with one ray, where a system call is slow.
inline int usable_threads(int threads) {
  if (threads == 1 || threads < 0) return threads;
  static std::atomic<bool> are_used{false}, stay_in_parent{false};
  static const bool hears_of_forks =
      pthread_atfork(nullptr, nullptr, [] { stay_in_parent = are_used.load(); }) == 0;
  if (!hears_of_forks || stay_in_parent) return 1;
  if (!are_used) are_used = true;
  return threads;
}

}  // namespace raylanes::python
