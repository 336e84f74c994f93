// Lights and the world around.

#include "scene/lighting.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

std::string with_light(const std::string& light, const std::string& more = "") {
  return "seedframe: 1\nseed: 2\nlights: {l: {" + light + "}}\n" + kCameraAtOrigin + more;
}

LightSpec light_of(const std::string& light) {
  const auto frame = first_frame(with_light(light));
  EXPECT_FALSE(frame.spec.lights.empty());
  return frame.spec.lights.empty() ? LightSpec{} : frame.spec.lights[0];
}

/// In the world, of the camera at the origin.
Eigen::Vector3d place_of_light(const LightSpec& light) {
  const Eigen::Vector3d seen = light.camera_from_light.translation();
  return {seen.x(), -seen.z(), seen.y()};
}
Eigen::Vector3d direction_of_light(const LightSpec& light) {
  const Eigen::Vector3d seen = light.camera_from_light.linear() * Eigen::Vector3d(0, 0, -1);
  return {seen.x(), -seen.z(), seen.y()};
}

TEST(Lumens, OfWhiteLightAre683PerWatt) {
  EXPECT_NEAR(light_of("lumens: 683").power, 1.0, 1e-12);
  EXPECT_NEAR(light_of("lumens: 1366lm").power, 2.0, 1e-12);
  EXPECT_NEAR(light_of("type: area, lumens: 683").power, 1.0, 1e-12);
  EXPECT_EQ(light_of("lumens: 0").power, 0.0);
}

TEST(Lumens, CountTheColoursLuminance) {
  EXPECT_NEAR(light_of("lumens: 683, color: [0, 1, 0]").power, 1.0 / 0.7152, 1e-12);
  EXPECT_NEAR(light_of("lumens: 683, color: [2, 2, 2]").power, 0.5, 1e-12);
  EXPECT_NEAR(light_of("lumens: 683, color: {kelvin: 2700}").power, 1.0, 1e-9);
}

TEST(Lumens, OfASpotLeaveItsCone) {
  // A cone of 120° is a quarter of the sphere, one of 180° the half.
  EXPECT_NEAR(light_of("type: spot, lumens: 683, angle_deg: 120").power, 4.0, 1e-12);
  EXPECT_NEAR(light_of("type: spot, lumens: 683, angle_deg: 180").power, 2.0, 1e-12);
  EXPECT_NEAR(spot_watts_from_lumens(683.0, 1.0, 2.0 * std::acos(0.0)), 2.0, 1e-12);
}

TEST(Lux, OfASunAre683PerWattAndSquareMetre) {
  EXPECT_NEAR(light_of("type: sun, lux: 68300").power, 100.0, 1e-9);
  EXPECT_NEAR(light_of("type: sun, lux: 683, color: [1, 0, 0]").power, 1.0 / 0.2126, 1e-12);
}

TEST(Lumens, AreRefusedWhereTheyMeanNothing) {
  EXPECT_THAT(scene_error(with_light("lumens: 5, color: [0, 0, 0]")),
              HasSubstr("lights.l.lumens: black light has no lumens"));
  EXPECT_EQ(scene_error(with_light("lumens: 0, color: [0, 0, 0]")), "(no error)");
  EXPECT_THAT(scene_error(with_light("lumens: -1")),
              HasSubstr("lumens must be at least 0, found -1"));
  EXPECT_THAT(scene_error(with_light("type: sun, lumens: 1")), HasSubstr("unknown key"));
  EXPECT_THAT(scene_error(with_light("lux: 1")), HasSubstr("unknown key"));
  EXPECT_THAT(scene_error(with_light("power: 1, lumens: 1")),
              HasSubstr("power and lumens exclude each other"));
  EXPECT_THAT(scene_error(with_light("lumens: 3W")),
              HasSubstr("this is in W, but lm is needed here"));
  EXPECT_THAT(scene_error(with_light("type: spot, lumens: 1e308, angle_deg: 1")),
              HasSubstr("lights.l.lumens: this takes more watts than can be computed with"));
  EXPECT_THAT(scene_error(with_light("type: spot, power: 5, angle_deg: 0.5")),
              HasSubstr("lights.l.angle_deg: angle_deg must be from 1 to 180, found 0.5"));
}

TEST(Power, TakesWatts) { EXPECT_EQ(light_of("power: 40W").power, 40.0); }

TEST(LightGrid, LampsHangInRowsAndShineStraightDown) {
  const auto frame = first_frame(
      with_light("power: 1, position: [0, 0, 3], grid: {counts: [3, 2], spacing_m: [2, 4, 0]}"));
  ASSERT_EQ(frame.spec.lights.size(), 6u);
  EXPECT_LT((place_of_light(frame.spec.lights[0]) - Eigen::Vector3d(-2, -2, 3)).norm(), 1e-12);
  EXPECT_LT((place_of_light(frame.spec.lights[5]) - Eigen::Vector3d(2, 2, 3)).norm(), 1e-12);
  for (const LightSpec& light : frame.spec.lights) {
    EXPECT_LT((direction_of_light(light) - Eigen::Vector3d(0, 0, -1)).norm(), 1e-12);
  }
}

TEST(LightGrid, WithATargetAllShineAtIt) {
  const auto frame = first_frame(with_light(
      "power: 1, position: [0, 0, 3], target: [0, 0, 0], grid: {counts: [2], spacing_m: [8, "
      "0, 0]}"));
  EXPECT_LT((direction_of_light(frame.spec.lights.at(0)) - Eigen::Vector3d(0.8, 0, -0.6)).norm(),
            1e-12);
}

TEST(LightGrid, HasBounds) {
  EXPECT_THAT(scene_error(with_light("power: 1, grid: {counts: [33, 32]}")),
              HasSubstr("lights.l.grid: a grid may have 1024 copies, this has 1056"));
  EXPECT_THAT(scene_error(with_light("power: 1, count: 2, grid: {counts: [3]}")),
              HasSubstr("lights.l.count: count and grid exclude each other"));
}

TEST(Lights, CopiesDrawForThemselves) {
  const auto frame = first_frame(with_light("count: 3, power: {uniform: [1, 2]}"));
  EXPECT_NE(frame.spec.lights.at(0).power, frame.spec.lights.at(1).power);
  EXPECT_NE(frame.spec.lights.at(1).power, frame.spec.lights.at(2).power);
}

TEST(Lights, APositionBeyondAllNumbersIsRefused) {
  EXPECT_THAT(scene_error(with_light("power: 1, position: [1e308, 0, 0], target: [-1e308, 0, 0]")),
              HasSubstr("lights.l: the position or the target is too large"));
  EXPECT_THAT(scene_error(with_light("power: 1, position: [1e-200, 0, 0], target: [0, 0, 0]")),
              HasSubstr("(no error)"));
  EXPECT_THAT(scene_error(with_light("power: 1, color: {hsv: [0, 0, 1e300]}")),
              HasSubstr("a light has a number that is too large"));
}

WorldSpec world_of(const std::string& world, const std::string& camera = kCameraAtOrigin) {
  return first_frame("seedframe: 1\nworld: {" + world + "}\n" + camera).spec.world;
}

TEST(EnvironmentMap, TurnsWithTheCameraAndItsOwnRotation) {
  const std::string camera = "camera: {position: [1, 2, 3], target: [-2, 5, 1], roll_deg: 33}\n";
  for (const char* angle : {"0", "90", "-37.5", "1000"}) {
    const Eigen::Matrix3d map =
        world_of(std::string("hdri: studio, rotation_deg: ") + angle, camera).map_from_camera;
    EXPECT_LT((map * map.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12) << angle;
    EXPECT_NEAR(map.determinant(), 1.0, 1e-12) << angle;
  }
}

TEST(EnvironmentMap, ALookAlongYSeesTheMapsY) {
  // The camera's -z is the world's y.
  const Eigen::Vector3d forwards(0, 0, -1);
  const Eigen::Vector3d straight = world_of("hdri: studio").map_from_camera * forwards;
  EXPECT_LT((straight - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  // The map turned by a quarter, counter-clockwise from above: what was at x is now seen at y.
  const Eigen::Vector3d turned =
      world_of("hdri: studio, rotation_deg: 90").map_from_camera * forwards;
  EXPECT_LT((turned - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(EnvironmentMap, IsNamedByItsContent) {
  auto expander = expander_of("seedframe: 1\nworld: {hdri: studio}\ncamera: {distance_m: 1}\n");
  ASSERT_TRUE(expander) << expander.error().message;
  const auto frame = frame_of(*expander);
  EXPECT_EQ(frame.spec.world.hdri.size(), 64u);
  EXPECT_EQ(frame.used.images.at(frame.spec.world.hdri)->path.filename(), "studio.exr");
  EXPECT_EQ(frame.spec.world.strength, 1.0);
}

TEST(EnvironmentMap, MustBeThere) {
  EXPECT_THAT(
      scene_error("seedframe: 1\nworld: {hdri: stduio}\ncamera: {distance_m: 1}\n"),
      HasSubstr("world.hdri: there is no environment map 'stduio' (did you mean 'studio'?)"));
  EXPECT_THAT(scene_error("seedframe: 1\nvariables: {scene: {n: {choice: [sky]}}}\nworld: {hdri: "
                          "\"${n}\"}\ncamera: {distance_m: 1}\n"),
              HasSubstr("there is no environment map 'sky'"));
}

TEST(World, WithoutAMapItIsOneColour) {
  const WorldSpec world = world_of("color: [0.1, 0.2, 0.3], strength: 2");
  EXPECT_EQ(world.color, (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(world.strength, 2.0);
  EXPECT_TRUE(world.hdri.empty());
}

}  // namespace
}  // namespace seedframe
