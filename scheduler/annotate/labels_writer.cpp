// labels.json out (docs/formats/labels.md).
#include "annotate/labels.h"
#include "base/canonical_writer.h"

namespace seedframe {
namespace {

void write_box(CanonicalWriter& out, const PixelRect& box) {
  out.numbers("box", std::array{box.x, box.y, box.width, box.height});
}

void write_pose(CanonicalWriter& out, const Pose& pose) {
  out.matrix("rotation", pose.rotation);
  out.matrix("scale", pose.scale);
  out.matrix("translation_m", pose.translation_m);
}

void write_amodal(CanonicalWriter& out, const AmodalLabel& amodal) {
  out.field("area_px", static_cast<double>(amodal.area_px));
  write_box(out, amodal.box);
  out.list("box_corners_px", amodal.box_corners_px, [&](const auto& corner) {
    if (corner) {
      out.numbers(*corner);
    } else {
      out.null();
    }
  });
  out.field("complete", amodal.complete);
  out.field("in_image_px", static_cast<double>(amodal.in_image_px));
  const BoundingBox& box = amodal.object_box;
  out.list("object_box_m", std::array{&box.low, &box.high},
           [&](const Eigen::Vector3d* corner) { out.matrix(*corner); });
  out.object("pose", amodal.pose, write_pose);
  out.field("rle", amodal.rle);
}

void write_keypoint_label(CanonicalWriter& out, const KeypointLabel& keypoint) {
  out.field("name", keypoint.name);
  out.numbers("px", keypoint.px);
  out.field("visibility", static_cast<double>(keypoint.visibility));
}

void write_instance_label(CanonicalWriter& out, const InstanceLabel& label) {
  if (label.amodal) out.object("amodal", *label.amodal, write_amodal);
  out.field("area_px", static_cast<double>(label.area_px));
  out.field("asset", label.asset);
  write_box(out, label.box);
  out.field("category", static_cast<double>(label.category));
  out.field("id", static_cast<double>(label.id));
  if (!label.keypoints.empty()) out.objects("keypoints", label.keypoints, write_keypoint_label);
  out.field("name", label.name);
  if (label.amodal) {
    out.field("truncation", label.truncation());
    out.field("visible_fraction", label.visible_fraction());
  }
}

void write_frame_labels(CanonicalWriter& out, const FrameLabels& labels) {
  out.object("camera", labels, [](CanonicalWriter& camera, const FrameLabels& of) {
    camera.numbers("center_px", of.center_px);
    camera.numbers("focal_px", of.focal_px);
  });
  out.list("categories", labels.categories, [&](const std::string& name) { out.text(name); });
  out.field("height", static_cast<double>(labels.height));
  out.objects("instances", labels.instances, write_instance_label);
  if (labels.target != 0) out.field("target", static_cast<double>(labels.target));
  out.field("twin_exact", labels.twin_exact);
  out.field("version", static_cast<double>(kLabelsVersion));
  out.field("width", static_cast<double>(labels.width));
}

}  // namespace

std::string canonical_text(const FrameLabels& labels) {
  constexpr std::size_t kBytesPerInstance = 1500;
  std::string text;
  text.reserve((1 + labels.instances.size()) * kBytesPerInstance);
  CanonicalWriter(text).object(labels, write_frame_labels);
  return text;
}

Json to_json(const FrameLabels& labels) { return Json::parse(canonical_text(labels)); }

}  // namespace seedframe
