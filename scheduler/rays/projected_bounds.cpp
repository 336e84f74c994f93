#include "rays/projected_bounds.h"

#include <algorithm>
#include <limits>

#include "rays/projected_box.h"

namespace seedframe {

std::optional<PixelBounds> projected_bounds(const Mesh& mesh,
                                            const Eigen::Affine3d& camera_from_object,
                                            const PixelCamera& camera) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  PixelBounds bounds{kFar, kFar, -kFar, -kFar};
  for (const auto& [x, y, z] : mesh.positions) {
    const Eigen::Vector3d seen = camera_from_object * Eigen::Vector3d(x, y, z);
    if (-seen.z() <= camera.clip_start_m) {
      const PixelRect rect = ProjectedBox(bounding_box(mesh), camera_from_object, camera).rect();
      if (rect.empty()) return std::nullopt;
      return PixelBounds{rect.x - 0.5, rect.y - 0.5, rect.end_x() - 0.5, rect.end_y() - 0.5};
    }
    const double column = camera.center_px[0] + camera.focal_px[0] * seen.x() / -seen.z();
    const double row = camera.center_px[1] - camera.focal_px[1] * seen.y() / -seen.z();
    bounds.left = std::min(bounds.left, column);
    bounds.right = std::max(bounds.right, column);
    bounds.top = std::min(bounds.top, row);
    bounds.bottom = std::max(bounds.bottom, row);
  }
  if (mesh.positions.empty()) return std::nullopt;
  return bounds;
}

std::optional<PixelBounds> clipped_to_image(const PixelBounds& bounds, const PixelCamera& camera) {
  const PixelBounds clipped{std::max(bounds.left, -0.5), std::max(bounds.top, -0.5),
                            std::min(bounds.right, camera.width - 0.5),
                            std::min(bounds.bottom, camera.height - 0.5)};
  if (!(clipped.left < clipped.right && clipped.top < clipped.bottom)) return std::nullopt;
  return clipped;
}

}  // namespace seedframe
