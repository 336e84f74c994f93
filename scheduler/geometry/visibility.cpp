#include "geometry/visibility.h"

#include <algorithm>
#include <cmath>

#include <embree3/rtcore.h>

namespace seedframe {
namespace {

/// One device for the process: its threads are not used, for scenes are built by their callers.
RTCDevice device() {
  static const RTCDevice shared = rtcNewDevice("threads=1,set_affinity=0");
  return shared;
}

template <class T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  return static_cast<T*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count));
}

RTCScene new_scene() {
  const RTCScene scene = rtcNewScene(device());
  // Without ROBUST, rays slip through between neighbouring triangles.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

struct PixelRange {
  int begin_x = 0, end_x = 0, begin_y = 0, end_y = 0;
};

}  // namespace

struct RayMesh::Tree {
  RTCScene scene = new_scene();
  ~Tree() { rtcReleaseScene(scene); }
};

RayMesh::RayMesh(const Mesh& mesh) : tree_(std::make_unique<Tree>()) {
  const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  using Point = std::array<float, 3>;
  using Triangle = std::array<std::uint32_t, 3>;
  Point* points =
      new_buffer<Point>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, mesh.positions.size());
  std::copy(mesh.positions.begin(), mesh.positions.end(), points);
  Triangle* triangles = new_buffer<Triangle>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                                             mesh.triangles.size());
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tree_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(tree_->scene);
}

RayMesh::~RayMesh() = default;

struct VisibilityScene::Scene {
  RTCScene all = new_scene();   ///< every seen instance, by its index
  std::vector<RTCScene> alone;  ///< each by itself, made when asked for
  ~Scene() {
    rtcReleaseScene(all);
    for (const RTCScene scene : alone) rtcReleaseScene(scene);
  }

  static void attach(RTCScene scene, const RayInstance& instance, unsigned id) {
    const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, instance.mesh->tree().scene);
    std::array<float, 12> columns{};
    std::size_t next = 0;
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 3; ++row) {
        columns[next++] = static_cast<float>(instance.camera_from_object(row, column));
      }
    }
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  static int hit(RTCScene scene, const PixelCamera& camera, int x, int y) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit ray{};
    // z of the direction is -1, so the ray's parameter is the depth, and the clips are its ends.
    ray.ray.dir_x = static_cast<float>((x - camera.center_px[0]) / camera.focal_px[0]);
    ray.ray.dir_y = static_cast<float>((camera.center_px[1] - y) / camera.focal_px[1]);
    ray.ray.dir_z = -1.0f;
    ray.ray.tnear = static_cast<float>(camera.clip_start_m);
    ray.ray.tfar = static_cast<float>(camera.clip_end_m);
    ray.ray.mask = 0xffffffffu;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &ray);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1 : static_cast<int>(ray.hit.instID[0]);
  }
};

VisibilityScene::VisibilityScene(const PixelCamera& camera, std::vector<RayInstance> instances)
    : camera_(camera), instances_(std::move(instances)), scene_(std::make_unique<Scene>()) {
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    if (instances_[i].seen) Scene::attach(scene_->all, instances_[i], static_cast<unsigned>(i));
  }
  rtcCommitScene(scene_->all);
}

VisibilityScene::~VisibilityScene() = default;

int VisibilityScene::first_hit(int x, int y) const {
  return Scene::hit(scene_->all, camera_, x, y);
}

namespace {

/// The pixels onto which a box may project, no farther out than one image beyond the edges.
PixelRange projected_range(const BoundingBox& box, const Eigen::Affine3d& camera_from_object,
                           const PixelCamera& camera) {
  const PixelRange canvas{-camera.width, 2 * camera.width, -camera.height, 2 * camera.height};
  std::array<double, 2> low = {1e300, 1e300};
  std::array<double, 2> high = {-1e300, -1e300};
  int behind = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d point((corner & 1) != 0 ? box.high.x() : box.low.x(),
                                (corner & 2) != 0 ? box.high.y() : box.low.y(),
                                (corner & 4) != 0 ? box.high.z() : box.low.z());
    const Eigen::Vector3d seen = camera_from_object * point;
    if (-seen.z() <= camera.clip_start_m) {
      ++behind;
      continue;
    }
    const double x = camera.center_px[0] + camera.focal_px[0] * seen.x() / -seen.z();
    const double y = camera.center_px[1] - camera.focal_px[1] * seen.y() / -seen.z();
    low = {std::min(low[0], x), std::min(low[1], y)};
    high = {std::max(high[0], x), std::max(high[1], y)};
  }
  if (behind == 8) return {};
  if (behind > 0) return canvas;  // it reaches past the camera: anywhere
  const auto clamped = [](double value, int least, int most) {
    return static_cast<int>(
        std::clamp(value, static_cast<double>(least), static_cast<double>(most)));
  };
  return {clamped(std::floor(low[0]), canvas.begin_x, canvas.end_x),
          clamped(std::ceil(high[0]) + 1, canvas.begin_x, canvas.end_x),
          clamped(std::floor(low[1]), canvas.begin_y, canvas.end_y),
          clamped(std::ceil(high[1]) + 1, canvas.begin_y, canvas.end_y)};
}

}  // namespace

PixelCounts VisibilityScene::count(std::size_t index, std::size_t most_rays) const {
  const RayInstance& instance = instances_[index];
  const PixelRange range = projected_range(instance.box, instance.camera_from_object, camera_);
  const double area = static_cast<double>(range.end_x - range.begin_x) *
                      static_cast<double>(range.end_y - range.begin_y);
  PixelCounts counts;
  if (area <= 0.0 || !instance.seen) return counts;
  const RTCScene alone = new_scene();
  scene_->alone.push_back(alone);
  Scene::attach(alone, instance, 0);
  rtcCommitScene(alone);
  const int step =
      std::max(1, static_cast<int>(std::ceil(std::sqrt(area / static_cast<double>(most_rays)))));
  const double weight = static_cast<double>(step) * step;
  for (int y = range.begin_y + (step - 1) / 2; y < range.end_y; y += step) {
    for (int x = range.begin_x + (step - 1) / 2; x < range.end_x; x += step) {
      if (Scene::hit(alone, camera_, x, y) < 0) continue;
      counts.whole += weight;
      if (x < 0 || x >= camera_.width || y < 0 || y >= camera_.height) continue;
      counts.in_image += weight;
      if (first_hit(x, y) == static_cast<int>(index)) counts.visible += weight;
    }
  }
  return counts;
}

}  // namespace seedframe
