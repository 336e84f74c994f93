#include "rays/scene_trees.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace seedframe {
namespace {

constexpr unsigned kEveryRay = 0xffffffffU;
constexpr unsigned kSharedBit = 1U << 31U;

bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.x < b.end_x() && b.x < a.end_x() && a.y < b.end_y() && b.y < a.end_y();
}

/// Where rays may begin. Float32 has as many bits for what is far away as for what is near: if all
/// is far away and close together, nearly all of them tell how far away it is. So there rays begin
/// just before the first surface. Elsewhere at the camera, where masks are what they have always
/// been.
double start_of_rays(const std::vector<RayInstance>& instances) {
  constexpr double kFar = 16.0;  // as a multiple of the depth that the scene fills
  constexpr double kBefore = 1e-3;
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  for (const RayInstance& instance : instances) {
    for (const Eigen::Vector3d& corner : instance.mesh->box().corners()) {
      const double depth = -(instance.camera_from_object * corner).z();
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  }
  const bool far = nearest > kFar * (farthest - nearest) && std::isfinite(nearest);
  return far ? (1.0 - kBefore) * nearest : 0.0;
}

/// Rays of other masks pass through.
void attach(RTCScene scene, const RayInstance& instance, std::size_t index, unsigned mask,
            double ray_start_m) {
  const RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, instance.mesh->tree().scene);
  std::array<float, 12> columns{};
  std::size_t next = 0;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) {
      const double shift = row == 2 && column == 3 ? ray_start_m : 0.0;
      columns[next++] = static_cast<float>(instance.camera_from_object(row, column) + shift);
    }
  }
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(index));
  rtcReleaseGeometry(geometry);
}

}  // namespace

RayScene::Scene::Scene(const PixelCamera& pixel_camera, std::vector<RayInstance> seen_and_unseen)
    : camera(pixel_camera),
      pixels(pixel_camera),
      instances(std::move(seen_and_unseen)),
      alone(instances.size(), nullptr) {
  camera.ray_start_m = start_of_rays(instances);
  boxes.reserve(instances.size());
  for (const RayInstance& instance : instances) {
    boxes.emplace_back(instance.mesh->box(), instance.camera_from_object, camera);
  }
  choose_masks();
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (instances[i].seen) attach(all, instances[i], i, masks[i], camera.ray_start_m);
  }
  commit_scene(all);
}

RayScene::Scene::~Scene() {
  rtcReleaseScene(all);
  if (shades != nullptr) rtcReleaseScene(shades);
  for (const RTCScene scene : alone) {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
}

void RayScene::Scene::choose_masks() {
  masks.assign(instances.size(), 0);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (!instances[i].seen) continue;
    unsigned taken = kSharedBit;
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(boxes[i].rect(), boxes[j].rect())) taken |= masks[j];
    }
    const unsigned left = ~taken;
    masks[i] = left == 0 ? kSharedBit : left & (~left + 1);  // the lowest bit
  }
}

bool RayScene::Scene::has_own_mask(std::size_t index) const { return masks[index] != kSharedBit; }

RTCScene RayScene::Scene::only(std::size_t index) const {
  RTCScene& scene = alone[index];
  if (scene == nullptr) {
    scene = new_embree_scene();
    attach(scene, instances[index], index, kEveryRay, camera.ray_start_m);
    commit_scene(scene);
  }
  return scene;
}

RTCScene RayScene::Scene::throwing_shadows() const {
  const bool same_as_seen =
      std::all_of(instances.begin(), instances.end(),
                  [](const RayInstance& each) { return each.seen == each.throws_shadow; });
  if (same_as_seen) return all;
  if (shades == nullptr) {
    shades = new_embree_scene();
    for (std::size_t i = 0; i < instances.size(); ++i) {
      if (instances[i].throws_shadow) {
        attach(shades, instances[i], i, kEveryRay, camera.ray_start_m);
      }
    }
    commit_scene(shades);
  }
  return shades;
}

}  // namespace seedframe
