// Enumerators, sizes and paths as users give them: checked, or std::invalid_argument with one line that names the
// function, what is wrong, its value and what is allowed.
#pragma once

#include <atomic>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <raylanes/paths.hpp>

namespace raylanes {
namespace detail {

// The forced path, else the one that RAYLANES_PATH or the machine chose; null until a call asks.
extern constinit std::atomic<const Path*> path_in_use;

[[gnu::cold, gnu::noinline]] const Path& resolve_path();

}  // namespace detail

// The same path as active_path(), inline.
inline const Path& path_in_use() {
  const Path* const path = detail::path_in_use.load(std::memory_order_acquire);
  return path != nullptr ? *path : detail::resolve_path();
}

// These throw out of line, so that short calls pay for the comparison alone.
[[noreturn, gnu::cold, gnu::noinline]] inline void refuse_index(const char* function, const char* what,
                                                                std::size_t index, std::size_t count) {
  throw std::invalid_argument(std::string(function) + ": " + what + ' ' + std::to_string(index) +
                              " does not exist; allowed are 0 to " + std::to_string(count - 1));
}
[[noreturn, gnu::cold, gnu::noinline]] inline void refuse_size(const char* function, const char* array,
                                                               std::size_t size, const char* as,
                                                               std::size_t wanted) {
  throw std::invalid_argument(std::string(function) + ": " + array + " has " + std::to_string(size) +
                              " elements, " + as + " has " + std::to_string(wanted) +
                              "; they must have the same number");
}

// A number in a message, as the shortest text that reads back as the same number: "1e-09", "0.1", "nan".
// std::to_string() rounds to six decimals, so that -1e-9 looks like a zero.
template <std::floating_point T>
std::string text_of(T number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

// The number of an enumerator, which may have been cast from anything, if it is below `count`.
template <class Enumerator>
std::size_t checked_index(const char* function, const char* what, Enumerator enumerator, std::size_t count) {
  static_assert(std::is_enum_v<Enumerator>);
  const auto index = static_cast<std::size_t>(enumerator);
  if (index >= count) refuse_index(function, what, index, count);
  return index;
}

// The row of an enumerator in an array that has one for each.
template <class Enumerator, class Rows>
auto& checked_row(const char* function, const char* what, Rows& rows, Enumerator enumerator) {
  return rows[checked_index(function, what, enumerator, std::size(rows))];
}

// The path of a call: null is the one in use. Throws std::invalid_argument for one that this machine lacks, and as
// active_path does.
inline const Path& checked_path(const Path* path) {
  if (path == nullptr) return path_in_use();
  return supported(*path) ? *path : find_path(path->name);  // throws, and says what is lacking
}

// Throws where counters are asked for that the build lacks.
inline void require_counters(const char* function, bool has_counters) {
  if (!has_counters)
    throw std::invalid_argument(
        std::string(function) +
        ": this build has no counters; its option -Dcounters=true would give it some");
}

// Throws for a negative thread count; see TraceOptions.
inline void require_threads(const char* function, int threads) {
  if (threads < 0)
    throw std::invalid_argument(std::string(function) + ": " + std::to_string(threads) +
                                " threads, allowed are 0 (those of the arena), 1, 2, …");
}

// The square of a distance that closest points must keep, exact; negative where no point keeps it.
inline double max_squared(float max_distance) {
  return max_distance >= 0.0f ? static_cast<double>(max_distance) * static_cast<double>(max_distance) : -1.0;
}

// Throws unless an array that is to have as many elements as another has them.
inline void require_size(const char* function, const char* array, std::size_t size, const char* as,
                         std::size_t wanted) {
  if (size != wanted) refuse_size(function, array, size, as, wanted);
}

}  // namespace raylanes
