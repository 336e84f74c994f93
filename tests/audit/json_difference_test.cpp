// What two frame specs differ in, told to people.

#include "audit/json_difference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> between(const char* a, const char* b, std::size_t most = 9) {
  return json_differences(Json::parse(a), Json::parse(b), most);
}

TEST(JsonDifference, NamesTheValueByItsPath) {
  EXPECT_THAT(between(R"({"a": 1})", R"({"a": 1.0})"), IsEmpty());
  EXPECT_THAT(
      between(R"({"render": {"seed": 7, "width": 3}})", R"({"render": {"seed": 8, "width": 3}})"),
      ElementsAre("render.seed: 7, here 8"));
  EXPECT_THAT(between(R"([{"mesh": "ab"}, {"mesh": "cd"}])", R"([{"mesh": "ab"}, {"mesh": "ef"}])"),
              ElementsAre("[1].mesh: cd, here ef"));
}

TEST(JsonDifference, AVectorIsOneValue) {
  EXPECT_THAT(between(R"({"at": [1, 2, 3]})", R"({"at": [1, 5, 6]})"),
              ElementsAre("at: [1,2,3], here [1,5,6]"));
}

TEST(JsonDifference, WhatOnlyOneHas) {
  EXPECT_THAT(between(R"({"a": 1, "list": [{}, {}]})", R"({"b": 1, "list": [{}]})"),
              ElementsAre("a: not here", "list: 2 entries, here 1", "b: only here"));
}

TEST(JsonDifference, IsNotLongerThanAsked) {
  EXPECT_THAT(between(R"({"a": 1, "b": 1, "c": 1})", R"({"a": 2, "b": 2, "c": 2})", 1),
              ElementsAre("a: 1, here 2", "and 2 more"));
}

}  // namespace
}  // namespace seedframe
