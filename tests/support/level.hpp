// How much a test program tries.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace raylanes::testing {

// Named edge cases are the same at each level; random and sampled ones grow, the least of each check beside it:
// quick for machines that are emulated or instrumented and for mutants; usual by tests/run; all by tests/run --all;
// exhaustive with all 2^32 floats where the others take samples.
enum class Level { quick, usual, all, exhaustive };

// That which the environment variable RAYLANES_LEVEL names; usual without one. Ends the program at any other name.
inline Level level() {
  const char* const value = std::getenv("RAYLANES_LEVEL");
  const std::string_view name = value != nullptr ? value : "usual";
  if (name == "quick") return Level::quick;
  if (name == "usual") return Level::usual;
  if (name == "all") return Level::all;
  if (name == "exhaustive") return Level::exhaustive;
  std::fprintf(stderr, "RAYLANES_LEVEL: there is no level \"%s\"; levels: quick, usual, all, exhaustive\n",
               value);
  std::exit(2);
}

inline bool quick() {
  return level() == Level::quick;
}
inline bool exhaustive() {
  return level() == Level::exhaustive;
}

// The cost of a check at a level: the heaviest ones have a number for each.
template <class T>
T by_level(T quick, T usual, T all) {
  return level() == Level::quick ? quick : level() == Level::usual ? usual : all;
}

// A sixth of so many cases where quick() holds, a quarter as usual and half at level all, but 60 at least.
inline std::size_t by_level(std::size_t most) {
  const std::size_t some = exhaustive() ? most : by_level(most / 6, most / 4, most / 2);
  return std::max<std::size_t>(some, std::min<std::size_t>(most, 60));
}

}  // namespace raylanes::testing
