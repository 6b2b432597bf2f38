// Timing that survives a noisy machine: contenders take turns, medians are compared.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace raylanes::bench {

struct Timing {
  double median_seconds;
  double spread;  // (slowest − fastest) / median
};

// Runs every contender once to warm up, then all of them `rounds` times in turn, at least once. A contender
// is a call that does the whole work; result i belongs to contender i.
std::vector<Timing> take_turns(std::span<const std::function<void()>> contenders, int rounds);

}  // namespace raylanes::bench
