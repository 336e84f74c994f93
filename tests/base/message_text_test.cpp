#include "base/message_text.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(MessageText, IsShortenedBetweenCharacters) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc…");
  EXPECT_EQ(shortened("aüb", 2), "a…");
  EXPECT_EQ(shortened("üü", 0), "…");
}

TEST(MessageText, HoldsNothingThatATerminalObeys) {
  EXPECT_EQ(printable("a\x1b[2J\tb\r\x7f\nc"), "a?[2J?b??\nc");
  EXPECT_EQ(printable("\u009b2J über 日本"), "?2J über 日本");
  EXPECT_EQ(printable(std::string(1, '\0')), "?");
  EXPECT_EQ(printable("a\u202egpj.exe\u2066 \u200f\u061c\u2028b"), "a?gpj.exe? ???b");
  EXPECT_EQ(printable("\xff\xc3 caf\u00e9"), "?? café");
  EXPECT_EQ(printable("שלום – “é”"), "שלום – “é”");
}

TEST(MessageText, ANameIsOneLine) {
  EXPECT_TRUE(is_one_line_name("hex bolt"));
  EXPECT_TRUE(is_one_line_name("../über: 日本"));
  EXPECT_TRUE(is_one_line_name(std::string(200, 'x')));
  for (const char* name :
       {"", "a\nb", "a\rb", "a\tb", "a\x1b", "a\x7f", "a\u0085b", "a\u2028b", "a\u2029b"}) {
    EXPECT_FALSE(is_one_line_name(name)) << name;
  }
  EXPECT_FALSE(is_one_line_name(std::string(201, 'x')));
  EXPECT_FALSE(is_one_line_name(std::string("a\0b", 3)));
}

}  // namespace
}  // namespace seedframe
