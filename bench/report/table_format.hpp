// Tables as text: aligned, Markdown, CSV.
#pragma once

#include "output.hpp"

namespace raylanes::bench {

enum class TableFormat : std::uint8_t { table, csv, markdown, json };
inline constexpr std::array<std::string_view, 4> table_format_names{"table", "csv", "markdown", "json"};

// A table without --columns has at most so many characters in a line.
inline constexpr std::size_t max_table_width = 100;
inline constexpr std::string_view column_gap = "  ";

// Characters of UTF-8 text.
std::size_t width_of(std::string_view text);

// Lines of cells, the titles first: aligned columns with numbers to the right, or a table of Markdown.
std::string aligned(const std::vector<std::vector<std::string>>& lines);
std::string markdown(const std::vector<std::vector<std::string>>& lines);

// JSON rows as CSV (RFC 4180, but with bare line feeds): a line of keys, then a line a row. Values in objects and in
// arrays of objects have names like "traces/0/spread"; a list of numbers is one cell of JSON. An absent value is an
// empty cell. `columns` names top-level keys; empty or {"all"}: all keys.
std::string csv(const Json& rows, const std::vector<std::string>& columns);

}  // namespace raylanes::bench
