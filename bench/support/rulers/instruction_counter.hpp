// The number of instructions that a loop executes.
#pragma once

#include "../std.hpp"

namespace raylanes::bench {

// Executed instructions per primitive of `work`, a call over so many primitives. The instructions of a call over n are
// subtracted from those that a call over 2n takes, and divided by n, so that the cost of a call drops out. The count is
// exact: a child process executes the calls one instruction at a time under ptrace (3 to 12 µs each). Loop control,
// moves and loads count; branches that depend on the data count as these primitives take them. `work` must be a loop of
// its own, without locks or threads. Returns nothing if the system does not permit ptrace, as an emulator does not.
std::optional<double> instructions_per_primitive(const std::function<void(std::size_t)>& work, std::size_t n);

}  // namespace raylanes::bench
