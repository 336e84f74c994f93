#include "preview/twin_shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace seedframe {
namespace {

using Eigen::Vector3d;

/// Textures are not looked at: what has one is of this grey, times its colour.
constexpr double kTexturedTone = 0.45;
constexpr double kEnvironmentTone = 0.6;  // of an environment map, times its colour

Vector3d vector_of(const Rgb& color) { return {color[0], color[1], color[2]}; }

/// The mean of its slots' materials.
Vector3d albedo_of(const FrameSpec& spec, const InstanceSpec& instance) {
  Vector3d sum = Vector3d::Zero();
  for (const int slot : instance.materials) {
    const MaterialSpec& material = spec.materials[static_cast<std::size_t>(slot)];
    const double tone = material.textures.contains("color") ? kTexturedTone : 1.0;
    sum += tone * vector_of(material.base_color);
  }
  if (instance.materials.empty()) return Vector3d::Constant(0.5);
  return sum / static_cast<double>(instance.materials.size());
}

/// Irradiance of a surface that faces a light, as if it shone evenly to all sides of it.
class Lamp {
 public:
  explicit Lamp(const LightSpec& light)
      : kind_(light.kind),
        place_(light.camera_from_light.translation()),
        back_(light.camera_from_light.linear().col(2).normalized()),
        flux_(light.power * vector_of(light.color)),
        edge_(std::cos(0.5 * light.angle_rad)) {}

  Vector3d irradiance(const Vector3d& point, const Vector3d& normal) const {
    if (kind_ == LightKind::kSun) return flux_ * std::max(0.0, normal.dot(back_));
    const Vector3d to_light = place_ - point;
    const double distance2 = std::max(to_light.squaredNorm(), 1e-9);
    const Vector3d direction = to_light / std::sqrt(distance2);
    const double facing = std::max(0.0, normal.dot(direction));
    const double leaving = direction.dot(back_);  // cosine at the lamp
    if (kind_ == LightKind::kSpot && leaving < edge_) return Vector3d::Zero();
    const double aimed = kind_ == LightKind::kArea ? 4.0 * std::max(0.0, leaving) : 1.0;
    return flux_ * (facing * aimed / (4.0 * std::numbers::pi * distance2));
  }

 private:
  LightKind kind_;
  Vector3d place_, back_, flux_;
  double edge_;
};

class Shader {
 public:
  Shader(const FrameSpec& spec, const Affine& world_from_camera)
      : spec_(spec),
        up_(world_from_camera.linear().transpose().col(2).normalized()),
        sky_(spec.world.strength * (spec.world.hdri.empty() ? 1.0 : kEnvironmentTone) *
             vector_of(spec.world.color)) {
    for (const LightSpec& light : spec.lights) lamps_.emplace_back(light);
    for (const InstanceSpec& instance : spec.instances) {
      albedo_by_id_[static_cast<std::size_t>(instance.id)] = albedo_of(spec, instance);
    }
  }

  Vector3d sky() const { return sky_; }

  Vector3d light_of(int row, int column, double depth, const Vector3d& normal, int id) const {
    const CameraSpec& camera = spec_.camera;
    const Vector3d point = {(column - camera.center_px[0]) / camera.focal_px[0] * depth,
                            (camera.center_px[1] - row) / camera.focal_px[1] * depth, -depth};
    Vector3d irradiance = std::numbers::pi * (0.6 + 0.4 * normal.dot(up_)) * sky_;
    for (const Lamp& lamp : lamps_) irradiance += lamp.irradiance(point, normal);
    return albedo_by_id_[static_cast<std::size_t>(id)].cwiseProduct(irradiance) / std::numbers::pi;
  }

 private:
  const FrameSpec& spec_;
  Vector3d up_, sky_;
  std::vector<Lamp> lamps_;
  std::vector<Vector3d> albedo_by_id_ = std::vector<Vector3d>(65'536, Vector3d::Constant(0.5));
};

}  // namespace

Shading shaded(const FrameSpec& spec, const Affine& world_from_camera, const Twin& twin) {
  constexpr int kBrightnessStep = 7;  // a seventh of the pixels tells enough
  const Shader shader(spec, world_from_camera);
  Shading shading{Image<float>(spec.render.width, spec.render.height, 3), {}};
  for (int row = 0; row < spec.render.height; ++row) {
    for (int column = 0; column < spec.render.width; ++column) {
      const float* n = &twin.normal->at(row, column);
      const Vector3d normal(n[0], n[1], n[2]);
      const bool is_sky = normal.isZero();
      const Vector3d seen = is_sky ? shader.sky()
                                   : shader.light_of(row, column, twin.depth->at(row, column),
                                                     normal, twin.instance_ids.at(row, column));
      for (int c = 0; c < 3; ++c) shading.light.at(row, column, c) = static_cast<float>(seen[c]);
      if (is_sky || (row + column) % kBrightnessStep != 0) continue;
      shading.brightness.push_back(static_cast<float>(seen.dot(Vector3d(0.2126, 0.7152, 0.0722))));
    }
  }
  return shading;
}

double exposure_for(const std::vector<Shading>& shadings) {
  constexpr double kLitShare = 0.7;  // half of a round object may be in the dark
  constexpr double kLitBrightness = 0.30;
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

Image<std::uint8_t> shaded_display(const Image<float>& light, double exposure) {
  constexpr std::size_t kSteps = 1024;
  static const std::array<std::uint8_t, kSteps + 1> code_by_step = [] {
    std::array<std::uint8_t, kSteps + 1> codes{};
    for (std::size_t i = 0; i <= kSteps; ++i) {
      // What is bright is rolled off: 0 to 1 stands for 0 to infinity of light.
      const double share = static_cast<double>(i) / kSteps;
      const double display =
          share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1.0 / 2.4) - 0.055;
      codes[i] = static_cast<std::uint8_t>(std::lround(255.0 * display));
    }
    return codes;
  }();
  Image<std::uint8_t> display(light.width, light.height, 3);
  std::transform(
      light.values.begin(), light.values.end(), display.values.begin(), [&](float value) {
        const double exposed = std::isfinite(value) ? std::max(0.0, exposure * value) : 0.0;
        const double rolled = exposed * (1.0 + exposed / 9.0) / (1.0 + exposed);  // white at 3
        return code_by_step[static_cast<std::size_t>(std::min(1.0, rolled) * kSteps)];
      });
  return display;
}

}  // namespace seedframe
