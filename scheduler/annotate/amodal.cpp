#include "annotate/amodal.h"

#include <Eigen/SVD>

#include "annotate/rle.h"

namespace seedframe {
namespace {

std::array<std::optional<std::array<double, 2>>, 8> projected_corners(
    const FrameSpec& spec, const Affine& camera_from_object, const BoundingBox& box) {
  std::array<std::optional<std::array<double, 2>>, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? box.high.x() : box.low.x(),
                                 (i & 2) != 0 ? box.high.y() : box.low.y(),
                                 (i & 4) != 0 ? box.high.z() : box.low.z());
    const Eigen::Vector3d seen = camera_from_object * corner;
    const double depth = -seen.z();
    if (depth <= 0.0) continue;
    const CameraSpec& camera = spec.camera;
    corners[i] = {camera.center_px[0] + camera.focal_px[0] * seen.x() / depth,
                  camera.center_px[1] - camera.focal_px[1] * seen.y() / depth};
  }
  return corners;
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
    labels.instances[next++].amodal = std::move(amodal);
  }
}

}  // namespace seedframe
