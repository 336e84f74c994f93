// Where rays through pixels meet an instance's bounding box, and so which pixels cannot show it.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "base/pixel_rect.h"
#include "mesh/mesh.h"
#include "rays/pixel_camera.h"

namespace seedframe {

/// Seen through a pinhole, one over the depth at which a ray meets a plane is linear in the pixel's
/// column and row. So a row of pixels is compared with the planes of a box in a few operations
/// each.
class ProjectedBox {
 public:
  ProjectedBox(const BoundingBox& box, const Eigen::Affine3d& camera_from_object,
               const PixelCamera& camera);

  /// The pixels of the canvas onto which the box may project.
  const PixelRect& rect() const { return rect_; }

  /// Whether a corner is nearer than the camera's near plane, or behind the camera.
  bool reaches_behind() const { return reaches_behind_; }

  struct Columns {
    int begin = 0;
    int end = 0;
  };
  /// Those of a row whose rays may meet the box; the others certainly do not.
  Columns columns_met(int row) const;

  /// For `count` pixels of a row, from column `begin` on: 0 where the box ends before `first_hit`,
  /// the depth at which the ray first hits anything, so that it hits nothing in the box; else 1.
  void find_met_before(int row, int begin, int count, const float* first_hit,
                       std::uint8_t* met) const;

 private:
  /// One over the depth at which rays meet a plane, in pixel (x, y): at_origin + x per_column +
  /// y per_row.
  struct Plane {
    double at_origin;
    double per_column;
    double per_row;

    double at(double column, double row) const {
      return at_origin + column * per_column + row * per_row;
    }
  };
  void add_plane(const Eigen::Vector3d& normal, double offset, const PixelCamera& camera);

  PixelRect rect_;
  bool reaches_behind_ = false;
  double nearest_;              ///< one over the depth of the near plane
  std::vector<Plane> entered_;  ///< by rays: the camera is on their outer side
  std::vector<Plane> left_;     ///< the camera is on their inner side
};

}  // namespace seedframe
