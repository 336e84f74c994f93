// The labels of one frame, derived from the instance-id image and the frame spec.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"
#include "base/pixel_rect.h"
#include "image/image.h"
#include "rays/ray_scene.h"
#include "spec/frame_spec.h"

namespace seedframe {

inline constexpr int kLabelsVersion = 3;

/// An id image has 16 bits.
constexpr int kLargestImageId = std::numeric_limits<std::uint16_t>::max();

/// Where an instance is in the camera's frame (x right, y up, z towards the viewer):
/// point = rotation · diag(scale) · point of the object + translation. A shear, which only parents
/// of unequal scales make, is not in it.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

/// What the twin knows of an instance, whatever stands before it.
struct AmodalLabel {
  std::int64_t area_px = 0;      ///< of the whole silhouette, also outside the image
  std::int64_t in_image_px = 0;  ///< of it, inside the image
  PixelRect box;                 ///< tight; may reach beyond the image; all 0 when empty
  bool complete = true;          ///< false: it reaches the edge of the enlarged canvas
  std::string rle;               ///< rle_string of the mask over `box` alone; empty when that is
  Pose pose;
  BoundingBox object_box;  ///< of the mesh, in object space, metres
  /// Corners of object_box in pixels; x alternates fastest between low and high, then y, then z.
  /// 0, 0 is the corner of the first pixel. None for one that is not in front of the camera.
  std::array<std::optional<std::array<double, 2>>, 8> box_corners_px;
};

/// COCO's three degrees.
enum class Visibility {
  kOutside = 0,  ///< of the image, or behind the camera
  kHidden = 1,   ///< by something nearer
  kVisible = 2,
};

struct KeypointLabel {
  std::string name;
  std::array<double, 2> px{};  ///< x, y; 0 is the edge of the first pixel; 0, 0 when outside
  Visibility visibility = Visibility::kOutside;
};

struct InstanceLabel {
  int id = 0;        ///< value in instances.png
  int category = 0;  ///< 1-based; 0: a distractor
  std::string name;  ///< "<object>/<copy>"
  std::string asset;
  std::int64_t area_px = 0;           ///< visible pixels; 0: wholly hidden or out of view
  PixelRect box;                      ///< tight, of the visible pixels; all 0 when there are none
  std::optional<AmodalLabel> amodal;  ///< none: the frame has no twin
  std::vector<KeypointLabel> keypoints;

  /// Visible pixels as a share of the whole silhouette's (BOP's visib_fract); 0 when that is empty.
  double visible_fraction() const;
  /// Share of the silhouette that is outside the image; 0 when that is empty.
  double truncation() const;
};

struct FrameLabels {
  int width = 0;
  int height = 0;
  std::vector<std::string> categories;  ///< category k is categories[k - 1]
  std::array<double, 2> focal_px{};     ///< of the pinhole
  std::array<double, 2> center_px{};    ///< principal point; pixel centres are whole numbers
  bool twin_exact = true;               ///< false: silhouettes do not show holes that textures cut
  int target = 0;                       ///< id of the instance that the image is cut to; 0: none
  /// Every instance of the spec with an id, in the spec's order.
  std::vector<InstanceLabel> instances;
};

/// What the image shows, without amodal labels and keypoints. An id in the image that the spec does
/// not have is a kRender error.
Result<FrameLabels> make_labels(const FrameSpec& spec, const std::vector<std::string>& categories,
                                const Image<std::uint16_t>& instance_ids);

/// For each pixel the category of its instance, 0 for background and distractors.
Image<std::uint8_t> semantic_image(const FrameSpec& spec, const Image<std::uint16_t>& instance_ids);

/// Canonical JSON.
std::string canonical_text(const FrameLabels& labels);
Json to_json(const FrameLabels& labels);
Result<FrameLabels> labels_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
