#include "annotate/amodal.h"

#include <Eigen/SVD>

#include "annotate/rle.h"

namespace seedframe {
namespace {

/// A surface nearer than the point by less than this share of the object's size is the point's own:
/// keypoints are set by hand, and meshes are quantised.
constexpr double kKeypointTolerance = 1e-3;

/// x, y in pixels, 0 being the edge of the first one; none for what is not in front of the camera.
std::optional<std::array<double, 2>> projected(const CameraSpec& camera,
                                               const Eigen::Vector3d& seen) {
  const double depth = -seen.z();
  if (depth <= 0.0) return std::nullopt;
  constexpr double kHalf = 0.5;  // the camera's whole numbers are the pixels' centres
  return std::array<double, 2>{camera.center_px[0] + camera.focal_px[0] * seen.x() / depth + kHalf,
                               camera.center_px[1] - camera.focal_px[1] * seen.y() / depth + kHalf};
}

std::array<std::optional<std::array<double, 2>>, 8> projected_corners(
    const FrameSpec& spec, const Affine& camera_from_object, const BoundingBox& box) {
  std::array<std::optional<std::array<double, 2>>, 8> corners;
  const auto points = box.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = projected(spec.camera, camera_from_object * points[i]);
  }
  return corners;
}

std::vector<KeypointLabel> keypoint_labels(const FrameSpec& spec, const Twin& twin,
                                           std::size_t index) {
  const InstanceSpec& instance = spec.instances[index];
  const Affine& camera_from_object = instance.camera_from_object;
  const double size = (camera_from_object.linear() * twin.object_box(index).size()).norm();
  std::vector<KeypointLabel> labels;
  labels.reserve(instance.keypoints.size());
  for (const Keypoint& keypoint : instance.keypoints) {
    KeypointLabel& label = labels.emplace_back();
    label.name = keypoint.name;
    const Eigen::Vector3d seen = camera_from_object * keypoint.point_m;
    if (-seen.z() < spec.camera.clip_start_m || -seen.z() > spec.camera.clip_end_m) continue;
    const auto px = projected(spec.camera, seen);
    const bool in_image = px && (*px)[0] >= 0.0 && (*px)[0] < spec.render.width &&
                          (*px)[1] >= 0.0 && (*px)[1] < spec.render.height;
    if (!in_image) continue;
    label.px = *px;
    const int transparent = keypoint.inside ? static_cast<int>(index) : -1;
    const bool hidden = twin.hides(seen, kKeypointTolerance * size, transparent);
    label.visibility = hidden ? Visibility::kHidden : Visibility::kVisible;
  }
  return labels;
}

}  // namespace

Pose pose_of(const Affine& camera_from_object) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(camera_from_object.linear(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  Pose pose;
  pose.rotation = u * svd.matrixV().transpose();
  if (pose.rotation.determinant() <
      0.0) {  // mirrored: the least stretched axis counts as turned round
    u.col(2) *= -1.0;
    pose.rotation = u * svd.matrixV().transpose();
  }
  pose.scale = (pose.rotation.transpose() * camera_from_object.linear()).diagonal();
  pose.translation_m = camera_from_object.translation();
  return pose;
}

std::int64_t silhouette_area_in(const AmodalLabel& amodal, const PixelRect& box) {
  const auto rle = rle_from_string(amodal.rle, amodal.box.width, amodal.box.height);
  std::int64_t area = 0;
  if (!rle) return area;
  for_each_stretch(*rle, [&](int column, int first, int end) {
    const int x = amodal.box.x + column;
    if (x < box.x || x >= box.end_x()) return;
    area += std::max(
        0, std::min(amodal.box.y + end, box.end_y()) - std::max(amodal.box.y + first, box.y));
  });
  return area;
}

void add_amodal_labels(FrameLabels& labels, const FrameSpec& spec, const Twin& twin,
                       const Image<std::uint16_t>& instance_ids) {
  const std::vector<Silhouette> silhouettes = twin.silhouettes(instance_ids);
  std::size_t next = 0;
  for (std::size_t i = 0; i < spec.instances.size(); ++i) {
    const InstanceSpec& instance = spec.instances[i];
    if (instance.id == 0) continue;
    const Silhouette& silhouette = silhouettes[i];
    AmodalLabel amodal;
    amodal.area_px = silhouette.area_px;
    amodal.in_image_px = silhouette.in_image_px;
    amodal.box = silhouette.box;
    amodal.complete = silhouette.complete;
    if (!silhouette.box.empty()) {
      amodal.rle =
          rle_string(encode_rle(silhouette.mask, silhouette.box.width, silhouette.box.height));
    }
    amodal.pose = pose_of(instance.camera_from_object);
    amodal.object_box = twin.object_box(i);
    amodal.box_corners_px = projected_corners(spec, instance.camera_from_object, amodal.object_box);
    InstanceLabel& label = labels.instances[next++];
    label.amodal = std::move(amodal);
    label.keypoints = keypoint_labels(spec, twin, i);
  }
}

}  // namespace seedframe
