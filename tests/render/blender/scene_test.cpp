// What each value of a frame spec means in the picture.
#include <gmock/gmock.h>

#include "tests/render/blender/real_blender_fixture.h"

namespace seedframe {
namespace {

constexpr int kMiddleRow = 18;
constexpr int kMiddleColumn = 24;

float center(const FramePasses& picture, int channel) {
  return picture.combined.at(kMiddleRow, kMiddleColumn, channel);
}

TEST_F(RealBlender, TheCameraIsAPinholeAtTheOrigin) {
  FrameSpec spec = ball();
  spec.instances = {instance("right/0", 1, smooth, {0}, placed(1.0, 0, -4, 0.1)),
                    instance("up/0", 2, smooth, {0}, placed(0, 0.8, -4, 0.1)),
                    instance("background/0", 0, smooth, {0}, placed(-1.0, 0, -4, 0.1))};
  const FramePasses picture = render_one(spec);
  // Pixel centres are at integers, the principal point is ((W - 1) / 2, (H - 1) / 2).
  EXPECT_EQ(picture.instance_ids.at(18, 23 + 15), 1) << "x = 60 * 1 / 4 + 23.5 = 38.5";
  EXPECT_EQ(picture.instance_ids.at(18, 23 + 16), 1);
  EXPECT_EQ(picture.instance_ids.at(17 - 12, 23), 2) << "y = 17.5 - 60 * 0.8 / 4 = 5.5";
  EXPECT_EQ(picture.instance_ids.at(17 - 11, 24), 2);
  EXPECT_EQ(picture.instance_ids.at(18, 9), 0);
  EXPECT_NEAR(picture.depth->at(18, 9), 3.9, 0.03) << "id 0 is there all the same";
  EXPECT_GT(picture.depth->at(0, 0), 1e9F);
}

TEST_F(RealBlender, TransformsArriveExactlyEvenWithShear) {
  FrameSpec spec = ball();
  Affine sheared = placed(0, 0, -4);
  sheared.matrix()(0, 1) = 1.0;  // x' = x + y: no location, rotation and scale make this
  spec.instances[0].camera_from_object = sheared;
  const FramePasses picture = render_one(spec);
  EXPECT_EQ(picture.instance_ids.at(18 - 10, 24 + 14), 5) << "up and right";
  EXPECT_EQ(picture.instance_ids.at(18 + 10, 24 - 14), 5) << "down and left";
  EXPECT_EQ(picture.instance_ids.at(18 - 10, 24 - 8), 0) << "up and left";
}

TEST_F(RealBlender, AWhiteFurnaceIsWhite) {
  FrameSpec spec = ball();
  spec.materials[0].base_color = {1, 1, 1};
  spec.materials[0].roughness = 1.0;
  spec.render.max_bounces = 8;
  spec.render.samples = 64;
  const FramePasses picture = render_one(spec);
  EXPECT_NEAR(center(picture, 0), 1.0, 0.05) << "Disney's diffuse reflects a little too much";
  EXPECT_NEAR(picture.combined.at(0, 0, 0), 1.0, 1e-3) << "the world itself";
  EXPECT_NEAR(picture.combined.at(0, 0, 3), 1.0, 1e-6) << "the film is not transparent";
}

TEST_F(RealBlender, PowerIsInWatts) {
  // A point light of P watts at distance d gives a white diffuse surface the radiance P / (4 π²
  // d²), a small area light that faces it four times as much; for a sun the radiance is E / π.
  FrameSpec spec = ball();
  spec.world.strength = 0.0;
  spec.materials[0].base_color = {1, 1, 1};
  spec.render.samples = 16;
  LightSpec point;
  point.kind = LightKind::kPoint;
  point.camera_from_light = placed(0, 0, 0);
  point.color = {1, 0.5, 0.25};
  point.power = 100;
  LightSpec sun;
  sun.kind = LightKind::kSun;
  sun.camera_from_light = placed(0, 0, 0);
  sun.color = {1, 1, 1};
  sun.power = 3;
  LightSpec area = point;
  area.kind = LightKind::kArea;
  area.width_m = area.height_m = 0.05;
  specs[0] = specs[1] = specs[2] = spec;
  specs[0].lights = {point};
  specs[1].lights = {sun};
  specs[2].lights = {area};
  ASSERT_TRUE(render({0, 1, 2}, 1)) << testing::PrintToString(failures);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(center(passes[0], 0), 100 / (4 * pi * pi * 9), 0.03);
  EXPECT_NEAR(center(passes[0], 2), 0.25 * 100 / (4 * pi * pi * 9), 0.01);
  EXPECT_NEAR(center(passes[1], 0), 3 / pi, 0.05);
  EXPECT_NEAR(center(passes[2], 0), 100 / (pi * pi * 9), 0.03);
}

TEST_F(RealBlender, ASpotLightsItsFullConeAndAnAreaLightIsNotSeen) {
  FrameSpec spec = ball();
  spec.world.strength = 0.0;
  spec.instances[0].camera_from_object = placed(0, 0, -8, 4);
  LightSpec spot;
  spot.kind = LightKind::kSpot;
  spot.camera_from_light = placed(0, 0, 0);
  spot.color = {1, 1, 1};
  spot.power = 1000;
  spot.angle_rad = 0.3;  // radius at the ball, 4 m away: 0.6 m, 9 pixels
  LightSpec area;
  area.kind = LightKind::kArea;
  area.camera_from_light = placed(0, 0, -2, 1, std::numbers::pi);  // shines at the camera
  area.color = {1, 1, 1};
  area.power = 1000;
  area.width_m = area.height_m = 0.5;
  specs[0] = specs[1] = spec;
  specs[0].lights = {spot};
  specs[1].lights = {area};
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  EXPECT_GT(center(passes[0], 0), 0.1F);
  EXPECT_GT(passes[0].combined.at(kMiddleRow, kMiddleColumn + 6, 0), 0.1F);
  EXPECT_EQ(passes[0].combined.at(kMiddleRow, kMiddleColumn + 13, 0), 0.0F);
  EXPECT_EQ(center(passes[1], 0), 0.0F);
  EXPECT_EQ(passes[1].instance_ids.at(kMiddleRow, kMiddleColumn), 5);
}

TEST_F(RealBlender, EachSlotHasItsMaterial) {
  FrameSpec spec = ball();
  spec.materials.push_back(spec.materials[0]);
  spec.materials[0].base_color = {0.8, 0, 0};
  spec.materials[1].base_color = {0, 0, 0.8};
  // Upright: the sphere's own z is up in the picture.
  Affine upright = placed(0, 0, -4);
  upright.rotate(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  spec.instances = {instance("ball/0", 1, halves, {0, 1}, upright)};
  const FramePasses picture = render_one(spec);
  EXPECT_GT(picture.combined.at(10, kMiddleColumn, 0), 0.3F);
  EXPECT_LT(picture.combined.at(10, kMiddleColumn, 2), 0.1F);
  EXPECT_GT(picture.combined.at(26, kMiddleColumn, 2), 0.3F);
}

TEST_F(RealBlender, TexturesAreSrgbColoursTimesTheBaseColour) {
  // One colour everywhere: sRGB 188 is 0.5029 linear.
  const std::string grey = add_texture(188, 188, 188);
  specs[0] = specs[1] = ball();
  specs[0].materials[0].base_color = {0.8, 0.8 * 0.5029, 0.4};
  specs[1].materials[0].base_color = {0.8 / 0.5029, 0.8, 0.4 / 0.5029};
  specs[1].materials[0].textures["color"] = grey;
  for (int frame = 0; frame < 2; ++frame) specs[frame].render.samples = 64;
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(center(passes[0], channel), center(passes[1], channel), 0.02) << channel;
  }
}

TEST_F(RealBlender, DataTexturesReplaceTheirParameter) {
  const std::string half = add_texture(128, 128, 128);
  const std::string up = add_texture(128, 128, 255);
  specs[0] = specs[1] = ball();
  for (int frame = 0; frame < 2; ++frame) {
    specs[frame].render.samples = 64;
    specs[frame].materials[0].specular = 0.5;
    specs[frame].materials[0].metallic = specs[frame].materials[0].roughness = 128.0 / 255;
  }
  MaterialSpec& textured = specs[1].materials[0];
  textured.metallic = textured.roughness = 0.0;
  textured.textures = {{"metallic", half}, {"roughness", half}, {"normal", up}};
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  EXPECT_NEAR(center(passes[0], 0), center(passes[1], 0), 0.02);
}

TEST_F(RealBlender, NormalsAreTheCamerasAndFlatFacetsAreFlat) {
  FrameSpec spec = ball();
  spec.render.normal = true;
  spec.render.samples = 1;
  const FramePasses picture = render_one(spec);
  EXPECT_NEAR(picture.normal->at(kMiddleRow, kMiddleColumn, 2), 1.0, 0.05) << "towards the viewer";
  EXPECT_GT(picture.normal->at(kMiddleRow, kMiddleColumn + 10, 0), 0.3F) << "x to the right";
  EXPECT_GT(picture.normal->at(kMiddleRow - 10, kMiddleColumn, 1), 0.3F) << "y up";
}

TEST_F(RealBlender, AShortFocalLengthIsRefusedNotClamped) {
  specs[0] = ball();
  specs[0].camera.focal_px = {1.0, 1.0};
  ASSERT_TRUE(render({0}, 1));
  EXPECT_THAT(failures[0], testing::HasSubstr("cannot render lens = 0.75"));
}

}  // namespace
}  // namespace seedframe
