#include "rays/ray_scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "base/portable_math.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

constexpr std::size_t kAllPixels = 1'000'000'000;

/// A ball of radius 1 m, so fine that it differs from a sphere by less than 0.1 %.
Mesh ball() {
  constexpr std::uint32_t kRows = 96;
  constexpr std::uint32_t kColumns = 192;
  Mesh mesh;
  for (std::uint32_t j = 0; j <= kRows; ++j) {
    for (std::uint32_t i = 0; i < kColumns; ++i) {
      const double polar = portable::kPi * j / kRows;
      const double around = 2.0 * portable::kPi * i / kColumns;
      mesh.positions.push_back({static_cast<float>(std::sin(polar) * std::cos(around)),
                                static_cast<float>(std::sin(polar) * std::sin(around)),
                                static_cast<float>(std::cos(polar))});
    }
  }
  for (std::uint32_t j = 0; j < kRows; ++j) {
    for (std::uint32_t i = 0; i < kColumns; ++i) {
      const std::uint32_t next = (i + 1) % kColumns;
      const std::uint32_t a = j * kColumns + i;
      const std::uint32_t b = j * kColumns + next;
      mesh.triangles.push_back({a, a + kColumns, b + kColumns});
      mesh.triangles.push_back({a, b + kColumns, b});
    }
  }
  return mesh;
}

RayInstance instance_of(const Mesh& mesh, const Eigen::Affine3d& camera_from_object) {
  return {std::make_shared<const RayMesh>(mesh), camera_from_object, true};
}

RayInstance ball_at(double x, double y, double z, double radius = 1.0) {
  static const Mesh mesh = ball();
  return instance_of(mesh, Eigen::Translation3d(x, y, z) * Eigen::UniformScaling<double>(radius) *
                               Eigen::Affine3d::Identity());
}

/// A box from low to high in the camera's frame: x right, y up, -z ahead.
RayInstance box_of(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() = Eigen::Vector3d(0.5 * (high - low)).asDiagonal();
  pose.translation() = 0.5 * (low + high);
  return instance_of(example_cube(), pose);
}

constexpr PixelCamera kCamera{160, 120, {100.0, 100.0}, {79.5, 59.5}, 0.01, 1000.0};

/// Whether the ray through a pixel's centre meets a sphere.
bool meets_sphere(const PixelCamera& camera, int x, int y, const Eigen::Vector3d& centre,
                  double radius) {
  const Eigen::Vector3d ray((x - camera.center_px[0]) / camera.focal_px[0],
                            (camera.center_px[1] - y) / camera.focal_px[1], -1.0);
  const double along = ray.dot(centre) / ray.squaredNorm();
  return along > 0.0 && (along * ray - centre).norm() < radius;
}

template <class Condition>
double pixels_where(int from_x, int to_x, int from_y, int to_y, Condition condition) {
  double count = 0.0;
  for (int y = from_y; y < to_y; ++y) {
    for (int x = from_x; x < to_x; ++x) count += condition(x, y) ? 1.0 : 0.0;
  }
  return count;
}

TEST(RayScene, ABallAloneHasItsDisc) {
  const RayScene scene(kCamera, {ball_at(0.5, -0.2, -5)});
  const PixelCounts counts = scene.count(0, kAllPixels);
  const double expected = pixels_where(0, 160, 0, 120, [](int x, int y) {
    return meets_sphere(kCamera, x, y, {0.5, -0.2, -5}, 1.0);
  });
  // The rim is a polygon's: off by less than half a pixel all around, a hundred or so.
  EXPECT_NEAR(counts.whole, expected, 8.0);
  EXPECT_EQ(counts.in_image, counts.whole);
  EXPECT_EQ(counts.visible, counts.whole);
}

TEST(RayScene, AWallHidesHalfOfABall) {
  const RayScene scene(kCamera, {ball_at(0, 0, -5), box_of({-9, -9, -3.1}, {0, 9, -3})});
  const PixelCounts counts = scene.count(0, kAllPixels);
  const double expected = pixels_where(80, 160, 0, 120, [](int x, int y) {
    return meets_sphere(kCamera, x, y, {0, 0, -5}, 1.0);
  });
  EXPECT_NEAR(counts.visible, expected, 8.0);
  EXPECT_NEAR(counts.visible / counts.in_image, 0.5, 0.01);
  // The wall itself is in front of everything.
  const PixelCounts wall = scene.count(1, kAllPixels);
  EXPECT_EQ(wall.visible, wall.in_image);
}

TEST(RayScene, ABallBehindABallIsWhatTwoDiscsLeave) {
  const RayScene scene(kCamera, {ball_at(0.9, 0.3, -8), ball_at(0, 0, -5)});
  const PixelCounts counts = scene.count(0, kAllPixels);
  const double expected = pixels_where(0, 160, 0, 120, [](int x, int y) {
    return meets_sphere(kCamera, x, y, {0.9, 0.3, -8}, 1.0) &&
           !meets_sphere(kCamera, x, y, {0, 0, -5}, 1.0);
  });
  ASSERT_GT(expected, 50.0);
  ASSERT_LT(expected, 0.9 * counts.in_image);
  EXPECT_NEAR(counts.visible, expected, 8.0);
}

TEST(RayScene, WhatIsBehindAWallIsNotVisibleButInTheImage) {
  const RayScene scene(kCamera, {ball_at(0, 0, -5), box_of({-9, -9, -3.1}, {9, 9, -3})});
  const PixelCounts counts = scene.count(0, kAllPixels);
  EXPECT_GT(counts.in_image, 1000.0);
  EXPECT_EQ(counts.visible, 0.0);
}

TEST(RayScene, WhatIsFarAwayIsSeenAsSharplyAsWhatIsNear) {
  // A pixel is 0.05 m wide there, and the step between float32 numbers 0.03 m.
  PixelCamera camera = kCamera;
  camera.focal_px = {1e7, 1e7};
  camera.clip_end_m = 1e6;
  const RayScene scene(camera, {ball_at(0.5, -0.2, -5e5)});
  int wrong = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      const bool hit = meets_sphere(camera, x, y, {0.5, -0.2, -5e5}, 1.0);
      wrong += hit != (scene.first_hit(x, y) == 0) ? 1 : 0;
    }
  }
  EXPECT_LE(wrong, 8) << "as near: the rim is a polygon's";
  TraceOptions options;
  options.depth = true;
  EXPECT_NEAR(scene.trace(options).depth[scene.trace(options).index(90, 63)], 5e5 - 1.0, 0.04);
}

TEST(RayScene, FarThingsAreClippedToo) {
  PixelCamera camera = kCamera;
  camera.focal_px = {1e4, 1e4};
  const RayInstance far_ball = ball_at(0, 0, -500);
  const double disc = RayScene(camera, {far_ball}).count(0, kAllPixels).whole;
  EXPECT_NEAR(disc, 400 * portable::kPi, 12.0) << "its radius is 20 pixels";
  camera.clip_end_m = 400.0;
  EXPECT_EQ(RayScene(camera, {far_ball}).count(0, kAllPixels).whole, 0.0);
  camera.clip_end_m = 1000.0;
  camera.clip_start_m = 500.5;  // within the ball: its far side is seen, of a radius of 0.87 m
  EXPECT_NEAR(RayScene(camera, {far_ball}).count(0, kAllPixels).whole, 0.75 * disc, 12.0);
  camera.clip_start_m = 502.0;
  EXPECT_EQ(RayScene(camera, {far_ball}).count(0, kAllPixels).whole, 0.0);
}

TEST(RayScene, WhatIsBehindTheCameraIsNowhere) {
  const RayScene scene(kCamera, {ball_at(0, 0, 5)});
  const PixelCounts counts = scene.count(0, kAllPixels);
  EXPECT_EQ(counts.whole, 0.0);
  EXPECT_EQ(counts.in_image, 0.0);
  EXPECT_EQ(counts.visible, 0.0);
}

TEST(RayScene, TheSilhouetteReachesBeyondTheImagesEdge) {
  // 80 pixels to the right of the middle is the edge: half of the ball is outside.
  const RayScene scene(kCamera, {ball_at(4, 0, -5)});
  const PixelCounts counts = scene.count(0, kAllPixels);
  const auto hit = [](int x, int y) { return meets_sphere(kCamera, x, y, {4, 0, -5}, 1.0); };
  const double whole = pixels_where(-160, 320, -120, 240, hit);
  const double inside = pixels_where(0, 160, 0, 120, hit);
  ASSERT_LT(inside, 0.7 * whole);
  EXPECT_NEAR(counts.whole, whole, 12.0);
  EXPECT_NEAR(counts.in_image, inside, 8.0);
  EXPECT_EQ(counts.visible, counts.in_image);
}

TEST(RayScene, WhatIsFarOutOfViewIsNotLookedFor) {
  // Farther to the left than the image is wide.
  const RayScene scene(kCamera, {ball_at(-20, 0, -5)});
  EXPECT_EQ(scene.count(0, kAllPixels).whole, 0.0);
}

TEST(RayScene, ABoxAroundTheCameraFillsTheImage) {
  const RayScene scene(kCamera, {box_of({-2, -2, -2}, {2, 2, 2})});
  const PixelCounts counts = scene.count(0, kAllPixels);
  EXPECT_EQ(counts.in_image, 160.0 * 120.0);
  EXPECT_EQ(counts.visible, 160.0 * 120.0);
  EXPECT_EQ(counts.whole, 9.0 * 160.0 * 120.0);
}

TEST(RayScene, TheClipsAreDepthsAndNotDistances) {
  PixelCamera camera = kCamera;
  // The wall at a depth of 10 m is 11.3 m away in the corners.
  camera.clip_end_m = 10.5;
  const RayInstance wall = box_of({-99, -99, -10.1}, {99, 99, -10});
  EXPECT_EQ(RayScene(camera, {wall}).count(0, kAllPixels).in_image, 160.0 * 120.0);
  camera.clip_end_m = 9.9;
  EXPECT_EQ(RayScene(camera, {wall}).count(0, kAllPixels).whole, 0.0);
  camera.clip_end_m = 1000.0;
  camera.clip_start_m = 10.05;  // the front is cut away, the back is seen
  EXPECT_EQ(RayScene(camera, {wall}).count(0, kAllPixels).in_image, 160.0 * 120.0);
  camera.clip_start_m = 10.2;
  EXPECT_EQ(RayScene(camera, {wall}).count(0, kAllPixels).whole, 0.0);
}

TEST(RayScene, WhatTheCameraDoesNotSeeHidesNothing) {
  RayInstance wall = box_of({-9, -9, -3.1}, {9, 9, -3});
  wall.seen = false;
  const RayScene scene(kCamera, {ball_at(0, 0, -5), wall});
  const PixelCounts counts = scene.count(0, kAllPixels);
  EXPECT_EQ(counts.visible, counts.in_image);
  EXPECT_EQ(scene.count(1, kAllPixels).whole, 0.0);
}

TEST(RayScene, FirstHitNamesTheNearestInstance) {
  const RayScene scene(kCamera, {ball_at(0, 0, -8), ball_at(0, 0, -5, 0.5)});
  EXPECT_EQ(scene.first_hit(79, 59), 1);
  EXPECT_EQ(scene.first_hit(79 + 11, 59), 0);
  EXPECT_EQ(scene.first_hit(0, 0), -1);
}

TEST(RayScene, PixelCentresAreWholeNumbersAndYPointsDown) {
  // A plate that covers the columns 100 to 109 and the rows 20 to 39, to half a pixel.
  const auto x = [](double column) { return (column - 79.5) / 100.0 * 10.0; };
  const auto y = [](double row) { return (59.5 - row) / 100.0 * 10.0; };
  const RayScene scene(kCamera, {box_of({x(99.5), y(39.5), -10.001}, {x(109.5), y(19.5), -10})});
  EXPECT_EQ(scene.count(0, kAllPixels).visible, 200.0);
  EXPECT_EQ(scene.first_hit(100, 20), 0);
  EXPECT_EQ(scene.first_hit(109, 39), 0);
  EXPECT_EQ(scene.first_hit(99, 30), -1);
  EXPECT_EQ(scene.first_hit(110, 30), -1);
  EXPECT_EQ(scene.first_hit(105, 19), -1);
  EXPECT_EQ(scene.first_hit(105, 40), -1);
}

TEST(RayScene, APrincipalPointAndPixelsThatAreNotSquareAreFollowed) {
  const PixelCamera camera{160, 120, {100.0, 50.0}, {20.0, 100.0}, 0.01, 1000.0};
  const RayScene scene(camera, {ball_at(0, 0, -5)});
  const auto hit = [&](int x, int y) { return meets_sphere(camera, x, y, {0, 0, -5}, 1.0); };
  EXPECT_NEAR(scene.count(0, kAllPixels).in_image, pixels_where(0, 160, 0, 120, hit), 8.0);
  EXPECT_NEAR(scene.count(0, kAllPixels).whole, pixels_where(-160, 320, -120, 240, hit), 8.0);
}

TEST(RayScene, FewRaysGiveNearlyTheSameCounts) {
  const RayScene scene(kCamera, {ball_at(0.3, 0, -3), box_of({-9, -9, -1.6}, {0, 9, -1.5})});
  const PixelCounts all = scene.count(0, kAllPixels);
  const PixelCounts few = scene.count(0, 500);
  EXPECT_NEAR(few.whole / all.whole, 1.0, 0.1);
  EXPECT_NEAR(few.visible / few.in_image, all.visible / all.in_image, 0.05);
}

TEST(RayScene, TurnedAndStretchedInstancesAreWhereTheyShouldBe) {
  // A ball stretched to an ellipsoid of 2 m by 0.5 m, turned upright by a quarter.
  static const Mesh mesh = ball();
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.5 * portable::kPi, Eigen::Vector3d::UnitZ()).matrix() *
                  Eigen::Vector3d(2, 0.5, 0.5).asDiagonal();
  pose.translation() = Eigen::Vector3d(0, 0, -20);
  const Eigen::Affine3d object_from_camera = pose.inverse();
  const auto hit = [&](int x, int y) {  // in the ball's own space it is a sphere again
    const Eigen::Vector3d start = object_from_camera.translation();
    const Eigen::Vector3d ray =
        object_from_camera.linear() * Eigen::Vector3d((x - 79.5) / 100.0, (59.5 - y) / 100.0, -1.0);
    const double along = -ray.dot(start) / ray.squaredNorm();
    return (start + along * ray).norm() < 1.0;
  };
  const RayScene scene(kCamera, {instance_of(mesh, pose)});
  EXPECT_NEAR(scene.count(0, kAllPixels).visible, pixels_where(0, 160, 0, 120, hit), 2.0);
  EXPECT_EQ(scene.first_hit(79, 51), 0);
  EXPECT_EQ(scene.first_hit(87, 59), -1);
}

TEST(RayScene, TracingTheImageIsAskingForEachPixel) {
  const RayScene scene(
      kCamera, {ball_at(0.9, 0.3, -8), ball_at(0, 0, -5), box_of({-9, -9, -20.1}, {0, 9, -20})});
  const RayImage image = scene.trace({});
  for (int y = 0; y < 120; y += 3) {
    for (int x = 0; x < 160; ++x) {
      ASSERT_EQ(image.instance[image.index(x, y)], scene.first_hit(x, y)) << x << " " << y;
    }
  }
  EXPECT_TRUE(image.depth.empty());
  EXPECT_TRUE(image.normals.empty());
}

TEST(RayScene, ImagesWhoseSidesAreNotWholePacketsAreTracedToTheLastPixel) {
  const PixelCamera camera{13, 7, {10.0, 10.0}, {6.0, 3.0}, 0.01, 1000.0};
  const RayScene scene(camera, {box_of({-99, -99, -2}, {99, 99, -1})});
  const RayImage image = scene.trace({.depth = true});
  ASSERT_EQ(image.instance.size(), 91U);
  EXPECT_TRUE(
      std::all_of(image.instance.begin(), image.instance.end(), [](int i) { return i == 0; }));
  EXPECT_TRUE(std::all_of(image.depth.begin(), image.depth.end(),
                          [](float d) { return std::abs(d - 1.0F) < 1e-5F; }));
}

TEST(RayScene, PortableDepthAndNormalsAreThoseOfTheTrianglesPlane) {
  // A box turned about y by an angle whose sine is 0.6 and whose cosine is 0.8.
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() << 0.8, 0, 0.6, 0, 1, 0, -0.6, 0, 0.8;
  pose.translation() = Eigen::Vector3d(0, 0, -7);
  RayInstance box = box_of({-2, -2, -2}, {2, 2, 1});
  box.camera_from_object = pose;
  const RayScene scene(kCamera, {box});
  const RayImage image = scene.trace({.depth = true, .portable_depth = true, .normals = true});
  const Eigen::Vector3d up(0.6, 0, 0.8);  // of the face z = 1
  int seen = 0;
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      const std::size_t pixel = image.index(x, y);
      if (image.instance[pixel] < 0 || image.normals[pixel][2] < 0.7F) continue;
      const Eigen::Vector3d ray(kCamera.ray_x(x), kCamera.ray_y(y), -1.0);
      const double depth = up.dot(pose * Eigen::Vector3d(0, 0, 1)) / up.dot(ray);
      ASSERT_FLOAT_EQ(image.depth[pixel], static_cast<float>(depth)) << x << " " << y;
      EXPECT_NEAR(image.normals[pixel][0], 0.6F, 1e-6F);
      ++seen;
    }
  }
  EXPECT_GT(seen, 500);
}

TEST(RayScene, ASilhouetteIsTheInstanceAlone) {
  const std::vector<RayInstance> instances = {ball_at(0.9, 0.3, -8), ball_at(0, 0, -5),
                                              ball_at(-3.9, 0, -5)};
  const RayScene scene(kCamera, instances);
  const RayImage image = scene.trace({});
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const RayScene alone(kCamera, {instances[i]});
    const Silhouette silhouette = scene.silhouette(i, image);
    const PixelCounts counts = alone.count(0, kAllPixels);
    EXPECT_EQ(static_cast<double>(silhouette.area_px), counts.whole);
    EXPECT_EQ(static_cast<double>(silhouette.in_image_px), counts.in_image);
    ASSERT_EQ(silhouette.mask.size(), static_cast<std::size_t>(silhouette.box.area()));
    const PixelRect& box = silhouette.box;
    for (int y = std::max(0, box.y); y < std::min(120, box.end_y()); ++y) {
      for (int x = std::max(0, box.x); x < std::min(160, box.end_x()); ++x) {
        const auto at = static_cast<std::size_t>((y - box.y) * box.width + x - box.x);
        ASSERT_EQ(silhouette.mask[at] != 0, alone.first_hit(x, y) == 0);
      }
    }
  }
}

TEST(RayScene, ASilhouetteIsTight) {
  const RayScene scene(kCamera, {ball_at(0.5, -0.2, -5)});
  const Silhouette silhouette = scene.silhouette(0, scene.trace({}));
  const PixelRect& box = silhouette.box;
  const auto any = [&](int x0, int x1, int y0, int y1) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (silhouette.mask[static_cast<std::size_t>(y * box.width + x)] != 0) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(any(0, 1, 0, box.height));
  EXPECT_TRUE(any(box.width - 1, box.width, 0, box.height));
  EXPECT_TRUE(any(0, box.width, 0, 1));
  EXPECT_TRUE(any(0, box.width, box.height - 1, box.height));
}

TEST(RayScene, AnEmptySceneHitsNothing) { EXPECT_EQ(RayScene(kCamera, {}).first_hit(10, 10), -1); }

}  // namespace
}  // namespace seedframe
