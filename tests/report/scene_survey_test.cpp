#include "report/scene_survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

SceneSurvey survey_of(const std::string& text) {
  const std::string config = "seedframe: 1\n" + text;
  const auto expander = expander_of(config);
  EXPECT_TRUE(expander) << expander.error().message;
  const auto survey =
      survey_scenes(*expander, read_campaign_config(config, "scene.yaml")->categories);
  EXPECT_TRUE(survey) << survey.error().message;
  return *survey;
}

const std::string kCamera =
    "camera: {target: [0, 0, 0.02], distance_m: 0.5, elevation_deg: 30, azimuth_deg: {uniform: [0, "
    "360]}}\n";

std::string cube(const std::string& more = "rest_on_ground: true") {
  return "categories: [cube]\nobjects: {box: {asset: cube, category: cube, " + more + "}}\n";
}

TEST(SceneSurvey, AnOrdinarySceneIsNotWarnedOf) {
  const SceneSurvey survey =
      survey_of("scenes: 100\nrender: {width: 640, height: 480}\nground: {}\n" + cube() + kCamera);
  EXPECT_THAT(survey.warnings, IsEmpty());
  EXPECT_EQ(survey.frames.size(), 24u);
  EXPECT_EQ(survey.frames.back(), 99);
  EXPECT_EQ(survey.width, 160);
  EXPECT_EQ(survey.height, 120);
}

TEST(SceneSurvey, WhatIsHiddenFromTheCameraIsMeantNotToBeSeen) {
  const std::string objects =
      "scenes: 2\ncategories: [cube]\n"
      "objects: {box: {asset: cube, category: cube, rest_on_ground: true}, "
      "shade: {asset: cube, category: none, position: [0.1, 0, 0.03]HIDDEN}}\n";
  const auto with = [&](const std::string& hidden) {
    std::string text = objects + kCamera;
    return survey_of(text.replace(text.find("HIDDEN"), 6, hidden)).warnings;
  };
  EXPECT_THAT(with(", hidden_from: [camera]"), IsEmpty());
  EXPECT_THAT(with(", scale: 0.001"), ElementsAre(HasSubstr("'shade' is in")));
}

TEST(SceneSurvey, MillimetresThatWereTakenForMetres) {
  EXPECT_THAT(
      survey_of("scenes: 2\n" + cube("scale: 1000") + kCamera).warnings,
      ElementsAre(HasSubstr(
          "the camera is inside of 'box', which is 50 × 50 × 50 m large, in 2 of 2 frames")));
  EXPECT_THAT(
      survey_of("scenes: 2\n" + cube("scale: 1000, position: [0, 0, -25.05]") + kCamera).warnings,
      ElementsAre(HasSubstr("'box' is 50 × 50 × 50 m large, 0.3")));
}

TEST(SceneSurvey, ACameraUnderTheGround) {
  EXPECT_THAT(
      survey_of(
          "scenes: 2\nground: {}\n" + cube("position: [0, 0, -0.2]") +
          "camera: {target: [0, 0, -0.2], distance_m: 0.5, elevation_deg: {uniform: [-20, -10]}}\n")
          .warnings,
      ElementsAre(HasSubstr("the camera is under the ground in 2 of 2 frames")));
}

TEST(SceneSurvey, WhatIsNotSeenAndWhatIsHardlySeen) {
  EXPECT_THAT(survey_of("scenes: 2\n" + cube("position: [0, 0, 3]") + kCamera).warnings,
              ElementsAre(HasSubstr("nothing that has a category is seen in 2 frames"),
                          HasSubstr("'box' is in 2 frames, and seen in none")));
  EXPECT_THAT(
      survey_of("scenes: 2\nrender: {width: 160, height: 120}\n" + cube("scale: 0.2") + kCamera)
          .warnings,
      ElementsAre(HasSubstr("'box' never shows more than about")));
  EXPECT_THAT(survey_of("objects: {box: {asset: cube, category: none}}\n" + kCamera).warnings,
              ElementsAre(HasSubstr("there are no categories")));
}

TEST(SceneSurvey, FramesThatAreTheSame) {
  EXPECT_THAT(
      survey_of("scenes: 3\n" + cube() + "camera: {distance_m: 0.5, elevation_deg: 30}\n").warnings,
      ElementsAre(HasSubstr("frames 0 and 1 are the same but for their noise")));
}

TEST(SceneSurvey, FacesAtOnePlace) {
  // The small cube's front is in the large one's.
  EXPECT_THAT(
      survey_of("scenes: 2\ncategories: [cube]\nobjects:\n"
                "  large: {asset: cube, category: cube, scale: 4}\n"
                "  small: {asset: cube, category: cube, scale: 2, position: [0, -0.05, 0]}\n"
                "camera: {target: [0, 0, 0], distance_m: 0.7, elevation_deg: 20, azimuth_deg: "
                "{uniform: [-20, 20]}}\n")
          .warnings,
      ElementsAre(HasSubstr("'large' and 'small' have faces at one place")));
}

TEST(SceneSurvey, AssetsAndCategoriesThatAreDrawnApart) {
  EXPECT_THAT(
      survey_of("scenes: 24\ncategories: [a, b]\nobjects: {box: {asset: {choice: [cube, gear]}, "
                "category: {choice: [a, b]}}}\n" +
                kCamera)
          .warnings,
      ElementsAre(HasSubstr("'box' shows the asset 'cube' as 'a' and as 'b'"),
                  HasSubstr("'box' shows the asset 'gear' as 'a' and as 'b'")));
}

}  // namespace
}  // namespace seedframe
