// Instructions that a loop really executes, whatever its code looks like.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

namespace raylanes::bench {

// Executed instructions per primitive of `work`, a call over so many primitives: those of a call over 2n less those
// of a call over n, divided by n, so that what a call costs once drops out. Exact: a child process executes the
// calls one instruction at a time under ptrace (3 to 12 µs each). Loop control, moves and loads count; of branches
// that depend on the data, what these primitives take. `work` must be a loop of its own, without locks or threads.
// Nothing where the system does not permit ptrace, as an emulator does not.
std::optional<double> instructions_per_primitive(const std::function<void(std::size_t)>& work, std::size_t n);

}  // namespace raylanes::bench
