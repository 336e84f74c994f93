#include "rays/ray_scene.h"

#include <algorithm>
#include <cmath>

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "rays/embree_device.h"
#include "rays/ray_packet.h"

namespace seedframe {
namespace {

/// Columns [begin_x, end_x) and rows [begin_y, end_y).
PixelRect rect_of(int begin_x, int end_x, int begin_y, int end_y) {
  return {begin_x, begin_y, end_x - begin_x, end_y - begin_y};
}

/// The pixels of the canvas onto which a box may project.
PixelRect projected_rect(const BoundingBox& box, const Eigen::Affine3d& camera_from_object,
                         const PixelCamera& camera) {
  const PixelRect canvas = enlarged_canvas(camera);
  std::array<double, 2> low = {1e300, 1e300};
  std::array<double, 2> high = {-1e300, -1e300};
  int behind = 0;
  for (const Eigen::Vector3d& point : box.corners()) {
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
  const auto clamped = [](double value, int least, int size) {
    return static_cast<int>(
        std::clamp(value, static_cast<double>(least), static_cast<double>(least + size)));
  };
  // A pixel more on each side for what rounds.
  return rect_of(clamped(std::floor(low[0]) - 1, canvas.x, canvas.width),
                 clamped(std::ceil(high[0]) + 2, canvas.x, canvas.width),
                 clamped(std::floor(low[1]) - 1, canvas.y, canvas.height),
                 clamped(std::ceil(high[1]) + 2, canvas.y, canvas.height));
}

/// Shading normals of hits in the camera's frame.
class NormalShader {
 public:
  explicit NormalShader(const std::vector<RayInstance>& instances) {
    instances_.reserve(instances.size());
    for (const RayInstance& instance : instances) {
      instances_.push_back(
          {instance.mesh->normals().data(),
           instance.camera_from_object.linear().inverse().transpose().cast<float>()});
    }
  }

  std::array<float, 3> normal(const RayPacket& packet, std::size_t lane) const {
    const auto& [normals, camera_from_normal] =
        instances_[static_cast<std::size_t>(packet.hit(lane))];
    const auto* corner = normals + std::size_t{3} * packet.rays.hit.primID[lane];
    const float u = packet.rays.hit.u[lane];
    const float v = packet.rays.hit.v[lane];
    const float w = 1.0f - u - v;
    const Eigen::Vector3f smooth(w * corner[0][0] + u * corner[1][0] + v * corner[2][0],
                                 w * corner[0][1] + u * corner[1][1] + v * corner[2][1],
                                 w * corner[0][2] + u * corner[1][2] + v * corner[2][2]);
    // Embree's normal is the triangle's, in object space.
    const Eigen::Vector3f flat(packet.rays.hit.Ng_x[lane], packet.rays.hit.Ng_y[lane],
                               packet.rays.hit.Ng_z[lane]);
    const Eigen::Vector3f ray(packet.rays.ray.dir_x[lane], packet.rays.ray.dir_y[lane], -1.0f);
    const bool from_behind = (camera_from_normal * flat).dot(ray) > 0.0f;
    const Eigen::Vector3f seen = camera_from_normal * smooth;
    const float length = seen.norm();
    const float scale = length == 0.0f ? 0.0f : (from_behind ? -1.0f : 1.0f) / length;
    return {scale * seen.x(), scale * seen.y(), scale * seen.z()};
  }

 private:
  struct Instance {
    const std::array<float, 3>* normals;  ///< three per triangle, object space
    Eigen::Matrix3f camera_from_normal;
  };
  std::vector<Instance> instances_;
};

/// Runs `body` for 0 … count − 1, in no order.
template <class Body>
void for_each_index(int count, int threads, const Body& body) {
  if (threads <= 1) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  // More than there are cores would only make TBB warn.
  tbb::task_arena arena(std::min(threads, tbb::info::default_concurrency()));
  arena.execute([&] { tbb::parallel_for(0, count, body); });
}

}  // namespace

PixelRect enlarged_canvas(const PixelCamera& camera) {
  return {-camera.width, -camera.height, 3 * camera.width, 3 * camera.height};
}

struct RayScene::Scene {
  PixelCamera camera;
  std::vector<RayInstance> instances;
  RTCScene all = new_embree_scene();    ///< every seen instance, by its index
  mutable std::vector<RTCScene> alone;  ///< each by itself, made when asked for

  Scene(const PixelCamera& pixel_camera, std::vector<RayInstance> seen_and_unseen)
      : camera(pixel_camera),
        instances(std::move(seen_and_unseen)),
        alone(instances.size(), nullptr) {
    for (std::size_t i = 0; i < instances.size(); ++i) {
      if (instances[i].seen) attach(all, instances[i], static_cast<unsigned>(i));
    }
    commit_scene(all);
  }
  ~Scene() {
    rtcReleaseScene(all);
    for (const RTCScene scene : alone) {
      if (scene != nullptr) rtcReleaseScene(scene);
    }
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  RTCScene only(std::size_t index) const {
    RTCScene& scene = alone[index];
    if (scene == nullptr) {
      scene = new_embree_scene();
      attach(scene, instances[index], static_cast<unsigned>(index));
      commit_scene(scene);
    }
    return scene;
  }

  static void attach(RTCScene scene, const RayInstance& instance, unsigned id) {
    const RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_INSTANCE);
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
};

RayScene::RayScene(const PixelCamera& camera, std::vector<RayInstance> instances)
    : scene_(std::make_unique<Scene>(camera, std::move(instances))) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

const PixelCamera& RayScene::camera() const { return scene_->camera; }
const std::vector<RayInstance>& RayScene::instances() const { return scene_->instances; }

int RayScene::first_hit(int x, int y, const std::array<double, 2>& offset_px) const {
  PixelCamera camera = scene_->camera;
  camera.center_px[0] -= offset_px[0];
  camera.center_px[1] -= offset_px[1];
  RayPacket packet;
  packet.aim(camera, x, y, 1, x + 1, y + 1);
  packet.find_first_hits(scene_->all);
  return packet.hit(0);
}

bool RayScene::hides(const Eigen::Vector3d& point, double tolerance_m, int transparent) const {
  const double distance = point.norm();
  RTCRayHit ray{};
  ray.ray.dir_x = static_cast<float>(point.x());
  ray.ray.dir_y = static_cast<float>(point.y());
  ray.ray.dir_z = static_cast<float>(point.z());
  ray.ray.mask = 0xffffffffu;
  // The ray's parameter is the share of the way to the point.
  const auto nearest = static_cast<float>(scene_->camera.clip_start_m / -point.z());
  const auto farthest = static_cast<float>(1.0 - tolerance_m / distance);
  constexpr float kStep = 1e-6F;  // past a surface that was met
  for (float from = nearest; from < farthest;
       from = ray.ray.tfar * (1.0F + kStep) + kStep * nearest) {
    ray.ray.tnear = from;
    ray.ray.tfar = farthest;
    ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_->all, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    if (static_cast<int>(ray.hit.instID[0]) != transparent) return true;
  }
  return false;
}

RayImage RayScene::trace(const TraceOptions& options) const {
  const PixelCamera& camera = scene_->camera;
  RayImage image{camera.width, camera.height, {}, {}, {}};
  const std::size_t pixels = image.index(0, camera.height);
  image.instance.resize(pixels);
  if (options.depth) image.depth.resize(pixels);
  if (options.normals) image.normals.resize(pixels);
  const NormalShader shader(options.normals ? scene_->instances : std::vector<RayInstance>{});
  constexpr int kSide = RayPacket::kSide;
  for_each_index((camera.height + kSide - 1) / kSide, options.threads, [&](int strip) {
    RayPacket packet;
    for (int x = 0; x < camera.width; x += kSide) {
      packet.aim(camera, x, kSide * strip, 1, camera.width, camera.height);
      packet.find_first_hits(scene_->all);
      for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
        if (packet.wanted[lane] == 0) continue;
        const std::size_t pixel = image.index(x + static_cast<int>(lane % kSide),
                                              kSide * strip + static_cast<int>(lane / kSide));
        const int hit = packet.hit(lane);
        image.instance[pixel] = hit;
        if (options.depth) image.depth[pixel] = hit < 0 ? kNoDepth : packet.rays.ray.tfar[lane];
        if (options.normals && hit >= 0) image.normals[pixel] = shader.normal(packet, lane);
      }
    }
  });
  return image;
}

namespace {

/// Cuts a mask down to the pixels that are set.
Silhouette tight_silhouette(const PixelRect& rect, const std::vector<std::uint8_t>& mask,
                            const PixelCamera& camera) {
  Silhouette silhouette;
  int low_x = rect.width, high_x = -1, low_y = rect.height, high_y = -1;
  const auto at = [&](int x, int y) {
    return mask[static_cast<std::size_t>(y) * static_cast<std::size_t>(rect.width) +
                static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < rect.height; ++y) {
    for (int x = 0; x < rect.width; ++x) {
      if (at(x, y) == 0) continue;
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = y;
      ++silhouette.area_px;
      const int column = rect.x + x;
      const int row = rect.y + y;
      if (column >= 0 && column < camera.width && row >= 0 && row < camera.height) {
        ++silhouette.in_image_px;
      }
    }
  }
  if (high_x < 0) return silhouette;
  silhouette.box = {rect.x + low_x, rect.y + low_y, high_x - low_x + 1, high_y - low_y + 1};
  silhouette.mask.reserve(static_cast<std::size_t>(silhouette.box.area()));
  for (int y = low_y; y <= high_y; ++y) {
    for (int x = low_x; x <= high_x; ++x) silhouette.mask.push_back(at(x, y));
  }
  const PixelRect canvas = enlarged_canvas(camera);
  const PixelRect& box = silhouette.box;
  silhouette.complete = box.x > canvas.x && box.y > canvas.y && box.end_x() < canvas.end_x() &&
                        box.end_y() < canvas.end_y();
  return silhouette;
}

}  // namespace

Silhouette RayScene::silhouette(std::size_t index, const RayImage& image,
                                const PixelRect& within) const {
  const PixelCamera& camera = scene_->camera;
  const RayInstance& instance = scene_->instances[index];
  if (!instance.seen) return {};
  const PixelRect rect =
      union_of(within, projected_rect(instance.mesh->box(), instance.camera_from_object, camera));
  if (rect.empty()) return {};
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(rect.area()), 0);
  const RTCScene alone = scene_->only(index);
  constexpr int kSide = RayPacket::kSide;
  const int right = rect.end_x();
  const int bottom = rect.end_y();
  RayPacket packet;
  for (int y = rect.y; y < bottom; y += kSide) {
    for (int x = rect.x; x < right; x += kSide) {
      packet.aim(camera, x, y, 1, right, bottom);
      std::array<bool, RayPacket::kLanes> known{};
      bool any_unknown = false;
      for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
        const int column = x + static_cast<int>(lane % kSide);
        const int row = y + static_cast<int>(lane / kSide);
        known[lane] = column >= 0 && column < camera.width && row >= 0 && row < camera.height &&
                      packet.wanted[lane] != 0 &&
                      image.instance[image.index(column, row)] == static_cast<int>(index);
        any_unknown = any_unknown || (packet.wanted[lane] != 0 && !known[lane]);
      }
      if (any_unknown) packet.find_any_hits(alone);
      for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
        if (packet.wanted[lane] == 0 || !(known[lane] || packet.hits(lane))) continue;
        const int column = x + static_cast<int>(lane % kSide) - rect.x;
        const int row = y + static_cast<int>(lane / kSide) - rect.y;
        mask[static_cast<std::size_t>(row) * static_cast<std::size_t>(rect.width) +
             static_cast<std::size_t>(column)] = 1;
      }
    }
  }
  return tight_silhouette(rect, mask, camera);
}

PixelCounts RayScene::count(std::size_t index, std::size_t most_rays) const {
  const PixelCamera& camera = scene_->camera;
  const RayInstance& instance = scene_->instances[index];
  PixelCounts counts;
  if (!instance.seen) return counts;
  const PixelRect rect = projected_rect(instance.mesh->box(), instance.camera_from_object, camera);
  if (rect.empty()) return counts;
  const RTCScene alone = scene_->only(index);
  const int step =
      std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(rect.area()) /
                                                       static_cast<double>(most_rays)))));
  const double weight = static_cast<double>(step) * step;
  const int right = rect.end_x();
  const int bottom = rect.end_y();
  const int stride = RayPacket::kSide * step;
  RayPacket own, first;
  for (int y = rect.y + (step - 1) / 2; y < bottom; y += stride) {
    for (int x = rect.x + (step - 1) / 2; x < right; x += stride) {
      own.aim(camera, x, y, step, right, bottom);
      own.find_any_hits(alone);
      first.aim(camera, x, y, step, right, bottom);
      bool any_inside = false;
      for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
        first.wanted[lane] = 0;
        if (!own.hits(lane)) continue;
        counts.whole += weight;
        const int column = x + static_cast<int>(lane % RayPacket::kSide) * step;
        const int row = y + static_cast<int>(lane / RayPacket::kSide) * step;
        if (column < 0 || column >= camera.width || row < 0 || row >= camera.height) continue;
        counts.in_image += weight;
        first.wanted[lane] = -1;
        any_inside = true;
      }
      if (!any_inside) continue;
      first.find_first_hits(scene_->all);
      for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
        if (first.hit(lane) == static_cast<int>(index)) counts.visible += weight;
      }
    }
  }
  return counts;
}

}  // namespace seedframe
