#include "preview/twin_shading.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "image/luminance.h"
#include "preview/seen_points.h"
#include "preview/surface_colors.h"
#include "preview/surface_light.h"
#include "spec/scaled_view.h"
#include "twin/twin.h"

namespace seedframe {
namespace {

using Eigen::Vector3f;

constexpr int kPointsOfPixel = 2;   // both ways
constexpr int kBrightnessStep = 7;  // a seventh of the points tells enough

/// The world of a frame: as far as the camera sees it, and as it lights surfaces.
struct Surroundings {
  Vector3f color = Vector3f::Zero();
  Eigen::Matrix3f map_from_camera = Eigen::Matrix3f::Identity();
  std::shared_ptr<const EnvironmentMap> map;  ///< none: the same everywhere

  Vector3f seen(const Vector3f& direction) const {
    if (map == nullptr) return color;
    return map->radiance(map_from_camera * direction).cwiseProduct(color);
  }
};

Result<Surroundings> surroundings_of(const WorldSpec& world, const ExpandedFrame& frame,
                                     ShadingImages& images) {
  Surroundings around;
  around.color = (world.strength * Eigen::Vector3d(world.color[0], world.color[1], world.color[2]))
                     .cast<float>();
  if (world.hdri.empty() || around.color.isZero()) return around;
  around.map_from_camera = world.map_from_camera.cast<float>();
  auto map = images.environment(*frame.used.images.at(world.hdri));
  if (!map) return forward_error(map);
  around.map = std::move(*map);
  return around;
}

LightSources sources_of(const FrameSpec& spec, const Surroundings& around) {
  LightSources sources;
  sources.lamps = std::vector<Lamp>(spec.lights.begin(), spec.lights.end());
  sources.ambient_color = around.color;
  sources.ambient_from_camera = around.map_from_camera;
  sources.ambient =
      around.map != nullptr ? around.map->ambient() : AmbientLight::even(Vector3f::Ones());
  return sources;
}

/// Of a pixel's centre, in the camera's frame; z is -1.
Vector3f ray_of(const CameraSpec& camera, int row, int column) {
  return Eigen::Vector3d((column - camera.center_px[0]) / camera.focal_px[0],
                         (camera.center_px[1] - row) / camera.focal_px[1], -1.0)
      .cast<float>();
}

}  // namespace

Result<Shading> shaded(const FrameSpec& spec, const ExpandedFrame& frame, TwinTracer& tracer,
                       ShadingImages& images) {
  const FrameSpec fine = scaled_view(spec, kPointsOfPixel);
  const Result<Twin> twin = tracer.trace(fine, frame.meshes, TwinTracer::Passes::kSurfaces);
  if (!twin) return forward_error(twin);
  const Result<SurfaceColors> colors = SurfaceColors::make(fine, frame, images);
  if (!colors) return forward_error(colors);
  const Result<Surroundings> around = surroundings_of(fine.world, frame, images);
  if (!around) return forward_error(around);
  const RayImage& rays = twin->rays();
  const SeenPoints points(rays, fine.camera);
  const std::vector<Vector3f> irradiance =
      light_on(points, twin->scene(), *colors, sources_of(fine, *around));
  Shading shading{Image<float>(spec.render.width, spec.render.height, 3), {}};
  for (int row = 0; row < rays.height; ++row) {
    for (int column = 0; column < rays.width; ++column) {
      const std::size_t pixel = rays.index(column, row);
      Vector3f light;
      if (rays.instance[pixel] < 0) {
        light = around->seen(ray_of(fine.camera, row, column));
      } else {
        const auto at = static_cast<std::int32_t>(pixel);
        const Vector3f ray = ray_of(fine.camera, row, column).normalized();
        const Glance glance{points.pixel_width_m(at), std::abs(ray.dot(points.normal(at)))};
        const auto instance = static_cast<std::size_t>(rays.instance[pixel]);
        light =
            colors->color(instance, rays.points[pixel], glance).cwiseProduct(irradiance[pixel]) /
            std::numbers::pi_v<float>;
        if ((row + column) % kBrightnessStep == 0) {
          shading.brightness.push_back(
              static_cast<float>(luminance(light.x(), light.y(), light.z())));
        }
      }
      constexpr float kShare = 1.0F / (kPointsOfPixel * kPointsOfPixel);
      Eigen::Map<Vector3f>(&shading.light.at(row / kPointsOfPixel, column / kPointsOfPixel)) +=
          kShare * light;
    }
  }
  return shading;
}

double exposure_for(const std::vector<Shading>& shadings) {
  constexpr double kLitShare = 0.7;  // half of a round object may be in the dark
  constexpr double kLitBrightness = 0.25;
  std::vector<float> all;
  for (const Shading& shading : shadings) {
    std::copy_if(shading.brightness.begin(), shading.brightness.end(), std::back_inserter(all),
                 [](float value) { return std::isfinite(value) && value > 0.0F; });
  }
  if (all.empty()) return 1.0;
  const auto lit =
      all.begin() + static_cast<std::ptrdiff_t>(kLitShare * static_cast<double>(all.size()));
  std::nth_element(all.begin(), lit, all.end());
  return kLitBrightness / static_cast<double>(*lit);
}

}  // namespace seedframe
