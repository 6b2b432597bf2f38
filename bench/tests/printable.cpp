// Text of strangers on a terminal.
#include "../support/readers/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace raylanes::bench {
namespace {

TEST(Printable, text_stays_and_control_characters_do_not) {
  const std::pair<std::string, std::string> cases[] = {
      {"teapot.ply × ≤ 😀", "teapot.ply × ≤ 😀"},
      {"\x1b[31mred\x1b]0;title\x07", "\\x1b[31mred\\x1b]0;title\\x07"},
      {std::string("a\0b\n\r\t\x7f", 7), "a\\x00b\\x0a\\x0d\\x09\\x7f"},
      {std::string("\xc2\x9b") + "31m", "\\xc2\\x9b31m"},  // an 8-bit escape sequence
      {"\xff\xc3", "\\xff\\xc3"},                          // no UTF-8, cut
      {"\xc0\xaf", "\\xc0\\xaf"},                          // longer than need be
      {"\xe0\x80\xaf", "\\xe0\\x80\\xaf"},                 // overlong as well
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},                 // a surrogate
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"}};       // beyond the last character
  for (const auto& [given, shown] : cases) EXPECT_EQ(printable(given), shown);
}

TEST(Printable, long_text_loses_its_middle) {
  EXPECT_EQ(printable(std::string(1000, 'a') + std::string(1000, 'b'), 9), "aaaaaa…bbb");
  EXPECT_LE(printable(std::string(1 << 20, '\x1b')).size(), 4 * excerpt_length + 3);
}

}  // namespace
}  // namespace raylanes::bench
