#include "base/canonical_json.h"

#include <limits>

#include <gtest/gtest.h>

namespace seedframe {
namespace {

TEST(CanonicalJson, SortsKeysAndLeavesNoSpace) {
  EXPECT_EQ(canonical_json({{"b", 1}, {"a", {1, 2}}}), R"({"a":[1,2],"b":1})");
}

TEST(CanonicalJson, WritesOneTextForOneNumber) {
  EXPECT_EQ(canonical_json(1.0), "1");
  EXPECT_EQ(canonical_json(1), "1");
  EXPECT_EQ(canonical_json(-0.0), "0");
  EXPECT_EQ(canonical_json(0.1), "0.1");
  EXPECT_EQ(canonical_json(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(canonical_json(1e300), "1e+300");
  EXPECT_EQ(canonical_json(9007199254740993.0), "9007199254740992");
}

TEST(CanonicalJson, NumbersReadBackAsTheSameDouble) {
  for (const double value : {1.0 / 3.0, 5e-324, 1.7976931348623157e308, -123.456}) {
    const Result<Json> read = parse_json(canonical_json(value), "number");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->get<double>(), value);
  }
}

TEST(CanonicalJson, ReadableTextIsTheSameValue) {
  const Json value = {{"name", "a\"b"},
                      {"list", {1.5, 2}},
                      {"inner", {{"x", nullptr}}},
                      {"rows", {{{"k", 1}}, {{"k", 2}}}},
                      {"none", Json::array()}};
  const Result<Json> read = parse_json(readable_json(value), "text");
  ASSERT_TRUE(read);
  EXPECT_EQ(canonical_json(*read), canonical_json(value));
  EXPECT_EQ(readable_json(value).back(), '\n');
}

TEST(CanonicalJsonDeathTest, NotANumberIsAProgrammersMistake) {
  EXPECT_DEATH(canonical_json(std::numeric_limits<double>::quiet_NaN()), "not finite");
}

TEST(ParseJson, NamesTheTextThatIsNotJson) {
  const Result<Json> read = parse_json("{\"a\": ", "labels.json");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("labels.json is not valid JSON"), std::string::npos);
}

TEST(ParseJson, RefusesMoreLevelsThanTheStackShouldHold) {
  const auto nested = [](int levels) {
    return std::string(static_cast<std::size_t>(levels), '[') +
           std::string(static_cast<std::size_t>(levels), ']');
  };
  EXPECT_TRUE(parse_json(nested(100), "labels.json"));
  for (const int levels : {101, 1'000'000}) {
    const Result<Json> read = parse_json(nested(levels), "labels.json");
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("more than 100 levels"), std::string::npos);
  }
  EXPECT_TRUE(parse_json('"' + nested(500) + "\\\"" + nested(500) + '"', "a text"));
}

TEST(IntegerIn, TakesWhatTheTypeHolds) {
  EXPECT_EQ(integer_in<int>(Json(-5)), -5);
  EXPECT_EQ(integer_in<int>(Json(2147483647u)), 2147483647);
  EXPECT_EQ(integer_in<std::uint64_t>(Json(UINT64_MAX)), UINT64_MAX);
  EXPECT_EQ(integer_in<std::int64_t>(Json(INT64_MIN)), INT64_MIN);
}

TEST(IntegerIn, RefusesAllElse) {
  for (const Json& value : {Json(1.0), Json(0.5), Json(1e300), Json(true), Json("1"), Json()}) {
    EXPECT_FALSE(integer_in<int>(value)) << value;
    EXPECT_THROW(integer_of<int>(value), Json::exception) << value;
  }
  EXPECT_FALSE(integer_in<int>(Json(2147483648u)));
  EXPECT_FALSE(integer_in<int>(Json(INT64_MIN)));
  EXPECT_FALSE(integer_in<std::uint32_t>(Json(-1)));
  EXPECT_FALSE(integer_in<std::int64_t>(Json(UINT64_MAX)));
}

TEST(JsonField, TellsMissingFromWrong) {
  const Json object = {{"n", "text"}};
  EXPECT_NE(json_field<int>(object, "m", "f.json").error().message.find("'m' is missing"),
            std::string::npos);
  EXPECT_NE(json_field<bool>(object, "n", "f.json").error().message.find("wrong type"),
            std::string::npos);
  EXPECT_NE(json_field<int>(object, "n", "f.json").error().message.find("must be an integer"),
            std::string::npos);
  EXPECT_FALSE(json_field<int>(Json::array(), "n", "f.json"));
}

}  // namespace
}  // namespace seedframe
