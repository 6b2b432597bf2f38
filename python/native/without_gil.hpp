// Work without Python's global interpreter lock.
#pragma once

#include <Python.h>
#include <unistd.h>

namespace raylanes::python {

// Releases the lock for a scope. At the end of the interpreter, CPython ends a thread that waits for the lock by
// unwinding it. That would pass functions that must not throw, and free Python objects without the lock. Such a thread
// sleeps here instead until the process is gone.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;
  ~WithoutGil() { take(); }

  // Work that needs the lock, within the scope.
  template <class Work>
  void with_gil(const Work& work) {
    take();
    try {
      work();
    } catch (...) {
      state_ = PyEval_SaveThread();
      throw;
    }
    state_ = PyEval_SaveThread();
  }

 private:
  void take() noexcept {
    try {
      PyEval_RestoreThread(state_);
    } catch (...) {
      for (;;) pause();
    }
  }

  PyThreadState* state_;
};

}  // namespace raylanes::python
