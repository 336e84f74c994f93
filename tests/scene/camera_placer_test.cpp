// The camera's place and lens.

#include "scene/camera_placer.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scene/scene_fixture.h"

namespace seedframe {
namespace {

using ::testing::HasSubstr;

std::string with_camera(const std::string& camera, const std::string& more = "") {
  return "seedframe: 1\nseed: 2\nrender: {width: 200, height: 100}\n" + more + "camera: {" +
         camera + "}\n";
}

CameraSpec camera_of(const std::string& camera) {
  return first_frame(with_camera(camera)).spec.camera;
}

TEST(Lens, TheFieldOfViewIsHorizontal) {
  EXPECT_NEAR(camera_of("distance_m: 1, fov_deg: 90").focal_px[0], 100.0, 1e-9);
  EXPECT_EQ(camera_of("distance_m: 1, fov_deg: 90").focal_px[0],
            camera_of("distance_m: 1, fov_deg: 90deg").focal_px[1]);
}

TEST(Lens, FocalLengthsMayDifferByAxis) {
  EXPECT_EQ(camera_of("distance_m: 1, focal_px: 150").focal_px, (std::array<double, 2>{150, 150}));
  EXPECT_EQ(camera_of("distance_m: 1, focal_px: [150, 170]").focal_px,
            (std::array<double, 2>{150, 170}));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, focal_px: [1, 2, 3]")),
              HasSubstr("camera.focal_px: expected a focal length or [fx, fy], found a list of 3"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, focal_px: 9, fov_deg: 9")),
              HasSubstr("fov_deg and focal_px exclude each other"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, focal_px: [150, -1]")),
              HasSubstr("camera.focal_px[1]: focal_px must be above 0, found -1"));
}

TEST(Lens, FocalLengthsAreAtMost200TimesEachOther) {
  EXPECT_EQ(camera_of("distance_m: 1, focal_px: [30000, 150]").focal_px[0], 30000.0);
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, focal_px: [150, 30001]")),
              HasSubstr("camera.focal_px[1]: the pixels are too far from square"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, focal_px: [30001, 150]")),
              HasSubstr("at most 200 times the other"));
}

TEST(Lens, NothingNearerThanAMicrometreIsAskedFor) {
  EXPECT_EQ(camera_of("distance_m: 1, clip_start_m: 1e-6").clip_start_m, 1e-6);
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, clip_start_m: 9e-7")),
              HasSubstr("camera.clip_start_m: clip_start_m must be at least 1e-06"));
}

TEST(Lens, ThePrincipalPointIsTheMiddleOrWhatIsGiven) {
  EXPECT_EQ(camera_of("distance_m: 1").center_px, (std::array<double, 2>{99.5, 49.5}));
  EXPECT_EQ(camera_of("distance_m: 1, center_px: [0, -20.5]").center_px,
            (std::array<double, 2>{0, -20.5}));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, center_px: 3")),
              HasSubstr("expected [cx, cy]"));
}

TEST(Lens, ADrawnFocalLengthIsOneDrawForBothAxes) {
  const CameraSpec camera = camera_of("distance_m: 1, focal_px: {uniform: [100, 200]}");
  EXPECT_EQ(camera.focal_px[0], camera.focal_px[1]);
}

TEST(Lens, TheApertureFollowsFromTheFStop) {
  // 100 px of 200 on a sensor of 36 mm: a lens of 18 mm; at f/2 its opening is 9 mm wide.
  const CameraSpec camera = camera_of("distance_m: 3, focal_px: 100, f_stop: 2");
  EXPECT_NEAR(camera.aperture_radius_m, 0.0045, 1e-15);
  EXPECT_NEAR(camera.focus_distance_m, 3.0, 1e-12);
  // A phone: 4 mm of sensor, a lens of 2 mm.
  EXPECT_NEAR(
      camera_of("distance_m: 3, focal_px: 100, f_stop: 2, sensor_width_mm: 4").aperture_radius_m,
      0.0005, 1e-15);
  EXPECT_DOUBLE_EQ(camera_of("distance_m: 3, f_stop: 2, focus_distance_m: 70cm").focus_distance_m,
                   0.7);
}

TEST(Lens, WithoutAnFStopItIsAPinhole) {
  const CameraSpec camera = camera_of("distance_m: 3, focus_distance_m: 2");
  EXPECT_EQ(camera.aperture_radius_m, 0.0);
  EXPECT_EQ(camera.focus_distance_m, 0.0);
  EXPECT_THAT(scene_error(with_camera("distance_m: 3, f_stop: -1")),
              HasSubstr("f_stop must be at least"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 3, f_stop: 1, focus_distance_m: 0")),
              HasSubstr("focus_distance_m must be above 0"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 3, f_stop: 1, sensor_width_mm: 0")),
              HasSubstr("sensor_width_mm must be above 0"));
}

constexpr const char* kRobot =
    "objects:\n  robot: {asset: cube, category: none, position: [10, 20, 1], rotation_deg: [0, 0, "
    "90], scale: [2, 3, 4], count: 2}\n  ball: {asset: sphere, category: none, position: [10, 25, "
    "1]}\n";

TEST(CameraParent, PositionAndTargetAreRelativeToItsFirstCopyWithoutItsScale) {
  // Turned by 90°, the parent's x is the world's y: the camera looks from (10, 21, 1) along y.
  const auto frame =
      first_frame(with_camera("parent: robot, position: [1, 0, 0], target: [2, 0, 0]", kRobot));
  const Eigen::Vector3d ball = frame.spec.instances.at(2).camera_from_object.translation();
  EXPECT_LT((ball - Eigen::Vector3d(0, 0, -4)).norm(), 1e-12);
}

TEST(CameraParent, UpIsTheParentsZ) {
  const auto frame = first_frame(
      with_camera("parent: o, position: [0, 0, 0], target: [0, 1, 0]",
                  "objects: {o: {asset: cube, category: none, rotation_deg: [0, 90, 0]}}\n"));
  // The parent lies on its side: its z is the world's x, and so is the image's y.
  const Eigen::Vector3d world_x_seen =
      frame.spec.instances.at(0).camera_from_object.linear() * Eigen::Vector3d(0, 0, 1);
  EXPECT_LT((world_x_seen - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
}

TEST(CameraParent, AGroupCanBeAMerePlace) {
  const auto frame = first_frame(with_camera(
      "parent: mount, position: [0, 0, 0], target: [0, 1, 0]",
      "objects: {o: {asset: cube, category: none}, mount: {position: [0, -7, 0], objects: "
      "{}}}\n"));
  EXPECT_NEAR(frame.spec.instances.at(0).camera_from_object.translation().z(), -7.0, 1e-12);
}

TEST(CameraParent, MustBeThereAndHaveATarget) {
  EXPECT_THAT(
      scene_error(with_camera("parent: robto, position: [1, 0, 0], target: [2, 0, 0]", kRobot)),
      HasSubstr("there is no object 'robto' to be the camera's parent (did you mean "
                "'robot'?)"));
  EXPECT_THAT(scene_error(with_camera("parent: robot, position: [1, 0, 0]", kRobot)),
              HasSubstr("a camera with a parent needs a target"));
  EXPECT_THAT(scene_error(with_camera("parent: o, position: [1, 0, 0], target: [0, 0, 0]",
                                      "objects: {o: {asset: cube, category: none, count: 0}}\n")),
              HasSubstr("the camera's parent 'o' has no copies in this frame"));
}

TEST(Camera, LooksAtTheMiddleOfAllObjects) {
  const auto frame = first_frame(with_camera(
      "distance_m: 2, elevation_deg: 0",
      "ground: {}\nobjects:\n  a: {asset: cube, category: none, position: [1, 0, 0]}\n  g: "
      "{position: [5, 0, 0], objects: {b: {asset: cube, category: none}}}\n"));
  // The middle is at x = 3; the ground does not count.
  EXPECT_NEAR(frame.spec.instances.at(1).camera_from_object.translation().x(), -2.0, 1e-9);
  EXPECT_NEAR(frame.spec.instances.at(2).camera_from_object.translation().x(), 2.0, 1e-9);
}

TEST(Camera, WithoutObjectsItLooksAtTheOrigin) {
  const auto frame = first_frame(with_camera("distance_m: 2, elevation_deg: 90", "ground: {}\n"));
  EXPECT_NEAR(frame.spec.instances.at(0).camera_from_object.translation().z(), -2.0, 1e-12);
}

TEST(Camera, CannotStandWhereItLooks) {
  EXPECT_THAT(scene_error(with_camera("position: [1, 2, 3], target: [1, 2, 3]")),
              HasSubstr("the camera stands where it looks"));
}

TEST(Camera, UnitsAreChecked) {
  EXPECT_THAT(scene_error(with_camera("distance_m: 30deg")),
              HasSubstr("camera.distance_m: this is in deg, but m is needed here"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 30deg + 2m")),
              HasSubstr("'+' between a number in deg and a number in m"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, roll_deg: 1m")),
              HasSubstr("this is in m, but deg is needed here"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, f_stop: 1m")),
              HasSubstr("this is in m, but a plain number is needed here"));
  EXPECT_EQ(scene_error(with_camera("distance_m: 150cm, azimuth_deg: 1rad, roll_deg: 90deg")),
            "(no error)");
}

TEST(Camera, APositionBeyondAllNumbersIsRefused) {
  const std::string objects = "objects: {o: {asset: cube, category: none}}\n";
  const std::string lights = "lights: {l: {power: 1}}\n";
  const std::string far = "position: [1e308, 1e308, 1e308], target: [-1e308, 1e308, 0]";
  for (const std::string& more : {std::string(), objects, lights, objects + lights}) {
    EXPECT_THAT(scene_error(with_camera(far, more)), HasSubstr("scene.yaml")) << more;
    EXPECT_THAT(scene_error(with_camera(far, more)), HasSubstr("too large to compute with"))
        << more;
  }
  EXPECT_THAT(scene_error(with_camera("position: [1e200, 0, 0], target: [0, 0, 0]")),
              HasSubstr("camera: the position or the target is too large"));
  EXPECT_THAT(scene_error(with_camera("position: [1e-200, 0, 0], target: [0, 0, 0]")),
              HasSubstr("the camera stands where it looks"));
  EXPECT_THAT(scene_error(with_camera("distance_m: 1, f_stop: 1e-320")),
              HasSubstr("the camera has a number that is too large"));
}

}  // namespace
}  // namespace seedframe
