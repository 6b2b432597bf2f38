// What Python hears of a call of the library while the call works.
#pragma once

#include <chrono>
#include <cstddef>
#include <thread>

#include <raylanes/progress.hpp>

#include "owned.hpp"
#include "without_gil.hpp"

namespace raylanes::python {

// Whether this is the thread that handles signals: the oldest, as Python adds threads in front. After a fork it is the
// one that forked.
inline bool is_main_thread() {
  PyThreadState* const self = PyThreadState_Get();
  return PyThreadState_Next(self) == nullptr;
}

// A call without the GIL. About every 20 ms the calling thread takes the GIL for signals, on the main thread, and for
// the function `progress`, which gets the share of work done. An exception of it or of a handler ends the call.
// Builds tell of their progress from any of their threads: only what the calling thread tells is heard.
class Listener {
 public:
  // So few elements are not worth a look for signals.
  static constexpr std::size_t few = 16, many = few + 1;

  Listener(const py::object& progress, std::size_t elements)
      : function_(progress.is_none() ? nullptr : progress.ptr()) {
    if (!has_function() && (elements <= few || !is_main_thread())) return;
    next_ = Clock::now() + between_signals;
    progress_ = [this](double share) { hear(share); };
  }
  Listener() = default;
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // For the options of the call. Null if nobody listens.
  const Progress* progress() const { return progress_ ? &progress_ : nullptr; }

  // Work that needs the GIL, within without_gil().
  template <class Work>
  void with_gil(const Work& work) {
    released_->with_gil(work);
  }
  template <class Work>
  auto without_gil(const Work& work) {
    WithoutGil released;
    released_ = &released;
    return work();
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds between_signals{20};

  bool has_function() const { return function_ != nullptr; }
  void hear(double share) {
    if (std::this_thread::get_id() != caller_) return;
    if (!has_function() && Clock::now() < next_) return;
    released_->with_gil([&] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (has_function()) {
        const py::object number = not_null(PyFloat_FromDouble(share));
        not_null(PyObject_CallOneArg(function_, number.ptr()));
      }
    });
    next_ = Clock::now() + between_signals;
  }

  PyObject* function_ = nullptr;  // the arguments of the call keep it
  const std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point next_ = {};
  Progress progress_;
  WithoutGil* released_ = nullptr;
};

}  // namespace raylanes::python
