// How much light arrives where the camera looks: of lamps, of all around, and from one surface to
// the next.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "preview/environment_map.h"
#include "preview/lamp.h"
#include "preview/seen_points.h"
#include "preview/surface_colors.h"
#include "rays/ray_scene.h"

namespace seedframe {

/// What lights a frame.
struct LightSources {
  std::vector<Lamp> lamps;
  AmbientLight ambient = AmbientLight::even(Eigen::Vector3f::Zero());
  Eigen::Vector3f ambient_color = Eigen::Vector3f::Zero();  ///< times it
  Eigen::Matrix3f ambient_from_camera = Eigen::Matrix3f::Identity();
};

/// Irradiance of every pixel, RGB. Each has a ray to each lamp, by which it is lit or not, and each
/// fourth one into the open: what it meets there hides the light from around, and sends on, once,
/// the light of lamps and surroundings as if nothing stood between them and it.
std::vector<Eigen::Vector3f> light_on(const SeenPoints& points, const RayScene& scene,
                                      const SurfaceColors& colors, const LightSources& sources);

}  // namespace seedframe
