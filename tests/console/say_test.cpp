#include "console/say.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(Wrapped, LeavesShortLinesAsTheyAre) {
  EXPECT_EQ(wrapped("", 10), "");
  EXPECT_EQ(wrapped("one two", 10), "one two");
  EXPECT_EQ(wrapped("  one  two", 10), "  one  two") << "with their columns";
  EXPECT_EQ(wrapped("one\ntwo\n", 10), "one\ntwo\n");
}

TEST(Wrapped, BreaksBetweenWordsAndGoesOnFurtherIn) {
  EXPECT_EQ(wrapped("one two three four five", 10), "one two\n  three\n  four\n  five");
  EXPECT_EQ(wrapped("one two three\nfour", 13), "one two three\nfour");
}

TEST(Wrapped, DoesNotBreakWords) {
  EXPECT_EQ(wrapped("a /very/long/path here", 8), "a\n  /very/long/path\n  here");
  EXPECT_EQ(wrapped("/very/long/path", 8), "/very/long/path");
}

TEST(Wrapped, CountsCharactersNotBytes) {
  EXPECT_EQ(wrapped("äöü äöü", 7), "äöü äöü");
  EXPECT_EQ(wrapped("äöü äöü", 6), "äöü\n  äöü");
  EXPECT_EQ(wrapped("\xff\xff \xff", 4), "\xff\xff \xff");
}

TEST(Wrapped, NeverHasALineThatIsTooLongForItsWords) {
  std::string text;
  for (int i = 0; i < 60; ++i) text += std::string(static_cast<std::size_t>(i * 7 % 11), 'x') + ' ';
  for (std::size_t columns = 14; columns < 90; ++columns) {
    const std::string lines = wrapped(text, columns);
    std::size_t column = 0;
    for (const char letter : lines) {
      column = letter == '\n' ? 0 : column + 1;
      ASSERT_LE(column, columns);
    }
  }
}

}  // namespace
}  // namespace seedframe
