// The section `sensor` of a config, in frame specs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "spec/frame_spec_reader.h"
#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

std::string with_sensor(const std::string& keys) {
  return "seedframe: 1\nseed: 4\nframes_per_scene: 2\ncamera: {distance_m: 1}\n" +
         (keys.empty() ? "" : "sensor: {" + keys + "}\n");
}

TEST(Sensor, WithoutTheSectionAFrameIsAsItAlwaysWas) {
  const ExpandedFrame plain = first_frame(with_sensor(""));
  EXPECT_FALSE(plain.spec.sensor);
  EXPECT_EQ(to_json(plain.spec).at("version"), kOldestFrameSpecVersion);
  EXPECT_FALSE(to_json(plain.spec).contains("sensor"));
  EXPECT_NE(first_frame(with_sensor("blur_px: 1")).id, plain.id);
}

TEST(Sensor, IsDrawnForEachFrameWithASeedOfItsOwn) {
  const auto frames = all_frames(with_sensor(
      "exposure_stops: {uniform: [-1, 1]}, full_well: 5000, read_noise: 4, jpeg_quality: 89.6"));
  ASSERT_EQ(frames.size(), 2U);
  const SensorSettings& first = *frames[0].spec.sensor;
  const SensorSettings& second = *frames[1].spec.sensor;
  EXPECT_NE(first.exposure_stops, second.exposure_stops);
  EXPECT_NE(first.seed, second.seed);
  EXPECT_EQ(first.full_well, 5000.0);
  EXPECT_EQ(first.jpeg_quality, 90);
  EXPECT_EQ(first.white_balance, (std::array<double, 3>{1.0, 1.0, 1.0}));
}

TEST(Sensor, MovesNoOtherDraw) {
  ExpandedFrame with = first_frame(with_sensor("full_well: 5000"));
  with.spec.sensor.reset();
  EXPECT_EQ(frame_id(with.spec), first_frame(with_sensor("")).id);
}

TEST(Sensor, ComesBackFromItsJson) {
  const ExpandedFrame frame = first_frame(
      with_sensor("blur_px: 0.6, exposure_stops: -0.5, full_well: 5000, read_noise: 4.5, "
                  "white_balance: {kelvin: 4000}, jpeg_quality: 80"));
  const Json json = to_json(frame.spec);
  EXPECT_EQ(json.at("version"), kFrameSpecVersion);
  const auto read = frame_spec_from_json(json, "it");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->sensor, frame.spec.sensor);
  EXPECT_EQ(frame_id(*read), frame.id);
}

TEST(Sensor, WarmLightThatIsToBeWhiteTakesRedAway) {
  const auto gains =
      first_frame(with_sensor("white_balance: {kelvin: 3000}")).spec.sensor->white_balance;
  EXPECT_LT(gains[0], 0.8);
  EXPECT_EQ(gains[1], 1.0);
  EXPECT_GT(gains[2], 1.5);
}

TEST(Sensor, RefusesWhatNoCameraHas) {
  EXPECT_THAT(scene_error(with_sensor("read_noise: 3")),
              HasSubstr("sensor.read_noise: read_noise is in electrons: say with full_well"));
  EXPECT_THAT(scene_error(with_sensor("blur_px: -1")),
              HasSubstr("sensor.blur_px: blur_px must be from 0 to 32, found -1"));
  EXPECT_THAT(scene_error(with_sensor("jpeg_quality: 101")), HasSubstr("from 0 to 100, found 101"));
  EXPECT_THAT(scene_error(with_sensor("white_balance: [1, 0, 1]")),
              HasSubstr("white_balance must have red, green and blue"));
  EXPECT_THAT(scene_error(with_sensor("iso: 100")), HasSubstr("sensor.iso: unknown key"));
}

}  // namespace
}  // namespace seedframe
