// Light, shadows and textures on a wall whose every point is known.
#include "preview/twin_shading.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/files.h"
#include "image/exr_file.h"
#include "image/png_file.h"
#include "tests/fixtures/scratch_folder.h"
#include "tests/twin/scenes.h"

namespace seedframe {
namespace {

using Eigen::Vector3f;
using std::numbers::pi;

/// The camera looks straight at a white wall 4 m away, which fills its 80 × 80 pixels: column 40 +
/// 10 x, row 40 − 10 y sees its point (x, y). It has the whole UV square.
class Wall : public ::testing::Test {
 protected:
  Wall() {
    frame_.meshes = cube_.buffers;
    spec_ = empty_spec();
    spec_.render.width = spec_.render.height = 80;
    spec_.camera.focal_px = {40.0, 40.0};
    spec_.camera.center_px = {39.5, 39.5};
    spec_.materials.resize(2);
    spec_.materials[0].base_color = {1.0, 1.0, 1.0};
    spec_.materials[1].base_color = {0.0, 0.0, 0.0};
    spec_.instances = {cube_at(cube_, 1, 0, 0, -8, 4.0)};
  }

  /// Nothing of it is seen, and it sends no light on.
  InstanceSpec& add_blocker(double x, double y, double z, double half_side) {
    InstanceSpec& blocker = spec_.instances.emplace_back(cube_at(cube_, 2, x, y, z, half_side));
    blocker.materials = {1, 1};
    blocker.hidden_from.camera = true;
    return blocker;
  }

  LightSpec& add_light(LightKind kind, double x, double y, double z, double power) {
    LightSpec& light = spec_.lights.emplace_back();
    light.kind = kind;
    light.camera_from_light.translation() = Eigen::Vector3d(x, y, z);  // shines along -z
    light.color = {1.0, 1.0, 1.0};
    light.power = power;
    return light;
  }

  std::string add_file(const std::string& name) {
    auto file = std::make_shared<HashedFile>(HashedFile{folder_ / name, "hash of " + name});
    frame_.used.images[file->sha256] = file;
    return file->sha256;
  }

  Image<float> light() {
    TwinTracer tracer;
    const auto shading = shaded(spec_, frame_, tracer, images_);
    EXPECT_TRUE(shading) << shading.error().message;
    return shading ? shading->light : Image<float>(80, 80, 3);
  }

  static float at(const Image<float>& light, double x, double y, int channel = 0) {
    return light.at(static_cast<int>(40 - 10 * y), static_cast<int>(40 + 10 * x), channel);
  }

  ScratchFolder folder_;
  CubeBuffer cube_;
  FrameSpec spec_;
  ExpandedFrame frame_;
  ShadingImages images_;
};

/// A colour for each quarter, of which rows are from the top.
Image<std::uint8_t> four_colors() {
  Image<std::uint8_t> image(2, 2, 3);
  image.values = {255, 0, 0, 0, 255, 0, 0, 0, 255, 188, 188, 188};
  return image;
}

TEST_F(Wall, OfATextureHasItsColoursAtTheirUvsInLinearLight) {
  ASSERT_TRUE(write_file(folder_ / "four.png", encode_png(four_colors())));
  spec_.materials[0].textures["color"] = add_file("four.png");
  spec_.world = {{1.0, 1.0, 1.0}, 1.0, "", 0, Eigen::Matrix3d::Identity()};
  Image<float> seen = light();
  const auto expect = [&](double x, double y, const Vector3f& color) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(at(seen, x, y, c), color[c], 0.06) << x << ' ' << y;
  };
  expect(-2, 2, {1, 0, 0});
  expect(2, 2, {0, 1, 0});
  expect(-2, -2, {0, 0, 1});
  expect(2, -2, {0.503F, 0.503F, 0.503F});

  spec_.materials[0].texture_repeat = 2.0;
  spec_.materials[0].base_color = {0.5, 1.0, 1.0};
  seen = light();
  expect(-3, 3, {0.5F, 0, 0});
  expect(1, -1, {0.5F, 0, 0});
  expect(-1, 3, {0, 1, 0});
  expect(3, -3, {0.25F, 0.503F, 0.503F});
}

TEST_F(Wall, HasTheMaterialOfItsSlot) {
  spec_.world = {{1.0, 1.0, 1.0}, 1.0, "", 0, Eigen::Matrix3d::Identity()};
  spec_.instances[0].materials = {1, 0};
  EXPECT_NEAR(at(light(), 0, 0), 1.0, 0.01);
  spec_.instances[0].materials = {0, 1};  // what is seen is a cap
  EXPECT_EQ(at(light(), 0, 0), 0.0F);
}

TEST_F(Wall, ThatIsFarAwayHasTheMeanOfItsTexture) {
  Image<std::uint8_t> board(256, 256, 3);
  for (std::size_t i = 0; i < board.values.size(); ++i) {
    board.values[i] = (i / 3 + i / 3 / 256) % 2 * 255;
  }
  ASSERT_TRUE(write_file(folder_ / "board.png", encode_png(board)));
  spec_.materials[0].textures["color"] = add_file("board.png");
  spec_.materials[0].texture_repeat = 3.0;
  spec_.world = {{1.0, 1.0, 1.0}, 1.0, "", 0, Eigen::Matrix3d::Identity()};
  const Image<float> seen = light();
  for (const float value : seen.values) ASSERT_NEAR(value, 0.5, 0.02);
}

TEST_F(Wall, WithATextureThatCannotBeReadIsAnError) {
  spec_.materials[0].textures["color"] = add_file("missing.png");
  TwinTracer tracer;
  const auto shading = shaded(spec_, frame_, tracer, images_);
  ASSERT_FALSE(shading);
  EXPECT_NE(shading.error().message.find("missing.png"), std::string::npos);
}

TEST_F(Wall, HasTheLightOfAPointLampAndAShadowWhereTheLampSays) {
  add_light(LightKind::kPoint, 2.0, 0.0, -2.0, 100.0);
  const auto expected = [](double x, double y) {
    const double distance2 = (x - 2) * (x - 2) + y * y + 4.0;
    return 100.0 / (4.0 * pi * distance2) * 2.0 / std::sqrt(distance2) / pi;
  };
  const Image<float> open = light();
  for (const int column : {5, 20, 40, 60, 75}) {
    const double value = expected((column - 39.5) / 10.0, (39.5 - 30) / 10.0);
    EXPECT_NEAR(open.at(30, column), value, 0.01 * value) << column;
  }
  // Half way from the lamp to (−2, 0): a shadow of twice its size, there and nowhere else.
  InstanceSpec& blocker = add_blocker(0.0, 0.0, -3.0, 0.2);
  const Image<float> shadowed = light();
  EXPECT_LT(at(shadowed, -2.0, 0.0), 0.05F * at(open, -2.0, 0.0));
  EXPECT_LT(at(shadowed, -2.2, 0.3), 0.05F * at(open, -2.2, 0.3));
  for (const auto& [x, y] : {std::pair(2.0, 0.0), {-1.0, 0.0}, {-3.8, 0.0}, {-2.0, 0.8}}) {
    EXPECT_NEAR(at(shadowed, x, y), at(open, x, y), 0.02F * at(open, x, y)) << x;
  }
  blocker.hidden_from.shadow = true;
  EXPECT_EQ(light().values, open.values);
}

TEST_F(Wall, HasSoftShadowsOfLargeLampsAndHardOnesOfSmall) {
  LightSpec& lamp = add_light(LightKind::kArea, 0.0, 0.0, -2.0, 100.0);
  lamp.width_m = lamp.height_m = 0.01;
  const Image<float> open = light();
  EXPECT_NEAR(at(open, 0, 0), 100.0 / (pi * 4.0) / pi, 0.02 * at(open, 0, 0));
  add_blocker(-1.5, 0.0, -2.6,
              0.5);  // from the lamp's middle, its edge throws a shadow to x = −1.8
  const auto shares = [&] {
    const Image<float> seen = light();
    std::vector<float> row;
    for (const double x : {-2.6, -2.0, -1.8, -1.6, -0.8}) {
      row.push_back(at(seen, x, 0.0) / at(open, x, 0.0));
    }
    return row;
  };
  const std::vector<float> hard = shares();
  EXPECT_LT(hard[1], 0.05F);
  EXPECT_GT(hard[3], 0.95F);
  lamp.width_m = lamp.height_m = 1.0;  // now there is a share of it from −2.2 on, all from −1.4 on
  const std::vector<float> soft = shares();
  EXPECT_LT(soft[0], 0.05F);
  EXPECT_NEAR(soft[1], 0.34, 0.15);
  EXPECT_NEAR(soft[2], 0.58, 0.15);
  EXPECT_NEAR(soft[3], 0.83, 0.15);
  EXPECT_GT(soft[4], 0.95F);
}

TEST_F(Wall, IsLitByASunFromWhereItStands) {
  LightSpec& sun = add_light(LightKind::kSun, 0.0, 0.0, 0.0, 2.0);
  sun.camera_from_light.rotate(Eigen::AngleAxisd(0.25 * pi, Eigen::Vector3d::UnitY()));
  const Image<float> open = light();  // from the right, 45° off the wall
  EXPECT_NEAR(at(open, 1, 1), 2.0 * std::sqrt(0.5) / pi, 0.01);
  add_blocker(0.0, 0.0, -3.0, 0.3);
  const Image<float> shadowed = light();
  EXPECT_LT(at(shadowed, -1.0, 0.0), 0.1F * at(open, -1.0, 0.0));
  EXPECT_NEAR(at(shadowed, 1.0, 0.0), at(open, 1.0, 0.0), 0.01);
  EXPECT_NEAR(at(shadowed, 0.0, 0.0), at(open, 0.0, 0.0), 0.1 * at(open, 0.0, 0.0));
}

TEST_F(Wall, IsLitByASpotWithinItsCone) {
  LightSpec& spot = add_light(LightKind::kSpot, 0.0, 0.0, -2.0, 100.0);
  spot.angle_rad = 0.5 * pi;  // 2 m around
  const Image<float> seen = light();
  EXPECT_NEAR(at(seen, 0, 0), 100.0 / (4 * pi * 4.0) / pi, 0.01);
  EXPECT_GT(at(seen, 1.8, 0), 0.0F);
  EXPECT_EQ(at(seen, 2.3, 0), 0.0F);
}

class CubeInTheOpen : public Wall {
 protected:
  /// A map that is bright to its +y, red, and dim to its −y, green.
  CubeInTheOpen() {
    Image<float> map(32, 16, 3);
    for (int row = 0; row < 16; ++row) {
      for (int column = 0; column < 32; ++column) {
        map.at(row, column, column < 16 ? 0 : 1) = column < 16 ? 2.0F : 0.2F;
      }
    }
    EXPECT_TRUE(write_exr(folder_ / "map.exr", map, {"R", "G", "B"}));
    spec_.world = {{1.0, 1.0, 1.0}, 1.0, add_file("map.exr"), 256, Eigen::Matrix3d::Identity()};
    // A small cube, turned about the vertical, of which two sides are seen.
    spec_.instances = {cube_at(cube_, 1, 0, 0, -4, 0.5)};
    spec_.instances[0].camera_from_object.rotate(
        Eigen::AngleAxisd(0.25 * pi, Eigen::Vector3d::UnitY()));
  }
  /// +y of the map is to the camera's right (1) or left (−1), its z is up.
  void turn(double right) {
    spec_.world.map_from_camera.row(0) = Eigen::RowVector3d(0, 0, -right);
    spec_.world.map_from_camera.row(1) = Eigen::RowVector3d(right, 0, 0);
    spec_.world.map_from_camera.row(2) = Eigen::RowVector3d(0, 1, 0);
  }
};

TEST_F(CubeInTheOpen, IsLitOnTheSideThatFacesWhatIsBright) {
  turn(1.0);
  Image<float> seen = light();
  EXPECT_GT(at(seen, 0.3, 0, 0), 2.0F * at(seen, -0.3, 0, 0));
  EXPECT_LT(at(seen, 0.3, 0, 1), 0.7F * at(seen, -0.3, 0, 1));
  turn(-1.0);
  const Image<float> turned = light();
  EXPECT_GT(at(turned, -0.3, 0, 0), 2.0F * at(turned, 0.3, 0, 0));
  EXPECT_NEAR(at(turned, -0.3, 0, 0), at(seen, 0.3, 0, 0), 0.05 * at(seen, 0.3, 0, 0));
}

TEST_F(CubeInTheOpen, HasTheMapBehindIt) {
  turn(1.0);
  spec_.world.strength = 0.5;
  spec_.world.color = {1.0, 0.5, 1.0};
  const Image<float> seen = light();
  EXPECT_NEAR(at(seen, 3.5, 2, 0), 1.0, 1e-3);
  EXPECT_NEAR(at(seen, 3.5, 2, 1), 0.0, 1e-3);
  EXPECT_NEAR(at(seen, -3.5, 2, 0), 0.0, 1e-3);
  EXPECT_NEAR(at(seen, -3.5, 2, 1), 0.05, 1e-3);
}

TEST_F(Wall, IsDarkerWhereSomethingHidesTheSky) {
  spec_.world = {{1.0, 1.0, 1.0}, 1.0, "", 0, Eigen::Matrix3d::Identity()};
  EXPECT_NEAR(at(light(), 0, 0), 1.0, 0.01);
  InstanceSpec& roof = add_blocker(0.0, 0.0, -3.0, 0.6);
  Image<float> seen = light();
  EXPECT_LT(at(seen, 0, 0), 0.6F);
  EXPECT_GT(at(seen, 3.5, 3.5), 0.9F);
  roof.materials = {0, 0};  // white: it sends light on
  EXPECT_GT(at(light(), 0, 0), at(seen, 0, 0) + 0.1F);
}

TEST_F(Wall, OfTheSameFrameIsTheSameBits) {
  add_light(LightKind::kArea, 1.0, 0.5, -2.0, 100.0).width_m = 0.5;
  add_blocker(0.0, 0.0, -3.0, 0.4);
  spec_.world = {{0.5, 0.6, 1.0}, 1.0, "", 0, Eigen::Matrix3d::Identity()};
  EXPECT_EQ(light().values, light().values);
}

}  // namespace
}  // namespace seedframe
