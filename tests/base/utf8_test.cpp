#include "base/utf8.h"

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(Utf8, IsToldFromOtherBytes) {
  for (const char* text : {"", "abc", "ü", "日本", "\U0010FFFF", "\xEF\xBB\xBFv"}) {
    EXPECT_TRUE(is_utf8(text)) << text;
  }
  for (const char* text :
       {"\xFC", "a\xC3", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80"}) {
    EXPECT_FALSE(is_utf8(text)) << text;
  }
}

TEST(Utf8, OtherBytesAreReadAsLatin1) {
  EXPECT_EQ(as_utf8("Gehäuse"), "Gehäuse");
  EXPECT_EQ(as_utf8("Geh\xE4use"), "Gehäuse");
  EXPECT_EQ(as_utf8("\xA0\xBF\xC0\xFF"), "\u00A0\u00BF\u00C0\u00FF");
  EXPECT_EQ(as_utf8("5 \x80"), "5 ?") << "a control character in Latin-1";
}

}  // namespace
}  // namespace seedframe
