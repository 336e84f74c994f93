#include <cmath>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "base/philox.h"
#include "rays/projected_box.h"
#include "rays/ray_scene.h"
#include "tests/mesh/example_meshes.h"

namespace seedframe {
namespace {

constexpr PixelCamera kPinhole{48, 36, {40.0, 40.0}, {23.5, 17.5}, 0.05, 100.0};

/// Cubes that turn any way, from before the near plane to far behind each other; every third is
/// stretched.
std::vector<RayInstance> cubes_anywhere(int count, std::uint64_t seed) {
  const PhiloxStream draws(seed, "cubes");
  std::uint32_t draw = 0;
  const auto between = [&](double low, double high) {
    return low + (high - low) * draws.uniform({.attempt = draw++});
  };
  const auto mesh = std::make_shared<const RayMesh>(example_cube());
  std::vector<RayInstance> instances;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d axis(between(-1, 1), between(-1, 1), between(-1, 1));
    const Eigen::Vector3d scale(between(0.05, 0.5), between(0.05, 0.5),
                                i % 3 == 0 ? between(0.001, 2.0) : between(0.05, 0.5));
    const double depth = between(-0.5, 8.0);
    const Eigen::Affine3d pose =
        Eigen::Translation3d(between(-1, 1) * (depth + 1), between(-1, 1) * (depth + 1), -depth) *
        Eigen::AngleAxisd(between(0, 6), axis.normalized()) * Eigen::Scaling(scale);
    instances.push_back({mesh, pose, true});
  }
  return instances;
}

/// A ring whose surface has bumps and folds: many layers and thin triangles, seen from any side.
Mesh bumpy_ring(std::uint32_t around, std::uint32_t across, bool closed) {
  const PhiloxStream draws(11, "bumps");
  Mesh mesh;
  constexpr double kTurn = 6.283185307179586;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double a = kTurn * i / around;
      const double b = kTurn * j / across;
      const double radius = 0.3 + 0.1 * draws.uniform({.attempt = i * across + j});
      const double out = 0.7 + radius * std::cos(b);
      mesh.positions.push_back({static_cast<float>(out * std::cos(a)),
                                static_cast<float>(out * std::sin(a)),
                                static_cast<float>(radius * std::sin(b))});
    }
  }
  for (std::uint32_t i = 0; i < around - (closed ? 0 : 1); ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t next_i = (i + 1) % around;
      const std::uint32_t next_j = (j + 1) % across;
      const std::array<std::uint32_t, 4> corner = {i * across + j, next_i * across + j,
                                                   next_i * across + next_j, i * across + next_j};
      mesh.triangles.push_back({corner[0], corner[1], corner[2]});
      mesh.triangles.push_back({corner[0], corner[2], corner[3]});
    }
  }
  mesh.corner_uvs.resize(3 * mesh.triangles.size());
  mesh.triangle_slots.resize(mesh.triangles.size());
  mesh.slot_names = {"surface"};
  return mesh;
}

/// As cubes_anywhere, of another mesh.
std::vector<RayInstance> anywhere(const Mesh& mesh, int count, std::uint64_t seed) {
  std::vector<RayInstance> instances = cubes_anywhere(count, seed);
  const auto shared = std::make_shared<const RayMesh>(mesh);
  for (RayInstance& instance : instances) instance.mesh = shared;
  return instances;
}

/// What every pixel of the canvas sees of the instance alone, asked one by one.
void expect_every_pixel(const Silhouette& silhouette, const RayInstance& instance) {
  const RayScene alone(kPinhole, {instance});
  const PixelRect canvas = enlarged_canvas(kPinhole);
  std::int64_t area = 0;
  for (int y = canvas.y; y < canvas.end_y(); ++y) {
    for (int x = canvas.x; x < canvas.end_x(); ++x) {
      const PixelRect& box = silhouette.box;
      const bool set =
          box.contains(x, y) &&
          silhouette.mask[static_cast<std::size_t>((y - box.y) * box.width + x - box.x)] != 0;
      ASSERT_EQ(set, alone.first_hit(x, y) == 0) << x << " " << y;
      area += set ? 1 : 0;
    }
  }
  EXPECT_EQ(silhouette.area_px, area);
}

/// Each silhouette of a scene against what every pixel sees.
void expect_silhouettes_of_rays(const std::vector<RayInstance>& instances) {
  const RayScene scene(kPinhole, instances);
  const RayImage image = scene.trace({.depth = true});
  for (std::size_t i = 0; i < instances.size(); ++i) {
    SCOPED_TRACE(i);
    expect_every_pixel(scene.silhouette(i, image), instances[i]);
  }
}

TEST(Silhouette, IsTheInstanceAloneWhateverHidesIt) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    expect_silhouettes_of_rays(cubes_anywhere(12, seed));
  }
}

TEST(Silhouette, OfAClosedMeshIsThatOfItsRays) {
  for (const auto& [around, across] : {std::pair(5U, 3U), {24U, 12U}, {90U, 60U}}) {
    SCOPED_TRACE(around);
    const auto instances = anywhere(bumpy_ring(around, across, true), 20, around);
    ASSERT_FALSE(instances[0].mesh->edges().empty());
    expect_silhouettes_of_rays(instances);
  }
}

TEST(Silhouette, OfAnOpenMeshIsThatOfItsRays) {
  const auto instances = anywhere(bumpy_ring(24, 12, false), 12, 5);
  ASSERT_TRUE(instances[0].mesh->edges().empty());
  expect_silhouettes_of_rays(instances);
}

TEST(Silhouette, IsTheSameWhetherDepthIsKnownOrNot) {
  // More than there are bits in a ray's mask, most of them over each other.
  const std::vector<RayInstance> instances = cubes_anywhere(150, 7);
  const RayScene scene(kPinhole, instances);
  const RayImage with_depth = scene.trace({.depth = true});
  const RayImage without = scene.trace({});
  ASSERT_EQ(with_depth.instance, without.instance);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const Silhouette a = scene.silhouette(i, with_depth);
    const Silhouette b = scene.silhouette(i, without);
    ASSERT_EQ(a.box, b.box) << i;
    ASSERT_EQ(a.mask, b.mask) << i;
    ASSERT_EQ(a.area_px, b.area_px) << i;
    ASSERT_EQ(a.in_image_px, b.in_image_px) << i;
    ASSERT_EQ(a.complete, b.complete) << i;
  }
}

TEST(ProjectedBox, HoldsEveryPixelThatHits) {
  for (const RayInstance& instance : cubes_anywhere(60, 3)) {
    const ProjectedBox box(instance.mesh->box(), instance.camera_from_object, kPinhole);
    const RayScene alone(kPinhole, {instance});
    const RayImage image = alone.trace({.depth = true});
    for (int y = 0; y < kPinhole.height; ++y) {
      const auto [begin, end] = box.columns_met(y);
      std::vector<std::uint8_t> met(static_cast<std::size_t>(kPinhole.width));
      box.find_met_before(y, 0, kPinhole.width, &image.depth[image.index(0, y)], met.data());
      for (int x = 0; x < kPinhole.width; ++x) {
        if (image.instance[image.index(x, y)] < 0) continue;
        ASSERT_TRUE(box.rect().contains(x, y) && begin <= x && x < end) << x << " " << y;
        ASSERT_EQ(met[static_cast<std::size_t>(x)], 1) << x << " " << y;
      }
    }
  }
}

TEST(ProjectedBox, EndsBeforeWhatStandsBehindIt) {
  const std::vector<RayInstance> cube = cubes_anywhere(1, 1);
  const Eigen::Affine3d ahead(Eigen::Translation3d(0, 0, -4));
  const ProjectedBox box(cube[0].mesh->box(), ahead, kPinhole);  // from 3 m to 5 m
  const std::vector<float> depths = {2.0F, 4.999F, 5.001F, kNoDepth};
  std::vector<std::uint8_t> met(4);
  box.find_met_before(18, 20, 4, depths.data(), met.data());
  EXPECT_EQ(met, (std::vector<std::uint8_t>{1, 1, 0, 0}));
}

TEST(ProjectedBox, LeavesOutTheCornersOfItsRectangle) {
  const std::vector<RayInstance> cube = cubes_anywhere(1, 1);
  const Eigen::Affine3d turned =
      Eigen::Translation3d(0, 0, -6) * Eigen::AngleAxisd(0.785, Eigen::Vector3d::UnitZ());
  const ProjectedBox box(cube[0].mesh->box(), turned, kPinhole);
  const auto [begin, end] = box.columns_met(box.rect().y + 2);
  EXPECT_LT(end - begin, box.rect().width / 2);
  EXPECT_GT(end - begin, 0);
}

TEST(ProjectedBox, ShowsNothingOfWhatIsBehindTheCamera) {
  const std::vector<RayInstance> cube = cubes_anywhere(1, 1);
  const Eigen::Affine3d behind(Eigen::Translation3d(0, 0, 4));
  EXPECT_TRUE(ProjectedBox(cube[0].mesh->box(), behind, kPinhole).rect().empty());
  const Eigen::Affine3d around = Eigen::Affine3d::Identity();
  const ProjectedBox box(cube[0].mesh->box(), around, kPinhole);
  EXPECT_TRUE(box.reaches_behind());
  EXPECT_EQ(box.rect(), enlarged_canvas(kPinhole));
}

}  // namespace
}  // namespace seedframe
