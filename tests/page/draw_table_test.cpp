#include "page/draw_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace seedframe {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

Draw uniform_draw(const std::string& name, double value, double min, double max,
                  Level level = Level::kFrame) {
  DrawLaw law;
  law.level = level;
  law.parameters = {min, max};
  return {name, value, law};
}

std::vector<double> shares(const Json& variable) {
  return variable.at("expected").get<std::vector<double>>();
}

TEST(DrawTable, WithoutFramesHasNoVariables) { EXPECT_TRUE(DrawTable().to_json().empty()); }

TEST(DrawTable, CopiesAreOneVariableWithSeveralValues) {
  DrawTable table;
  table.add(
      0, {uniform_draw("objects.bolts.x/0", 1, 0, 4), uniform_draw("objects.bolts.x/1", 2, 0, 4)});
  table.add(0, {uniform_draw("objects.bolts.x/0", 3, 0, 4)});
  const Json json = table.to_json();
  ASSERT_EQ(json.size(), 1u);
  EXPECT_EQ(json[0].at("name"), "objects.bolts.x");
  EXPECT_EQ(json[0].at("values").at("count"), 3);
  EXPECT_EQ(json[0].at("offsets").at("count"), 3) << "two frames, and the end";
}

TEST(DrawTable, OneValueAFrameNeedsNoOffsets) {
  DrawTable table;
  table.add(0, {uniform_draw("x", 1, 0, 4)});
  table.add(0, {uniform_draw("x", 2, 0, 4)});
  EXPECT_TRUE(table.to_json()[0].at("offsets").is_null());
  table.add(1, {});
  EXPECT_FALSE(table.to_json()[0].at("offsets").is_null()) << "of the last nothing is known";
}

TEST(DrawTable, ExpectsTheLawsShareInEachBin) {
  DrawTable table;
  for (int i = 0; i < 4; ++i) table.add(i, {uniform_draw("x", i, 0, 8)});
  const Json variable = table.to_json()[0];
  EXPECT_EQ(variable.at("law"), "uniform from 0 to 8");
  EXPECT_EQ(variable.at("edges").size(), 9u);
  EXPECT_EQ(variable.at("edges").front(), 0) << "the law's ends, beyond what was drawn";
  EXPECT_EQ(variable.at("edges").back(), 8);
  for (const double share : shares(variable)) EXPECT_NEAR(share, 0.125, 1e-6);
}

TEST(DrawTable, WhereParametersVaryExpectsTheirMean) {
  DrawTable table;
  table.add(0, {uniform_draw("x", 1, 0, 4)});
  table.add(1, {uniform_draw("x", 6, 4, 8)});
  const Json variable = table.to_json()[0];
  EXPECT_EQ(variable.at("law"), "uniform, parameters vary");
  for (const double share : shares(variable)) EXPECT_NEAR(share, 0.125, 1e-6);
}

TEST(DrawTable, WhatIsDrawnOnceASceneCountsOnce) {
  DrawTable table;
  // Scene 0 has three frames with the law 0 to 4, scene 1 one with 4 to 8: as likely.
  for (int i = 0; i < 3; ++i) table.add(0, {uniform_draw("x", 1, 0, 4, Level::kScene)});
  table.add(1, {uniform_draw("x", 6, 4, 8, Level::kScene)});
  const Json variable = table.to_json()[0];
  EXPECT_EQ(variable.at("level"), "scene");
  for (const double share : shares(variable)) EXPECT_NEAR(share, 0.125, 1e-6);
}

TEST(DrawTable, WholeNumbersHaveABarEachAlsoThoseNeverDrawn) {
  DrawTable table;
  DrawLaw law;
  law.kind = DistributionKind::kInteger;
  law.parameters = {1, 4};
  table.add(0, {{"n", 2.0, law}});
  const Json variable = table.to_json()[0];
  EXPECT_EQ(variable.at("numbers"), Json({1, 2, 3, 4}));
  EXPECT_THAT(shares(variable), ElementsAre(DoubleNear(0.25, 1e-6), DoubleNear(0.25, 1e-6),
                                            DoubleNear(0.25, 1e-6), DoubleNear(0.25, 1e-6)));
}

TEST(DrawTable, ManyWholeNumbersShareBinsBetweenThem) {
  DrawTable table;
  DrawLaw law;
  law.kind = DistributionKind::kInteger;
  law.parameters = {0, 999};
  for (int i = 0; i < 100; ++i) table.add(i, {{"n", 10.0 * i, law}});
  const Json variable = table.to_json()[0];
  double sum = 0.0;
  for (const double share : shares(variable)) sum += share;
  EXPECT_NEAR(sum, 1.0, 1e-4);
  EXPECT_EQ(variable.at("edges").front(), -0.5);
}

TEST(DrawTable, NamesAreCountedWithTheirWeights) {
  DrawTable table;
  DrawLaw law;
  law.kind = DistributionKind::kChoice;
  law.names = {"steel", "brass"};
  law.weights = {3, 1};
  table.add(0, {{"material", "steel", law}});
  const Json variable = table.to_json()[0];
  EXPECT_EQ(variable.at("names"), Json({"brass", "steel"}));
  EXPECT_THAT(shares(variable), ElementsAre(0.25, 0.75));
}

TEST(DrawTable, WithoutALawExpectsNothing) {
  DrawTable table;
  table.add(0, {{"x", 1.0}});
  const Json variable = table.to_json()[0];
  EXPECT_FALSE(variable.contains("law"));
  for (const Json& share : variable.at("expected")) EXPECT_TRUE(share.is_null());
}

}  // namespace
}  // namespace seedframe
