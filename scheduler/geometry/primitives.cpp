#include "geometry/primitives.h"

namespace seedframe {

Mesh ground_plane(double width_m, double depth_m) {
  const auto x = static_cast<float>(0.5 * width_m);
  const auto y = static_cast<float>(0.5 * depth_m);
  Mesh mesh;
  mesh.positions = {{-x, -y, 0.0f}, {x, -y, 0.0f}, {x, y, 0.0f}, {-x, y, 0.0f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.corner_uvs = {{-x, -y}, {x, -y}, {x, y}, {-x, -y}, {x, y}, {-x, y}};
  mesh.triangle_slots = {0, 0};
  mesh.slot_names = {"ground"};
  return mesh;
}

}  // namespace seedframe
