#include "scene/level_choice.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/asset_levels.h"

namespace seedframe {
namespace {

/// Pixels that a displacement of one metre can move a point of the box by, at most. A displacement
/// along the ray's slope s moves it by focal · √(1 + s²) / depth; the box's corners bound depth and
/// slope. Infinite when the box reaches the near plane.
double most_pixels_per_metre(const BoundingBox& box, const Affine& camera_from_object,
                             const CameraSpec& camera) {
  double least_depth = std::numeric_limits<double>::infinity();
  double most_aside = 0.0;
  for (const Eigen::Vector3d& point : box.corners()) {
    const Eigen::Vector3d seen = camera_from_object * point;
    least_depth = std::min(least_depth, -seen.z());
    most_aside = std::max(most_aside, seen.head<2>().norm());
  }
  if (least_depth <= camera.clip_start_m) return std::numeric_limits<double>::infinity();
  const double focal = std::max(camera.focal_px[0], camera.focal_px[1]);
  const double slope = most_aside / least_depth;
  return focal * std::sqrt(1.0 + slope * slope) / least_depth;
}

/// The most by which the map stretches a vector: its largest singular value.
double stretch(const Affine& map) { return Eigen::Matrix3d(map.linear()).operatorNorm(); }

}  // namespace

std::size_t level_of_detail(const Asset& asset, const Affine& camera_from_object,
                            const CameraSpec& camera) {
  const double pixels_per_metre =
      stretch(camera_from_object) * most_pixels_per_metre(asset.box, camera_from_object, camera);
  std::size_t level = 0;
  for (std::size_t k = 1; k < asset.levels.size(); ++k) {
    const double error_m = asset.levels[0].error_m + asset.levels[k].error_m;
    if (error_m * pixels_per_metre <= kPixelShare) level = k;
  }
  return level;
}

}  // namespace seedframe
