#include "annotate/amodal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "annotate/rle.h"
#include "tests/twin/scenes.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

const CubeBuffer& cube() {
  static const CubeBuffer shared;
  return shared;
}

FrameLabels labels_of(const FrameSpec& spec) {
  const auto twin = TwinTracer().trace(spec, cube().buffers, TwinTracer::Passes::kIdsOnly);
  auto labels = make_labels(spec, {"cube"}, twin->instance_ids);
  add_amodal_labels(*labels, spec, *twin, twin->instance_ids);
  return *labels;
}

/// The front face of cube 1 covers columns 70 to 89 and rows 50 to 69; cube 2 hides all but its
/// right quarter.
FrameSpec half_hidden() {
  FrameSpec spec = empty_spec();
  spec.instances = {cube_at(cube(), 1, 0, 0, -11), cube_at(cube(), 2, -1.75, 0, -5, 2)};
  spec.instances[1].camera_from_object(2, 3) = -7.0;
  return spec;
}

TEST(Amodal, VisibleAndWholePixelsAreTold) {
  const FrameLabels labels = labels_of(half_hidden());
  const InstanceLabel& back = labels.instances[0];
  ASSERT_TRUE(back.amodal);
  EXPECT_EQ(back.amodal->area_px, 400);
  EXPECT_EQ(back.amodal->in_image_px, 400);
  EXPECT_EQ(back.amodal->box, (PixelRect{70, 50, 20, 20}));
  EXPECT_TRUE(back.amodal->complete);
  // The front cube's front face, 2 m wide sides at 5 m: columns 4.5 to 84.5.
  EXPECT_EQ(back.area_px, 100);
  EXPECT_DOUBLE_EQ(back.visible_fraction(), 0.25);
  EXPECT_DOUBLE_EQ(back.truncation(), 0.0);
  EXPECT_DOUBLE_EQ(labels.instances[1].visible_fraction(), 1.0);
}

TEST(Amodal, TheMaskCanBeReadBack) {
  const FrameLabels labels = labels_of(half_hidden());
  const AmodalLabel& amodal = *labels.instances[0].amodal;
  const auto rle = rle_from_string(amodal.rle, amodal.box.width, amodal.box.height);
  ASSERT_TRUE(rle);
  EXPECT_EQ(rle->counts, (std::vector<std::uint32_t>{0, 400}));
}

TEST(Amodal, TruncationIsTheShareOutsideTheImage) {
  FrameSpec spec = empty_spec();
  // Front face at 10 m from column 149.5 to 169.5: 10 of 20 columns are in the image.
  spec.instances = {cube_at(cube(), 1, 8, 0, -11)};
  const InstanceLabel label = labels_of(spec).instances[0];
  EXPECT_EQ(label.area_px, label.amodal->in_image_px);
  EXPECT_GT(label.amodal->area_px, 400) << "its left side shows too";
  EXPECT_EQ(label.amodal->area_px - label.amodal->in_image_px, 200);
  EXPECT_DOUBLE_EQ(label.truncation(), 200.0 / static_cast<double>(label.amodal->area_px));
  EXPECT_EQ(label.amodal->box.x + label.amodal->box.width, 170);
}

TEST(Amodal, WhatReachesTheCanvasEdgeIsIncomplete) {
  FrameSpec spec = empty_spec();
  spec.instances = {cube_at(cube(), 1, 0, 0, -3, 2.9)};
  EXPECT_FALSE(labels_of(spec).instances[0].amodal->complete);
}

TEST(Amodal, WhatIsBehindTheCameraHasNothing) {
  FrameSpec spec = empty_spec();
  spec.instances = {cube_at(cube(), 1, 0, 0, 10)};
  const InstanceLabel label = labels_of(spec).instances[0];
  EXPECT_EQ(label.amodal->area_px, 0);
  EXPECT_EQ(label.amodal->rle, "");
  EXPECT_EQ(label.visible_fraction(), 0.0);
  EXPECT_EQ(label.truncation(), 0.0);
  for (const auto& corner : label.amodal->box_corners_px) EXPECT_FALSE(corner);
}

TEST(Amodal, CornersOfTheBoxAreProjected) {
  FrameSpec spec = empty_spec();
  spec.instances = {cube_at(cube(), 1, 0, 0, -11)};
  const AmodalLabel amodal = *labels_of(spec).instances[0].amodal;
  EXPECT_EQ(amodal.object_box.low, Eigen::Vector3d(-1, -1, -1));
  EXPECT_EQ(amodal.object_box.high, Eigen::Vector3d(1, 1, 1));
  // Corner 7 is (1, 1, 1): 10 m ahead; corner 0 is (-1, -1, -1): 12 m ahead. y points down.
  EXPECT_NEAR((*amodal.box_corners_px[7])[0], 90.0, 1e-9);
  EXPECT_NEAR((*amodal.box_corners_px[7])[1], 50.0, 1e-9);
  EXPECT_NEAR((*amodal.box_corners_px[0])[0], 80.0 - 100.0 / 12.0, 1e-9);
  EXPECT_NEAR((*amodal.box_corners_px[0])[1], 60.0 + 100.0 / 12.0, 1e-9);
}

TEST(Amodal, ThePoseIsRotationScaleAndTranslation) {
  Affine map = Affine::Identity();
  map.translate(Eigen::Vector3d(1, 2, -3));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  map.rotate(turn);
  map.scale(Eigen::Vector3d(0.5, 2.0, 1.25));
  const Pose pose = pose_of(map);
  EXPECT_TRUE(pose.rotation.isApprox(turn, 1e-12));
  EXPECT_TRUE(pose.scale.isApprox(Eigen::Vector3d(0.5, 2.0, 1.25), 1e-12));
  EXPECT_EQ(pose.translation_m, Eigen::Vector3d(1, 2, -3));
}

TEST(Amodal, AMirroredInstanceStillHasARotation) {
  Affine map = Affine::Identity();
  map.scale(Eigen::Vector3d(-1.0, 2.0, 3.0));
  const Pose pose = pose_of(map);
  EXPECT_NEAR(pose.rotation.determinant(), 1.0, 1e-12);
  const Eigen::Matrix3d again = pose.rotation * pose.scale.asDiagonal();
  EXPECT_TRUE(again.isApprox(map.linear(), 1e-12));
}

TEST(AmodalJson, ReadsBackWhatWasWritten) {
  const FrameLabels labels = labels_of(half_hidden());
  const Json json = to_json(labels);
  const auto read = labels_from_json(*parse_json(readable_json(json), "l"), "l");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(to_json(*read), json);
  EXPECT_DOUBLE_EQ(json["instances"][0]["visible_fraction"].get<double>(), 0.25);
}

TEST(AmodalJson, ImpossibleNumbersAreErrors) {
  const Json good = to_json(labels_of(half_hidden()));
  const auto error_of = [&](const char* key, const Json& value) {
    Json json = good;
    json["instances"][0]["amodal"][key] = value;
    const auto read = labels_from_json(json, "labels.json");
    return read ? std::string("(none)") : read.error().message;
  };
  EXPECT_EQ(error_of("complete", true), "(none)");
  EXPECT_THAT(error_of("area_px", 399), HasSubstr("instances[0]: amodal"));
  EXPECT_THAT(error_of("in_image_px", 401), HasSubstr("are visible"));
  EXPECT_THAT(error_of("in_image_px", 99), HasSubstr("100 pixels are visible"));
  EXPECT_THAT(error_of("rle", "0@"), HasSubstr("run lengths"));
  EXPECT_THAT(error_of("rle", "\x01"), HasSubstr("run lengths"));
  EXPECT_THAT(error_of("box", {70, 50, 20, 21}), HasSubstr("run lengths"));
  EXPECT_THAT(error_of("box", {70, 50, 20, -1}), HasSubstr("'box'"));
  EXPECT_THAT(error_of("box", {70, 50, 20}), HasSubstr("'box'"));
  for (const char* key : {"complete", "rle", "pose", "object_box_m", "box_corners_px", "area_px"}) {
    EXPECT_NE(error_of(key, Json::array({1, "x"})), "(none)") << key;
    EXPECT_NE(error_of(key, Json()), "(none)") << key;
  }
}

TEST(Rle, EveryStringThatWasWrittenIsReadBack) {
  for (int seed = 0; seed < 200; ++seed) {
    const int width = 1 + seed % 13;
    const int height = 1 + seed % 7;
    std::vector<std::uint8_t> mask(static_cast<std::size_t>(width * height));
    unsigned state = static_cast<unsigned>(seed) * 2654435761u + 1u;
    for (auto& pixel : mask) {
      state = state * 1664525u + 1013904223u;
      pixel = static_cast<std::uint8_t>(state >> 31);
    }
    const Rle rle = encode_rle(mask, width, height);
    const auto read = rle_from_string(rle_string(rle), width, height);
    ASSERT_TRUE(read) << seed;
    EXPECT_EQ(read->counts, rle.counts) << seed;
    EXPECT_FALSE(rle_from_string(rle_string(rle), width + 1, height)) << seed;
  }
}

TEST(Rle, NonsenseIsRefused) {
  for (const char* text : {"", "o", "oooooooooooooo", " ", "\xff", "00", "O"}) {
    EXPECT_FALSE(rle_from_string(text, 3, 3)) << text;
  }
}

/// Cube 1 at 10 m, seen by its front face; cube 2 stands before its left half.
FrameSpec with_keypoints() {
  FrameSpec spec = half_hidden();
  spec.instances[0].keypoints = {
      {"front_right", {0.95, 0.0, 1.0}, false}, {"front_left", {-0.95, 0.0, 1.0}, false},
      {"back", {0.95, 0.0, -1.0}, false},       {"middle", {0.95, 0.0, 0.0}, true},
      {"left_inside", {-0.95, 0.0, 0.0}, true}, {"far_out", {100.0, 0.0, 0.0}, false}};
  return spec;
}

TEST(Keypoints, AreVisibleHiddenOrOutside) {
  const FrameLabels labels = labels_of(with_keypoints());
  const auto& points = labels.instances[0].keypoints;
  ASSERT_EQ(points.size(), 6U);
  EXPECT_EQ(points[0].visibility, Visibility::kVisible) << "on the surface that is seen";
  EXPECT_EQ(points[1].visibility, Visibility::kHidden) << "behind the other cube";
  EXPECT_EQ(points[2].visibility, Visibility::kHidden) << "behind its own cube";
  EXPECT_EQ(points[3].visibility, Visibility::kVisible) << "inside, and its own cube hides it not";
  EXPECT_EQ(points[4].visibility, Visibility::kHidden) << "the other cube does";
  EXPECT_EQ(points[5].visibility, Visibility::kOutside);
  EXPECT_EQ(points[5].px, (std::array<double, 2>{0.0, 0.0}));
}

TEST(Keypoints, StandWhereTheyAreSeen) {
  const FrameLabels labels = labels_of(with_keypoints());
  // The front face is 10 m away and 20 px wide, from the pixel edge at 70 to that at 90.
  EXPECT_NEAR(labels.instances[0].keypoints[0].px[0], 80.0 + 9.5, 1e-9);
  EXPECT_NEAR(labels.instances[0].keypoints[0].px[1], 60.0, 1e-9);
  EXPECT_NEAR(labels.instances[0].keypoints[1].px[0], 80.0 - 9.5, 1e-9);
}

TEST(Keypoints, BehindTheCameraAreOutside) {
  FrameSpec spec = with_keypoints();
  spec.instances[0].camera_from_object(2, 3) = 20.0;
  const FrameLabels labels = labels_of(spec);
  for (const KeypointLabel& point : labels.instances[0].keypoints) {
    EXPECT_EQ(point.visibility, Visibility::kOutside);
  }
}

TEST(Keypoints, WhatTheCameraDoesNotSeeHidesNothing) {
  FrameSpec spec = with_keypoints();
  spec.instances[1].hidden_from.camera = true;
  EXPECT_EQ(labels_of(spec).instances[0].keypoints[1].visibility, Visibility::kVisible);
}

TEST(SilhouetteAreaIn, CountsInsideTheBoxOnly) {
  const AmodalLabel amodal = *labels_of(half_hidden()).instances[0].amodal;
  EXPECT_EQ(silhouette_area_in(amodal, {70, 50, 20, 20}), 400);
  EXPECT_EQ(silhouette_area_in(amodal, {0, 0, 160, 120}), 400);
  EXPECT_EQ(silhouette_area_in(amodal, {80, 55, 100, 5}), 50);
  EXPECT_EQ(silhouette_area_in(amodal, {0, 0, 70, 120}), 0);
}

}  // namespace
}  // namespace seedframe
