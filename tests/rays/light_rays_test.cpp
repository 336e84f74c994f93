// Rays of light, and where on a mesh rays arrive.
#include <gtest/gtest.h>

#include "rays/ray_scene.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

constexpr PixelCamera kLensOf100px{160, 120, {100.0, 100.0}, {79.5, 59.5}, 0.01, 10'000.0};

/// In the camera's frame: x right, y up, -z ahead.
RayInstance box_between(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.linear() = Eigen::Vector3d(0.5 * (high - low)).asDiagonal();
  pose.translation() = 0.5 * (low + high);
  return {std::make_shared<const RayMesh>(example_cube()), pose};
}

/// A floor of 20 m sides, 1 m below the camera, and a box of 1 m on it, 5 m ahead.
std::vector<RayInstance> box_on_floor() {
  return {box_between({-10, -2, -15}, {10, -1, 5}), box_between({-0.5, -1, -5.5}, {0.5, 0, -4.5})};
}

TEST(LightRays, AreStoppedByWhatIsInTheirWay) {
  const RayScene scene(kLensOf100px, box_on_floor());
  const Eigen::Vector3d right = Eigen::Vector3d(1, 1, 0).normalized();
  const std::vector<LightRay> rays = {{{-1.0, -0.999, -5.0}, right},  // of a point left of the box
                                      {{1.0, -0.999, -5.0}, right},   // of one right of it
                                      {{-1.0, -0.999, -5.0}, right, 0.5},  // ends before the box
                                      {{-1.0, -0.999, -5.0}, Eigen::Vector3d(0, 1, 0)},
                                      {{-1.0, 3.0, -5.0}, Eigen::Vector3d(0, -1, 0)},  // the floor
                                      {{0.0, 0.001, -5.0}, Eigen::Vector3d(0, 1, 0)},
                                      {{0.0, 0.001, -5.0}, right},
                                      {{0.0, -0.5, -4.0}, Eigen::Vector3d(0, 0, -1)},
                                      {{0.0, 0.5, -4.0}, Eigen::Vector3d(0, 0, -1)}};
  std::vector<std::uint8_t> in_shadow(rays.size());
  scene.find_shadows(rays, in_shadow);
  EXPECT_EQ(in_shadow, (std::vector<std::uint8_t>{1, 0, 0, 0, 1, 0, 0, 1, 0}));
  std::vector<LightHit> hits(rays.size());
  scene.find_hits(rays, hits);
  EXPECT_EQ(hits[0].instance, 1);
  EXPECT_EQ(hits[1].instance, -1);
  EXPECT_EQ(hits[2].instance, -1);
  EXPECT_EQ(hits[4].instance, 0);
  EXPECT_NEAR(hits[4].distance_m, 4.0, 1e-4);
  EXPECT_EQ(hits[7].instance, 1);
  EXPECT_NEAR(hits[7].distance_m, 0.5, 1e-4);
}

TEST(LightRays, MeetWhatTheCameraDoesNotSeeAndPassWhatThrowsNoShadow) {
  std::vector<RayInstance> instances = box_on_floor();
  const std::vector<LightRay> rays = {
      {{-1.0, -0.999, -5.0}, Eigen::Vector3d(1, 1, 0).normalized()}};
  std::vector<std::uint8_t> in_shadow(1);
  instances[1].seen = false;
  RayScene(kLensOf100px, instances).find_shadows(rays, in_shadow);
  EXPECT_EQ(in_shadow[0], 1);
  instances[1].seen = true;
  instances[1].throws_shadow = false;
  const RayScene scene(kLensOf100px, instances);
  scene.find_shadows(rays, in_shadow);
  EXPECT_EQ(in_shadow[0], 0);
  EXPECT_EQ(scene.first_hit(79, 69), 1) << "it is seen all the same";
}

TEST(LightRays, OfASceneThatIsFarAwayAreAsExact) {
  const RayScene scene(kLensOf100px, {box_between({-1, -1, -5001}, {1, 1, -5000})});
  const std::vector<LightRay> rays = {
      {{0, 0, -4999.9}, {0, 0, -1}}, {{0, 0, -5000.1}, {0, 0, 1}}, {{0, 0, -4999.9}, {0, 0, 1}}};
  std::vector<LightHit> hits(rays.size());
  scene.find_hits(rays, hits);
  EXPECT_NEAR(hits[0].distance_m, 0.1, 1e-3);
  EXPECT_NEAR(hits[1].distance_m, 0.1, 1e-3);
  EXPECT_EQ(hits[2].instance, -1);
}

TEST(SurfacePoints, AreWhereThePixelsRaysArrive) {
  const Mesh cube = example_cube();
  Eigen::Affine3d pose = Eigen::Affine3d::Identity();
  pose.translate(Eigen::Vector3d(0, 0, -5))
      .rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 1, 0).normalized()));
  const RayScene scene(kLensOf100px, {{std::make_shared<const RayMesh>(cube), pose}});
  const RayImage image = scene.trace({.depth = true, .portable_depth = true, .points = true});
  int seen = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t pixel = image.index(x, y);
      if (image.instance[pixel] < 0) continue;
      ++seen;
      const SurfacePoint& point = image.points[pixel];
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      const std::array<double, 3> shares = {1.0 - point.u - point.v, point.u, point.v};
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto& at = cube.positions[cube.triangles[point.triangle][corner]];
        sum += shares[corner] * Eigen::Vector3d(at[0], at[1], at[2]);
      }
      const Eigen::Vector3d place = pose * sum;
      ASSERT_NEAR(-place.z(), image.depth[pixel], 1e-4);
      ASSERT_NEAR(kLensOf100px.center_px[0] + 100.0 * place.x() / -place.z(), x, 1e-2);
      ASSERT_NEAR(kLensOf100px.center_px[1] - 100.0 * place.y() / -place.z(), y, 1e-2);
    }
  }
  EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace seedframe
