// Lenses, environment maps and hidden objects as Blender shows them, and Embree's view of the same.
#include <gmock/gmock.h>

#include "mesh/mesh_buffer.h"
#include "rays/ray_scene.h"
#include "tests/mesh/example_meshes.h"
#include "tests/render/blender/real_blender_fixture.h"

namespace seedframe {
namespace {

/// A BMP of 4 × 4 pixels: its left half of one colour, its right half of another.
std::string two_halves(std::array<std::uint8_t, 3> left_bgr,
                       std::array<std::uint8_t, 3> right_bgr) {
  std::string bytes = "BM";
  const auto put = [&bytes](std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i));
  };
  put(54 + 48, 4), put(0, 4), put(54, 4);
  put(40, 4), put(4, 4), put(4, 4), put(1, 2), put(24, 2);
  for (int i = 0; i < 6; ++i) put(0, 4);
  for (int pixel = 0; pixel < 16; ++pixel) {
    for (const std::uint8_t byte : pixel % 4 < 2 ? left_bgr : right_bgr) put(byte, 1);
  }
  return bytes;
}

/// What RayScene says of every pixel, as ids.
Image<std::uint16_t> ids_by_embree(const FrameSpec& spec,
                                   const std::map<std::string, std::filesystem::path>& meshes) {
  std::vector<RayInstance> instances;
  for (const InstanceSpec& instance : spec.instances) {
    const auto mesh = mesh_from_buffer(*read_file(meshes.at(instance.mesh)), "mesh");
    instances.push_back({std::make_shared<const RayMesh>(*mesh),
                         Eigen::Affine3d(instance.camera_from_object.matrix()),
                         !instance.hidden_from.camera});
  }
  const CameraSpec& camera = spec.camera;
  const RayScene scene({spec.render.width, spec.render.height, camera.focal_px, camera.center_px,
                        camera.clip_start_m, camera.clip_end_m},
                       instances);
  Image<std::uint16_t> ids(spec.render.width, spec.render.height);
  for (int y = 0; y < spec.render.height; ++y) {
    for (int x = 0; x < spec.render.width; ++x) {
      const int hit = scene.first_hit(x, y);
      ids.at(y, x) = static_cast<std::uint16_t>(
          hit < 0 ? 0 : spec.instances[static_cast<std::size_t>(hit)].id);
    }
  }
  return ids;
}

int different(const Image<std::uint16_t>& a, const Image<std::uint16_t>& b) {
  int count = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) count += a.values[i] != b.values[i] ? 1 : 0;
  return count;
}

TEST_F(RealBlender, ThePrincipalPointAndTheTwoFocalLengthsAreInPixels) {
  FrameSpec spec = ball();
  spec.camera.focal_px = {60.0, 45.0};
  spec.camera.center_px = {30.0, 10.0};
  spec.instances = {instance("a/0", 1, smooth, {0}, placed(0.5, 0.5, -4, 0.05)),
                    instance("b/0", 2, smooth, {0}, placed(-1.0, -1.0, -4, 0.05))};
  const FramePasses picture = render_one(spec);
  EXPECT_EQ(picture.instance_ids.at(4, 37), 1) << "x = 30 + 60/8 = 37.5, y = 10 - 45/8 = 4.4";
  EXPECT_EQ(picture.instance_ids.at(21, 15), 2) << "x = 30 - 15, y = 10 + 11.25";
}

TEST_F(RealBlender, WhatBlenderWouldLimitWithoutAWordIsRefused) {
  for (int frame = 0; frame < 6; ++frame) specs[frame] = ball();
  specs[0].camera.focal_px = {1.0, 1.0};
  specs[1].camera.focal_px = {60.0, 60.0 * 201};
  specs[2].camera.focal_px = {60.0 * 201, 60.0};
  specs[3].camera.clip_start_m = 1e-7;
  specs[4].lights = {{.kind = LightKind::kSpot, .angle_rad = 0.01}};
  specs[5].camera.focal_px = {60.0 * 200, 60.0};  // the limit itself is kept
  ASSERT_TRUE(render({0, 1, 2, 3, 4, 5}, 1));
  using ::testing::HasSubstr;
  EXPECT_THAT(failures[0], HasSubstr("Blender cannot render lens = 0.75: it makes 1 of it"));
  EXPECT_THAT(failures[1], HasSubstr("pixel_aspect_x = 201: it makes 200 of it"));
  EXPECT_THAT(failures[2], HasSubstr("pixel_aspect_y = 201"));
  EXPECT_THAT(failures[3], HasSubstr("clip_start = 1e-07: it makes 1e-06 of it"));
  EXPECT_THAT(failures[4], HasSubstr("spot_size = 0.01"));
  EXPECT_EQ(failures[5], "");
}

TEST_F(RealBlender, VerticesFarFromTheirMeshsOriginCostNothing) {
  constexpr float kFar = 65536.0F;  // a cube's corners stay float32 numbers there
  Mesh cube = example_cube();
  const std::string near = add_mesh(mesh_buffer(cube));
  for (auto& position : cube.positions) position[0] += kFar;
  const std::string far = add_mesh(mesh_buffer(cube));
  specs[0] = ball();
  specs[0].instances = {instance("a/0", 1, near, {0, 0}, placed(0.5, 0.5, -4, 0.5, 0.7)),
                        instance("b/0", 2, near, {0, 0}, placed(-1.0, -0.5, -4, 0.5, 0.3))};
  specs[1] = specs[0];
  for (InstanceSpec& each : specs[1].instances) {
    each.mesh = far;
    each.camera_from_object.translate(Eigen::Vector3d(-kFar, 0, 0));
  }
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  EXPECT_LE(different(passes[0].instance_ids, passes[1].instance_ids), 1) << "an edge may round";
  EXPECT_GT(different(passes[0].instance_ids, Image<std::uint16_t>(48, 36)), 200);
}

TEST_F(RealBlender, EmbreeSeesWhatTheIndexPassShowsPixelByPixel) {
  int pixels = 0;
  int wrong = 0;
  for (std::int64_t frame = 0; frame < 4; ++frame) {
    specs[frame] = varied(frame);
    specs[frame].render.width = 160;
    specs[frame].render.height = 120;
    specs[frame].render.samples = 1;
    specs[frame].camera.focal_px = {190.0, 170.0 + 10.0 * static_cast<double>(frame)};
    specs[frame].camera.center_px = {75.0, 66.25};
    specs[frame].camera.aperture_radius_m = 0.0;
  }
  specs[3].instances[0].hidden_from.camera = true;
  ASSERT_TRUE(render({0, 1, 2, 3}, 1)) << testing::PrintToString(failures);
  for (const auto& [frame, picture] : passes) {
    const Image<std::uint16_t> ids = ids_by_embree(specs[frame], meshes);
    wrong += different(ids, picture.instance_ids);
    pixels += static_cast<int>(ids.values.size());
  }
  // Blender's float32 rays meet an edge elsewhere now and then.
  EXPECT_LE(wrong, pixels / 10'000) << "of " << pixels;
}

TEST_F(RealBlender, DepthOfFieldBlursThePictureAndLeavesTheLabels) {
  specs[0] = specs[1] = ball();
  specs[1].camera.aperture_radius_m = 0.2;
  specs[1].camera.focus_distance_m = 1.0;
  for (int frame = 0; frame < 2; ++frame) specs[frame].render.samples = 16;
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  ASSERT_TRUE(sharp.contains(1));
  EXPECT_FALSE(sharp.contains(0));
  EXPECT_EQ(sharp[1].instance_ids.values, passes[0].instance_ids.values);
  EXPECT_EQ(sharp[1].depth->values, passes[0].depth->values);
  EXPECT_GT(different(passes[1].instance_ids, passes[0].instance_ids), 20)
      << "the lens disturbs the index pass, or this test shows nothing";
  // The ball is far behind the focus: its edge is soft, and just beside it the picture differs.
  EXPECT_NE(passes[1].combined.values, passes[0].combined.values);
}

TEST_F(RealBlender, WhatIsInFocusIsSharp) {
  specs[0] = specs[1] = ball();
  for (int frame = 0; frame < 2; ++frame) {
    specs[frame].instances[0].camera_from_object = placed(0, 0, -4, 0.02);
    specs[frame].render.samples = 64;
    specs[frame].camera.aperture_radius_m = 0.1;
  }
  specs[0].world.strength = specs[1].world.strength = 0.2;
  specs[0].camera.focus_distance_m = 4.0;
  specs[1].camera.focus_distance_m = 1.0;
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  // The circle of confusion of frame 1 has a radius of 60 · 0.1 · (1/1 - 1/4) = 4.5 pixels.
  EXPECT_EQ(sharp[0].instance_ids.values, sharp[1].instance_ids.values);
  EXPECT_NEAR(passes[1].combined.at(18, 24 + 3, 0), passes[0].combined.at(18, 24 + 3, 0), 0.05);
}

TEST_F(RealBlender, TheMiddleOfAnEnvironmentMapIsAlongItsXAndItsLeftHalfIsAlongY) {
  const std::string map = add_texture_file(two_halves({0, 0, 255}, {255, 0, 0}));  // red, blue
  specs[0] = ball();
  specs[0].instances.clear();
  specs[0].world.hdri = map;
  specs[0].world.strength = 0.5;
  // Camera: -z to the map's +y, up to its +z.
  specs[0].world.importance_map_px = 256;
  specs[0].world.map_from_camera << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  specs[1] = specs[0];
  specs[1].world.map_from_camera << -1, 0, 0, 0, 0, 1, 0, 1, 0;  // -z to -y
  specs[2] = specs[0];
  specs[2].world.hdri.clear();
  specs[2].world.color = {0, 1, 0};
  specs[3] = specs[0];
  specs[3].world.color = {0.5, 1, 1};
  ASSERT_TRUE(render({0, 1, 2, 3}, 1)) << testing::PrintToString(failures);
  const auto middle = [&](int frame, int channel) {
    return passes[frame].combined.at(18, 24, channel);
  };
  EXPECT_NEAR(middle(0, 0), 0.5, 0.01) << "red";
  EXPECT_NEAR(middle(0, 2), 0.0, 0.01);
  EXPECT_NEAR(middle(1, 2), 0.5, 0.01) << "blue";
  EXPECT_NEAR(middle(2, 1), 0.5, 0.01) << "nothing of the map stays for a frame without one";
  EXPECT_NEAR(middle(2, 0), 0.0, 0.01);
  EXPECT_NEAR(middle(3, 0), 0.25, 0.01) << "the colour multiplies the map";
}

TEST_F(RealBlender, HiddenFromTheCameraIsHiddenFromTheLabelsToo) {
  specs[0] = specs[1] = ball();
  specs[0].instances[0].hidden_from.camera = true;
  ASSERT_TRUE(render({0, 1}, 1)) << testing::PrintToString(failures);
  EXPECT_EQ(passes[0].instance_ids.at(18, 24), 0);
  EXPECT_EQ(passes[1].instance_ids.at(18, 24), 5);
}

}  // namespace
}  // namespace seedframe
