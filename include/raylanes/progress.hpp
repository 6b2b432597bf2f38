// How long calls tell how far they are, and how they are ended early.
#pragma once

#include <functional>

namespace raylanes {

/// A function that a long call calls with the share of its work that is done: 0 first, 1 last, never decreasing.
/// If it throws, the call ends within the time of a part of the work, and the exception passes through.
/// A build calls it from any of its threads, one thread at a time. A query calls it from the calling thread alone,
/// about every 20 ms: it divides the batch into parts of about that time, by the time that the elements before took.
/// The function may call the library, but must not change what the call reads or writes.
using Progress = std::function<void(double)>;

}  // namespace raylanes
