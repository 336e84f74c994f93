// How far a mesh reaches in the image.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "mesh/mesh.h"
#include "rays/pixel_camera.h"

namespace seedframe {

/// In pixels; whole numbers are pixels' centres, y points down.
struct PixelBounds {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;
};

/// The tightest bounds of what the mesh projects to, which may be beyond the image. Where it
/// reaches behind the near plane, bounds of its box, on the enlarged canvas. None: nothing of it is
/// ahead. The same on every machine. Looks at every vertex.
std::optional<PixelBounds> projected_bounds(const Mesh& mesh,
                                            const Eigen::Affine3d& camera_from_object,
                                            const PixelCamera& camera);

/// What is inside the image; none: nothing.
std::optional<PixelBounds> clipped_to_image(const PixelBounds& bounds, const PixelCamera& camera);

}  // namespace seedframe
