#include "rays/ray_scene.h"

#include <algorithm>
#include <cmath>

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "rays/hit_point.h"
#include "rays/projected_box.h"
#include "rays/ray_packet.h"
#include "rays/scene_trees.h"

namespace seedframe {
namespace {

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

  std::array<float, 3> normal(const RayPacket& packet, std::size_t lane,
                              const HitPoint& hit) const {
    const auto& [normals, camera_from_normal] =
        instances_[static_cast<std::size_t>(packet.hit(lane))];
    const auto* corner = normals + std::size_t{3} * packet.rays.hit.primID[lane];
    const auto u = static_cast<float>(hit.u);
    const auto v = static_cast<float>(hit.v);
    const float w = 1.0f - u - v;
    const Eigen::Vector3f smooth(w * corner[0][0] + u * corner[1][0] + v * corner[2][0],
                                 w * corner[0][1] + u * corner[1][1] + v * corner[2][1],
                                 w * corner[0][2] + u * corner[1][2] + v * corner[2][2]);
    const Eigen::Vector3f seen = camera_from_normal * smooth;
    const float length = seen.norm();
    const float scale = length == 0.0f ? 0.0f : (hit.from_behind ? -1.0f : 1.0f) / length;
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
  RayPacket packet(camera);
  packet.aim_lane(0, camera.ray_x(x), camera.ray_y(y));
  packet.find_first_hits(scene_->all);
  return packet.hit(0);
}

std::vector<int> RayScene::first_hits(int x, int y) const {
  constexpr double kRounding = 1e-5;
  std::vector<int> met;
  const PixelCamera& camera = scene_->camera;
  RayPacket packet(camera);
  packet.aim_lane(0, camera.ray_x(x), camera.ray_y(y));
  packet.find_first_hits(scene_->all);
  const int first = packet.hit(0);
  if (first < 0) return met;
  const double depth = packet.depth(0);
  for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
    const PixelRect& rect = scene_->boxes[i].rect();
    const bool possible = scene_->instances[i].seen && x >= rect.x && x < rect.end_x() &&
                          y >= rect.y && y < rect.end_y();
    if (static_cast<int>(i) != first) {
      if (!possible) continue;
      packet.find_first_hits(scene_->only(i));
      if (packet.hit(0) < 0 || packet.depth(0) - depth > kRounding * depth) continue;
    }
    met.push_back(static_cast<int>(i));
  }
  return met;
}

bool RayScene::hides(const Eigen::Vector3d& point, double tolerance_m, int transparent) const {
  const double distance = point.norm();
  RTCRayHit ray{};
  ray.ray.org_z = static_cast<float>(scene_->camera.ray_start_m);
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
  RayImage image{camera.width, camera.height, {}, {}, {}, {}};
  const std::size_t pixels = image.index(0, camera.height);
  image.instance.resize(pixels);
  if (options.depth) image.depth.resize(pixels);
  if (options.normals) image.normals.resize(pixels);
  if (options.points) image.points.resize(pixels);
  const bool portable_depth = options.depth && options.portable_depth;
  const bool points_wanted = portable_depth || options.normals || options.points;
  const std::vector<RayInstance> none;
  const HitPoints points(points_wanted ? scene_->instances : none);
  const NormalShader shader(options.normals ? scene_->instances : none);
  constexpr int kRows = RayPacket::kRows;
  constexpr int kColumns = RayPacket::kColumns;
  for_each_index((camera.height + kRows - 1) / kRows, options.threads, [&](int strip) {
    RayPacket packet(camera);
    const int y = kRows * strip;
    for (int x = 0; x < camera.width; x += kColumns) {
      packet.aim(scene_->pixels, x, y, 1, camera.width, camera.height);
      packet.find_first_hits(scene_->all);
      for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
        if (packet.wanted[lane] == 0) continue;
        const std::size_t pixel = image.index(x + static_cast<int>(lane % kColumns),
                                              y + static_cast<int>(lane / kColumns));
        const int hit = packet.hit(lane);
        image.instance[pixel] = hit;
        if (options.depth) {
          image.depth[pixel] = hit < 0 ? kNoDepth : static_cast<float>(packet.depth(lane));
        }
        if (!points_wanted || hit < 0) continue;
        const HitPoint point = points.at(packet, lane);
        if (portable_depth) image.depth[pixel] = static_cast<float>(point.depth);
        if (options.normals) image.normals[pixel] = shader.normal(packet, lane, point);
        if (options.points) {
          image.points[pixel] = {packet.rays.hit.primID[lane], static_cast<float>(point.u),
                                 static_cast<float>(point.v)};
        }
      }
    }
  });
  return image;
}

PixelCounts RayScene::count(std::size_t index, std::size_t most_rays) const {
  const PixelCamera& camera = scene_->camera;
  const RayInstance& instance = scene_->instances[index];
  PixelCounts counts;
  if (!instance.seen) return counts;
  const ProjectedBox box(instance.mesh->box(), instance.camera_from_object, camera);
  const bool anywhere = box.reaches_behind() && !box.rect().empty();
  // Draws depend on where the grid begins, so it stays where it has always been.
  const PixelRect rect = anywhere ? enlarged_canvas(camera) : box.rect();
  if (rect.empty()) return counts;
  const RTCScene alone = scene_->only(index);
  const int step =
      std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(rect.area()) /
                                                       static_cast<double>(most_rays)))));
  const double weight = static_cast<double>(step) * step;
  const int right = rect.end_x();
  const int bottom = rect.end_y();
  constexpr int kColumns = RayPacket::kColumns;
  RayPacket own(camera), first(camera);
  for (int y = rect.y + (step - 1) / 2; y < bottom; y += RayPacket::kRows * step) {
    for (int x = rect.x + (step - 1) / 2; x < right; x += kColumns * step) {
      own.aim(scene_->pixels, x, y, step, right, bottom);
      own.find_any_hits(alone);
      first.aim(scene_->pixels, x, y, step, right, bottom);
      bool any_inside = false;
      for (std::size_t lane = 0; lane < RayPacket::kLanes; ++lane) {
        first.wanted[lane] = 0;
        if (!own.hits(lane)) continue;
        counts.whole += weight;
        const int column = x + static_cast<int>(lane % kColumns) * step;
        const int row = y + static_cast<int>(lane / kColumns) * step;
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
