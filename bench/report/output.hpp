// The output of all commands: tables for people, JSON for programs.
#pragma once

#include <nlohmann/json.hpp>

#include "../support/std.hpp"

namespace raylanes::bench {

using Json = nlohmann::ordered_json;

// One line: processor, cores, compiler and date, which a figure means nothing without. JSON has more.
std::string machine_line();

// Writes {"schema_version": 1, "machine": …, "rows": rows} by write_whole_file(); what is no UTF-8 in names becomes
// U+FFFD. "-" is standard output. Throws OutputError naming the file if it cannot be written.
void write_json(const std::string& file, const Json& rows);

// From now on std::cout is standard error, so that standard output has rows for programs only.
void keep_standard_output_for_rows();

// Throws OutputError if something printed got lost: a full disk, a closed pipe.
void check_standard_output();

// A number with `digits` significant digits, in plain notation where that is short.
std::string significant(double x, int digits);
std::string milliseconds(double seconds);
std::string hexadecimal(const char* format, unsigned long long bits);

}  // namespace raylanes::bench
