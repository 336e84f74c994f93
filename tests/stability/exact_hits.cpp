#include "tests/stability/exact_hits.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

namespace seedframe {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Eigen::Vector3d;

struct Triangle {
  std::array<Vector3d, 3> corners;  ///< rounded, in the camera's frame, to find candidates
  std::size_t instance = 0;
  std::array<std::array<float, 3>, 3> object_corners;
};

Point exact_point(const Affine& map, const std::array<float, 3>& p) {
  std::array<Number, 3> seen;
  for (int row = 0; row < 3; ++row) {
    seen[static_cast<std::size_t>(row)] = Number(map(row, 0)) * Number(p[0]) +
                                          Number(map(row, 1)) * Number(p[1]) +
                                          Number(map(row, 2)) * Number(p[2]) + Number(map(row, 3));
  }
  return {seen[0], seen[1], seen[2]};
}

/// False only if the ray is so far from the triangle that no rounding could matter.
bool may_hit(const Triangle& triangle, const Vector3d& ray) {
  const auto& [a, b, c] = triangle.corners;
  const std::array<double, 3> sides = {ray.dot(a.cross(b)), ray.dot(b.cross(c)),
                                       ray.dot(c.cross(a))};
  const double size = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()}) * ray.norm();
  const double margin = 1e-9 * size;
  const bool any_left = sides[0] > margin || sides[1] > margin || sides[2] > margin;
  const bool any_right = sides[0] < -margin || sides[1] < -margin || sides[2] < -margin;
  return !(any_left && any_right);
}

}  // namespace

struct ExactScene::Triangles {
  std::vector<Triangle> all;
};

ExactScene::ExactScene(const FrameSpec& spec, const MeshBuffers& buffers)
    : spec_(spec), triangles_(std::make_unique<Triangles>()) {
  for (std::size_t i = 0; i < spec.instances.size(); ++i) {
    const Affine& map = spec.instances[i].camera_from_object;
    const auto mesh = mesh_from_buffer(*buffers.at(spec.instances[i].mesh), "mesh");
    for (const auto& corners : mesh->triangles) {
      Triangle triangle;
      triangle.instance = i;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& p = mesh->positions[corners[k]];
        triangle.object_corners[k] = p;
        triangle.corners[k] = map * Vector3d(p[0], p[1], p[2]);
      }
      triangles_->all.push_back(triangle);
    }
  }
}

ExactScene::~ExactScene() = default;

ExactHit ExactScene::first_hit(int x, int y) const {
  const CameraSpec& camera = spec_.camera;
  const Vector3d rounded((x - camera.center_px[0]) / camera.focal_px[0],
                         (camera.center_px[1] - y) / camera.focal_px[1], -1.0);
  const Vector ray((Number(x) - Number(camera.center_px[0])) / Number(camera.focal_px[0]),
                   (Number(camera.center_px[1]) - Number(y)) / Number(camera.focal_px[1]),
                   Number(-1));
  const Point origin(0, 0, 0);
  const Point ahead = origin + ray;
  ExactHit hit;
  std::optional<Number> nearest;
  for (const Triangle& triangle : triangles_->all) {
    if (!may_hit(triangle, rounded)) continue;
    const InstanceSpec& instance = spec_.instances[triangle.instance];
    std::array<Point, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = exact_point(instance.camera_from_object, triangle.object_corners[k]);
    }
    const std::array<int, 3> sides = {CGAL::orientation(origin, ahead, p[0], p[1]),
                                      CGAL::orientation(origin, ahead, p[1], p[2]),
                                      CGAL::orientation(origin, ahead, p[2], p[0])};
    const int least = std::min({sides[0], sides[1], sides[2]});
    const int most = std::max({sides[0], sides[1], sides[2]});
    if (least < 0 && most > 0) continue;
    const Vector normal = CGAL::cross_product(p[1] - p[0], p[2] - p[0]);
    const Number slope = normal * ray;
    if (slope == 0) continue;  // seen edge-on, it covers nothing
    const Number depth = normal * (p[0] - origin) / slope;
    if (depth < Number(camera.clip_start_m) || depth > Number(camera.clip_end_m)) continue;
    const bool on_an_edge = sides[0] == 0 || sides[1] == 0 || sides[2] == 0;
    if (nearest && depth == *nearest) {
      hit.tie = hit.tie || instance.id != hit.id;
      hit.on_an_edge = hit.on_an_edge || on_an_edge;
    } else if (!nearest || depth < *nearest) {
      nearest = depth;
      hit = {instance.id, false, on_an_edge};
    }
  }
  return hit;
}

}  // namespace seedframe
