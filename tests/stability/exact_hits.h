// What a ray through a pixel's centre meets first, without rounding: by CGAL's exact kernel.
#pragma once

#include <array>
#include <vector>

#include "spec/frame_spec.h"

namespace seedframe {

/// A triangle as the frame spec and the mesh's buffer have it, taken as they stand.
struct ExactTriangle {
  const InstanceSpec* instance = nullptr;
  std::array<std::array<float, 3>, 3> object_corners{};
};

struct ExactHit {
  int triangle = -1;   ///< index of what is hit; -1: nothing
  bool tie = false;    ///< another instance is at exactly the same depth
  double depth = 0.0;  ///< planar, metres, rounded at the end
};

ExactHit exact_first_hit(const CameraSpec& camera, int x, int y,
                         const std::vector<ExactTriangle>& triangles);

}  // namespace seedframe
