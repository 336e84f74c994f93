#include "base/last_made.h"

#include <string>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(LastMade, GivesTheLastValueForItsKeyOnly) {
  LastMade<int, std::string> last;
  EXPECT_EQ(last.find(0), nullptr) << "nothing was made, not even for the key that is 0";
  last.keep(1, std::make_shared<const std::string>("one"));
  EXPECT_EQ(*last.find(1), "one");
  EXPECT_EQ(last.find(2), nullptr);
  const auto held = last.find(1);
  last.keep(2, std::make_shared<const std::string>("two"));
  EXPECT_EQ(last.find(1), nullptr);
  EXPECT_EQ(*last.find(2), "two");
  EXPECT_EQ(*held, "one") << "whoever has it keeps it";
}

}  // namespace
}  // namespace seedframe
