// Text of files and command lines, made fit for a terminal.
#pragma once

#include "../std.hpp"

namespace raylanes::bench {

inline constexpr std::size_t excerpt_length = 60;

// `text` for a terminal: UTF-8 as it is, every other byte and every control character (they move the cursor and set
// colours) as \xNN. Text longer than `limit` bytes loses its middle, marked by "…".
std::string printable(std::string_view text, std::size_t limit = excerpt_length);

}  // namespace raylanes::bench
