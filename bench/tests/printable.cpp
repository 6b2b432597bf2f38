// Text of strangers on a terminal.
#include "../support/readers/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace raylanes::bench {
namespace {

TEST(Printable, text_stays_and_control_characters_do_not) {
  EXPECT_EQ(printable("teapot.ply × ≤ 😀"), "teapot.ply × ≤ 😀");
  EXPECT_EQ(printable("\x1b[31mred\x1b]0;title\x07"), "\\x1b[31mred\\x1b]0;title\\x07");
  EXPECT_EQ(printable(std::string("a\0b\n\r\t\x7f", 7)), "a\\x00b\\x0a\\x0d\\x09\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\xc2\\x9b31m");  // an 8-bit escape sequence
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, what_is_not_utf8_is_escaped) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc3"), "\\xc3");                             // cut
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // longer than need be
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");           // overlong as well
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond the last character
}

TEST(Printable, long_text_loses_its_middle) {
  const std::string text = std::string(1000, 'a') + std::string(1000, 'b');
  EXPECT_EQ(printable(text, 9), "aaaaaa…bbb");
  EXPECT_LE(printable(std::string(1 << 20, '\x1b')).size(), 4 * excerpt_length + 3);
  EXPECT_EQ(printable(std::string(60, 'a')), std::string(60, 'a'));
}

}  // namespace
}  // namespace raylanes::bench
