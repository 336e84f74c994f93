// The outline of a closed mesh on a mask: what its rays hit, told without tracing them. No header
// outside of rays includes this.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "base/pixel_rect.h"
#include "rays/embree_device.h"
#include "rays/pixel_camera.h"

namespace seedframe {

/// Pixels of a mask before anything is traced; 0 is not set.
constexpr std::uint8_t kSet = 1;
constexpr std::uint8_t kUnknown = 2;

/// A mask under construction, over `rect`.
struct MaskDraft {
  PixelRect rect;
  std::vector<std::uint8_t> mask;

  explicit MaskDraft(const PixelRect& area)
      : rect(area), mask(static_cast<std::size_t>(area.area()), 0) {}

  /// From the rectangle's first column on.
  std::uint8_t* row(int y) {
    return mask.data() +
           static_cast<std::size_t>(y - rect.y) * static_cast<std::size_t>(rect.width);
  }
};

/// The outline is where a triangle that is seen from one side meets one that is seen from the
/// other (A. Appel, The notion of quantitative invisibility, 1967). How often it winds around a
/// pixel is how many triangles of one side the pixel's ray hits. Nearer to it than the arithmetic
/// of rays can be off by, pixels stay unknown; the others become kSet or 0. Returns how many are
/// unknown: all, when the mesh is not closed, is not wholly between the clips, or is stretched or
/// large out of all proportion to its distance.
std::int64_t fill_outline(const RayMesh& mesh, const Eigen::Affine3d& camera_from_object,
                          const PixelCamera& camera, MaskDraft& draft);

}  // namespace seedframe
