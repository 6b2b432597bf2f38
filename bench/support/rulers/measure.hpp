// Timing that survives a noisy machine: contenders take turns, and are compared round by round.
#pragma once

#include "../std.hpp"

namespace raylanes::bench {

// The seconds of one call.
double seconds_of(const std::function<void()>& work);

// How long a measurement may take; slow contenders get `min_rounds` nevertheless.
struct Budget {
  double seconds = 1.0;
  int min_rounds = 5;
};

struct Timing {
  std::vector<double> seconds;  // of each round
  double median_seconds = 0.0;
  double spread = 0.0;  // (third quartile − first) / median: half of the rounds lie that close together
};

// Runs every contender once to warm up, then all of them, round by round, until the time is up. Each round has its own
// random order, the same in each run of the program, so that none always follows the same one. A contender is a call
// that does the whole work; result i belongs to contender i, and all have as many rounds.
// `after_round`, if any, is called with the share of the time that is gone.
std::vector<Timing> take_turns(std::span<const std::function<void()>> contenders, const Budget& budget,
                               const std::function<void(double)>& after_round = {});

// The same with contenders that time themselves and return the seconds that count.
std::vector<Timing> take_timed_turns(std::span<const std::function<double()>> contenders,
                                     const Budget& budget,
                                     const std::function<void(double)>& after_round = {});

// Median and quartiles of some numbers, which must not be empty.
struct Quartiles {
  double median, first, third;
};
Quartiles quartiles_of(std::vector<double> numbers);

// The geometric mean of numbers above zero; NaN without numbers.
double geometric_mean(const std::vector<double>& numbers);

// Whether this build is optimized. The tool's own sources and tests always are, so that they have to ask here.
bool ratios_mean_something();

// How many times as fast `ours` is as `theirs`, in each round: noise that lasts longer than a round hits both.
// They must be of one call of take_turns. NaN in a build without optimization, whose ratios mean nothing.
Quartiles speed_ratio(const Timing& ours, const Timing& theirs);

}  // namespace raylanes::bench
