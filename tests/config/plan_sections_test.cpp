// What a config says of its frames: sweeps, constraints, graphs; and what is refused, where.

#include "config/plan_sections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/campaign_config.h"
#include "tests/fixtures/message_of.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

constexpr const char* kPlanStart =
    "seedframe: 1\ncamera: {distance_m: 1}\nobjects: {box: {asset: cube}, tray: {objects: {cup: "
    "{asset: cube}}}}\n";

Result<CampaignConfig> read(const std::string& more) {
  return read_campaign_config(kPlanStart + more, "scene.yaml");
}

std::string plan_error(const std::string& more) {
  const auto config = read(more);
  return message_of(config);
}

struct PlanCase {
  const char* text;
  const char* expected;
};

void expect_errors(const std::vector<PlanCase>& cases) {
  for (const PlanCase& c : cases) EXPECT_THAT(plan_error(c.text), HasSubstr(c.expected)) << c.text;
}

TEST(SweepConfig, MultipliesTheScenes) {
  const auto config = read("scenes: 5\nsweep: {values: {a: [1, 2, 3], b: [x, y]}}\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->sweep.size(), 6);
  EXPECT_EQ(config->scenes, 30);
  EXPECT_TRUE(config->sweep.hold_draws);
  EXPECT_EQ(config->sweep.axes.at(0).name, "a");
  EXPECT_EQ(std::get<std::string>(config->sweep.axes.at(1).points.at(1).at("b")), "y");
}

TEST(SweepConfig, NumbersAreNumbersAndTextsAreNames) {
  const auto config = read(
      "sweep: {values: {a: [1, 2.5, -1e3], b: ['cube', 'a b'], c: [{x: 1, y: "
      "red}, {y: blue, x: 2}]}}\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(std::get<double>(config->sweep.axes[0].points[2].at("a")), -1000.0);
  EXPECT_EQ(std::get<std::string>(config->sweep.axes[1].points[1].at("b")), "a b");
  EXPECT_EQ(std::get<std::string>(config->sweep.axes[2].points[1].at("y")), "blue");
}

TEST(SweepConfig, WithoutASweepThereIsOneCombination) {
  EXPECT_EQ(SweepConfig{}.size(), 1);
  EXPECT_EQ(read("")->scenes, 1);
}

TEST(SweepConfig, MistakesAreNamedWithTheirPlace) {
  expect_errors({
      {"sweep: 3", "scene.yaml:4:8: sweep: expected a mapping, found '3'"},
      {"sweep: {}", "scene.yaml:4:8: sweep: the key 'values' is missing or empty"},
      {"sweep: {values: {}}", "scene.yaml:4:8: sweep: the key 'values' is missing or empty"},
      {"sweep: {values: [1]}", "scene.yaml:4:17: sweep.values: expected a mapping of names"},
      {"sweep: {values: {a: 3}}", "sweep.values.a: expected a list of values, found '3'"},
      {"sweep: {values: {a: []}}", "sweep.values.a: expected a list of values, found a list of 0"},
      {"sweep: {values: {a: [1, x]}}",
       "sweep.values.a: every value of an axis must be of the same"},
      {"sweep: {values: {a: [1, {b: 2}]}}", "sweep.values.a: every value of an axis"},
      {"sweep: {values: {a: [{b: 2}, {c: 2}]}}", "sweep.values.a: every value of an axis"},
      {"sweep: {values: {a: [{b: 2}, {b: x}]}}", "sweep.values.a: every value of an axis"},
      {"sweep: {values: {a: [{b: 2}, {b: 2, c: 3}]}}", "sweep.values.a: every value of an axis"},
      {"sweep: {values: {a: [{}]}}", "sweep.values.a[0]: expected at least one variable"},
      {"sweep: {values: {a: [[1]]}}", "sweep.values.a[0]: expected a number or a name"},
      {"sweep: {values: {a: [.nan]}}", "sweep.values.a[0]: a number must be finite"},
      {"sweep: {values: {a: ['']}}", "sweep.values.a[0]: expected a number or a name, found ''"},
      {"sweep: {values: {a: [1, 2], b: [{a: 3}]}}",
       "sweep.values.b: the variable 'a' is swept twice"},
      {"sweep: {values: {1a: [1]}}", "a name must be letters, digits and '_'"},
      {"sweep: {values: {a: [{b-c: 1}]}}", "a variable's name must be letters, digits and '_'"},
      {"sweep: {values: {a: [1]}, hold_draw: true}", "unknown key (did you mean 'hold_draws'?)"},
      {"sweep: {values: {a: [1]}, hold_draws: 1}", "expected true or false, found '1'"},
  });
}

TEST(SweepConfig, HasALimit) {
  std::string axes;
  for (char name = 'a'; name < 'u'; ++name) {
    axes += std::string(axes.empty() ? "" : ", ") + name + ": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]";
  }
  EXPECT_THAT(plan_error("sweep: {values: {" + axes + "}}"),
              HasSubstr("sweep: a sweep may have 1000000 combinations"));
  EXPECT_THAT(plan_error("scenes: 60000000\nsweep: {values: {a: [1, 2]}}"),
              HasSubstr("(× the combinations of the sweep) must not exceed 100000000"));
}

TEST(ConstraintConfig, HasABoundByItsType) {
  const auto config = read(
      "constraints: {a: {type: visible}, b: {type: in_view}, c: {type: pixels}, d: {type: apart}, "
      "e: {type: distance, objects: [cup], at_least: 2}}\n");
  ASSERT_TRUE(config) << config.error().message;
  const auto bound = [&](std::size_t i) {
    return std::get<double>(config->constraints.at(i).at_least.value);
  };
  EXPECT_EQ(bound(0), 0.5);
  EXPECT_EQ(bound(1), 1.0);
  EXPECT_EQ(bound(2), 1.0);
  EXPECT_EQ(bound(3), 0.0);
  EXPECT_EQ(bound(4), 2.0);
  EXPECT_EQ(config->constraints[4].kind, ConstraintKind::kDistance);
  EXPECT_EQ(config->constraints[4].objects, std::vector<std::string>{"cup"});
  EXPECT_EQ(config->max_attempts, 100);
}

TEST(ConstraintConfig, MistakesAreNamedWithTheirPlace) {
  expect_errors({
      {"constraints: 3", "scene.yaml:4:14: constraints: expected a mapping of names, found '3'"},
      {"constraints: {c: 3}", "constraints.c: expected a mapping, found '3'"},
      {"constraints: {c: {}}", "constraints.c: the key 'type' is missing"},
      {"constraints: {c: {type: visibel}}",
       "scene.yaml:4:25: constraints.c.type: unknown type of constraint (did you mean 'visible'?)"},
      {"constraints: {c: {type: [visible]}}", "constraints.c.type: unknown type of constraint"},
      {"constraints: {c: {type: apart, objects: [trya]}}",
       "constraints.c: there is no object 'trya' (did you mean 'tray'?)"},
      {"constraints: {c: {type: apart, objects: box}}",
       "constraints.c.objects: expected a list of texts, found 'box'"},
      {"constraints: {c: {type: apart, at_leest: 1}}",
       "constraints.c.at_leest: unknown key (did you mean 'at_least'?)"},
      {"constraints: {c: {type: apart, at_least: [1]}}",
       "constraints.c.at_least: expected a number, a formula or a distribution"},
      {"max_attempts: 0", "max_attempts: expected a whole number from 1 to 100000, found '0'"},
      {"max_attempts: 100001", "max_attempts: expected a whole number from 1 to 100000"},
  });
}

TEST(GraphsConfig, MistakesAreNamedWithTheirPlace) {
  expect_errors({
      {"graphs: nowhere.jsonl", "scene.yaml:4:9: graphs: expected a file of JSON lines, found "},
      {"graphs: [a]", "graphs: expected a path, found a list of 1"},
      {"graphs: ''", "graphs: expected a path, found ''"},
      {"graphs: .\nscenes: 3", "scenes: scenes and graphs exclude each other"},
  });
}

}  // namespace
}  // namespace seedframe
