// Where a ray meets the triangle that Embree found. Included by sources only.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "rays/embree_device.h"
#include "rays/ray_packet.h"
#include "rays/ray_scene.h"

namespace seedframe {

/// Computed in double, from the triangle's corners, with additions, products and quotients alone:
/// the same bits on every CPU. Embree's own values hang on the instructions for approximate
/// reciprocals (`rcpps`), which each maker builds otherwise.
struct HitPoint {
  double depth = 0.0;        ///< the ray's parameter: planar, metres
  double u = 0.0, v = 0.0;   ///< shares of the second and the third corner
  bool from_behind = false;  ///< the ray comes from where the triangle is wound clockwise
};

class HitPoints {
 public:
  explicit HitPoints(const std::vector<RayInstance>& instances) {
    instances_.reserve(instances.size());
    for (const RayInstance& instance : instances) {
      const Eigen::Affine3d object_from_camera = instance.camera_from_object.inverse();
      instances_.push_back({instance.mesh->tree().positions, instance.mesh->tree().triangles,
                            object_from_camera.linear(), object_from_camera.translation()});
    }
  }

  /// Of a lane that has hit something. A triangle that the ray only grazes, so that its plane tells
  /// nothing, keeps Embree's values.
  HitPoint at(const RayPacket& packet, std::size_t lane) const {
    const Instance& instance = instances_[static_cast<std::size_t>(packet.hit(lane))];
    const auto& triangle = instance.triangles[packet.rays.hit.primID[lane]];
    const Eigen::Vector3d corner = point(instance.positions[triangle[0]]);
    const Eigen::Vector3d first = point(instance.positions[triangle[1]]) - corner;
    const Eigen::Vector3d second = point(instance.positions[triangle[2]]) - corner;
    const Eigen::Vector3d ray =
        instance.linear *
        Eigen::Vector3d(packet.rays.ray.dir_x[lane], packet.rays.ray.dir_y[lane], -1.0);
    const Eigen::Vector3d to_corner = corner - instance.origin;
    const Eigen::Vector3d normal = first.cross(second);
    const double along = normal.dot(ray);
    // The ray's parameter and the shares, as ratios of volumes (Möller and Trumbore, "Fast,
    // Minimum Storage Ray/Triangle Intersection", 1997).
    const Eigen::Vector3d turned = to_corner.cross(ray);
    HitPoint hit{normal.dot(to_corner) / along, turned.dot(second) / along,
                 -turned.dot(first) / along, along > 0.0};
    constexpr double kFar = 1e-3;
    const double found = packet.depth(lane);
    if (!(std::abs(hit.depth - found) <= kFar * found)) {
      hit = {found, packet.rays.hit.u[lane], packet.rays.hit.v[lane], hit.from_behind};
    }
    return hit;
  }

 private:
  struct Instance {
    const std::array<float, 3>* positions;
    const std::array<std::uint32_t, 3>* triangles;
    Eigen::Matrix3d linear;  ///< object from camera
    Eigen::Vector3d origin;  ///< the camera, in object space
  };
  static Eigen::Vector3d point(const std::array<float, 3>& at) { return {at[0], at[1], at[2]}; }

  std::vector<Instance> instances_;
};

}  // namespace seedframe
