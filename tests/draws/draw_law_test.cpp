#include "draws/draw_law.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

DrawLaw law_of(DistributionKind kind, std::array<double, 4> parameters) {
  DrawLaw law;
  law.kind = kind;
  law.parameters = parameters;
  return law;
}

double up_to(const DrawLaw& law, double x) { return share_up_to(law, x).value_or(NAN); }

TEST(DrawLaw, OfEvenDrawsGrowsEvenly) {
  const DrawLaw law = law_of(DistributionKind::kUniform, {2, 6});
  EXPECT_DOUBLE_EQ(up_to(law, 1), 0);
  EXPECT_DOUBLE_EQ(up_to(law, 3), 0.25);
  EXPECT_DOUBLE_EQ(up_to(law, 7), 1);
  EXPECT_DOUBLE_EQ(up_to(law_of(DistributionKind::kUniform, {2, 2}), 2), 1) << "of no width";
}

TEST(DrawLaw, OfNormalDrawsHasTheKnownShares) {
  const DrawLaw law = law_of(DistributionKind::kNormal, {10, 2});
  EXPECT_NEAR(up_to(law, 10), 0.5, 1e-12);
  EXPECT_NEAR(up_to(law, 12) - up_to(law, 8), 0.682689492, 1e-9);
  EXPECT_DOUBLE_EQ(up_to(law_of(DistributionKind::kNormal, {1, 0}), 1), 1) << "without deviation";
}

TEST(DrawLaw, OfTruncatedDrawsIsWholeBetweenTheEnds) {
  const DrawLaw law = law_of(DistributionKind::kTruncatedNormal, {0, 1, -1, 1});
  EXPECT_DOUBLE_EQ(up_to(law, -1.001), 0);
  EXPECT_NEAR(up_to(law, 0), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(up_to(law, 1), 1);
}

TEST(DrawLaw, OfBoundedDrawsIsHalfAtTheMeanInTheMiddle) {
  const DrawLaw law = law_of(DistributionKind::kBoundedNormal, {0, 0.4, -1, 1});
  EXPECT_DOUBLE_EQ(up_to(law, -1.001), 0);
  EXPECT_NEAR(up_to(law, 0), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(up_to(law, 1), 1);
  EXPECT_STREQ(name_of(DistributionKind::kBoundedNormal), "bounded_normal");
}

TEST(DrawLaw, OfLogUniformDrawsHasHalfBelowTheGeometricMean) {
  const DrawLaw law = law_of(DistributionKind::kLogUniform, {1, 100});
  EXPECT_NEAR(up_to(law, 10), 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(up_to(law, 0), 0);
}

TEST(DrawLaw, OfWholeNumbersStepsAtThem) {
  const DrawLaw law = law_of(DistributionKind::kInteger, {1, 4});
  EXPECT_DOUBLE_EQ(up_to(law, 0.999), 0);
  EXPECT_DOUBLE_EQ(up_to(law, 1), 0.25);
  EXPECT_DOUBLE_EQ(up_to(law, 3.5), 0.75);
  EXPECT_DOUBLE_EQ(up_to(law, 4), 1);
  const DrawLaw poisson = law_of(DistributionKind::kPoisson, {2});
  EXPECT_NEAR(up_to(poisson, 2), 5 * std::exp(-2), 1e-12);
  EXPECT_DOUBLE_EQ(up_to(poisson, -1), 0);
  EXPECT_DOUBLE_EQ(up_to(poisson, 1e9), 1);
}

TEST(DrawLaw, OfAChoiceFollowsItsWeights) {
  DrawLaw law = law_of(DistributionKind::kChoice, {});
  law.numbers = {0, 180};
  law.weights = {3, 1};
  EXPECT_DOUBLE_EQ(up_to(law, 0), 0.75);
  EXPECT_DOUBLE_EQ(up_to(law, 180), 1);
  law.numbers.clear();
  EXPECT_EQ(share_up_to(law, 0), std::nullopt) << "of a mixture nothing is known";
}

TEST(DrawLaw, OfSamplesIsTheirShare) {
  DrawLaw law = law_of(DistributionKind::kEmpirical, {});
  EXPECT_EQ(share_up_to(law, 0), std::nullopt);
  law.samples = std::make_shared<const std::vector<double>>(std::vector<double>{1, 2, 2, 5});
  EXPECT_DOUBLE_EQ(up_to(law, 2), 0.75);
}

TEST(DrawLaw, ComesWithEachDrawOfAConfig) {
  const ExpandedFrame frame = first_frame(std::string(kCameraAtOrigin) + R"(
seedframe: 1
variables:
  scene: {spread: {uniform: [1, 2]}}
  frame:
    near: {normal: [spread, 0.5]}
    side: {choice: {0: 3, 180: 1}}
    mixed: {choice: [{uniform: [0, 1]}, 5]}
    kind: {choice: {gear: 2, hex_bolt: 1}}
objects:
  gears: {asset: "${kind}", category: none, position: [0, 2, 0]}
)");
  std::map<std::string, Draw> draws;
  for (const Draw& draw : frame.draws) draws.emplace(draw.name, draw);
  const auto law = [&draws](const std::string& name) {
    const auto found = draws.find(name);
    EXPECT_NE(found, draws.end()) << name;
    return found == draws.end() ? DrawLaw() : found->second.law.value_or(DrawLaw());
  };
  const DrawLaw spread = law("variables.scene.spread");
  EXPECT_EQ(spread.level, Level::kScene);
  EXPECT_EQ(spread.kind, DistributionKind::kUniform);
  EXPECT_DOUBLE_EQ(spread.parameters[1], 2.0);
  const DrawLaw near = law("variables.frame.near");
  EXPECT_EQ(near.level, Level::kFrame);
  EXPECT_DOUBLE_EQ(near.parameters[0], draws.at("variables.scene.spread").value.get<double>())
      << "the parameters of this very draw";
  EXPECT_EQ(law("variables.frame.side").numbers, (std::vector<double>{0, 180}));
  EXPECT_EQ(law("variables.frame.side").weights, (std::vector<double>{3, 1}));
  EXPECT_TRUE(law("variables.frame.mixed").numbers.empty());
  EXPECT_EQ(law("variables.frame.kind").names, (std::vector<std::string>{"gear", "hex_bolt"}));
}

}  // namespace
}  // namespace seedframe
