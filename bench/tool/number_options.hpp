// Options that take numbers. Each option refuses text that is not a decimal number within its limits.
#pragma once

#include <charconv>
#include <concepts>
#include <system_error>

#include <CLI/CLI.hpp>

#include "../support/readers/printable.hpp"

namespace raylanes::bench {

template <class Number>
struct Limits {
  Number lowest, highest;
};

// Returns the number that is all of `text`. Nothing if `text` is empty or has other characters, or if the number is
// beyond the limits, an infinity or NaN.
template <class Number>
std::optional<Number> number_in(std::string_view text, const Limits<Number>& limits) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || last != end) return std::nullopt;
  return number >= limits.lowest && number <= limits.highest ? std::optional(number) : std::nullopt;
}

// Throws CLI::ValidationError, which names the option, the text that was given and what is allowed.
template <class Number>
[[noreturn]] void refuse_number(const std::string& option, const std::string& text,
                                const std::string& allowed, const Limits<Number>& limits) {
  std::ostringstream why;
  why << '"' << printable(text) << "\" is not " << allowed << " from " << limits.lowest << " to "
      << limits.highest;
  throw CLI::ValidationError(option, why.str());
}

template <class Number>
std::string type_name_of(const Limits<Number>& limits) {
  std::ostringstream name;
  name << (std::integral<Number> ? "INT" : "FLOAT") << " in [" << limits.lowest << " - " << limits.highest
       << ']';
  return name.str();
}

// An option that takes one number; help shows the limits, and the value before parsing as the default.
template <class Number>
CLI::Option* add_number(CLI::App& command, const std::string& option, Number& value,
                        const Limits<std::type_identity_t<Number>>& limits, const std::string& what) {
  const auto take = [&value, option, limits](const std::string& text) {
    const std::optional<Number> number = number_in<Number>(text, limits);
    if (!number)
      refuse_number<Number>(option, text, std::integral<Number> ? "an integer" : "a number", limits);
    value = *number;
  };
  std::ostringstream before;
  before << value;
  return command.add_option_function<std::string>(option, take, what)
      ->type_name(type_name_of<Number>(limits))
      ->default_str(before.str());
}

// An option that takes a list of numbers with commas.
template <class Number>
CLI::Option* add_numbers(CLI::App& command, const std::string& option, std::vector<Number>& values,
                         const Limits<std::type_identity_t<Number>>& limits, const std::string& what) {
  const auto take = [&values, option, limits](const std::string& list) {
    values.clear();
    std::size_t begin = 0, end = 0;
    do {
      end = std::min(list.find(',', begin), list.size());
      const auto number = number_in<Number>(std::string_view(list).substr(begin, end - begin), limits);
      if (!number)
        refuse_number<Number>(option, list,
                              std::integral<Number> ? "a list of integers" : "a list of numbers", limits);
      values.push_back(*number);
      begin = end + 1;
    } while (end < list.size());
  };
  std::ostringstream before;
  for (const Number& value : values) before << (&value == values.data() ? "" : ",") << value;
  return command.add_option_function<std::string>(option, take, what)
      ->type_name(type_name_of<Number>(limits) + ",...")
      ->default_str(before.str());
}

}  // namespace raylanes::bench
