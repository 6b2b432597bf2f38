// What the execution units of a processor allow at best: a bound to hold a measured time against.
#pragma once

#include <optional>
#include <string>

#include "root_survey.hpp"

namespace raylanes::bench {

// Nanoseconds of one processor cycle now, by a chain of additions that wait for each other.
double nanoseconds_per_cycle();

// The least cycles per value that `row` can take with its arrays in the first-level cache, and what sets it:
// "multipliers", "adders", "vector units", "divider" or "stores". Nothing on a processor that the model does
// not know (it knows AMD's Zen 3) and for the forms with one lane.
struct PortBound {
  double cycles;
  std::string unit;
};
std::optional<PortBound> port_bound(const RootRow& row);

}  // namespace raylanes::bench
