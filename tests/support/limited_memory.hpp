// Memory that runs out on purpose. Programs that link this have the operators new and delete of limited_memory.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>

namespace raylanes::testing {

inline constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

// Whether the call throws std::bad_alloc if so many allocations succeed, none of them larger than `bytes`. The call
// runs on a new thread, which keeps no memory of earlier calls. Later allocations fail, too, but for those that
// `fails_once` lets succeed.
bool runs_out(std::size_t allocations, std::size_t bytes, const std::function<void()>& call,
              bool fails_once = false);

}  // namespace raylanes::testing
