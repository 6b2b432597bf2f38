// Floating-point numbers in messages.
#pragma once

#include <charconv>
#include <concepts>
#include <string>

namespace raylanes {

// The shortest text that reads back as the same number: "1e-09", "0.1", "nan". std::to_string() rounds to six decimals,
// so that -1e-9 looks like a zero.
template <std::floating_point T>
std::string text_of(T number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

}  // namespace raylanes
