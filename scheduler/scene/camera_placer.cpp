#include "scene/camera_placer.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "scene/placement.h"

namespace seedframe {
namespace {

/// Blender takes numbers beyond these limits, and renders with the limit without a word.
void check_focal_lengths(const CompiledCamera& camera, const RenderSettings& render,
                         const CameraSpec& spec, EvaluationContext& context) {
  const auto& [fx, fy] = spec.focal_px;
  // The sensor is 36 mm wide in Blender, and no lens is below 1 mm.
  if (fx < render.width / 36.0) {
    context.report(camera.fov_deg ? camera.fov_deg->place() : camera.focal_px.front().place(),
                   "the view is too wide: Blender's lenses reach 173.6 degrees (a focal length of "
                   "1/36 of the image's width)");
  }
  constexpr double kMostAspect = 200.0;
  if (fx > kMostAspect * fy || fy > kMostAspect * fx) {
    context.report(camera.focal_px.back().place(),
                   "the pixels are too far from square: one focal length must be at most 200 times "
                   "the other, which is what Blender renders");
  }
}

void set_intrinsics(const CompiledCamera& camera, const RenderSettings& render, CameraSpec& spec,
                    EvaluationContext& context) {
  if (!camera.focal_px.empty()) {
    spec.focal_px[0] = positive(camera.focal_px.front(), "focal_px", context);
    spec.focal_px[1] = camera.focal_px.size() == 1
                           ? spec.focal_px[0]
                           : positive(camera.focal_px.back(), "focal_px", context);
  } else {
    const double fov = within(*camera.fov_deg, 0.01, 179.0, "fov_deg", context);
    spec.focal_px.fill(0.5 * render.width / portable::tan(0.5 * portable::radians(fov)));
  }
  spec.center_px = {0.5 * (render.width - 1), 0.5 * (render.height - 1)};
  if (camera.center_px) {
    for (std::size_t i = 0; i < 2; ++i) {
      spec.center_px[i] = (*camera.center_px)[i].evaluate(context);
    }
  }
  constexpr double kLeastClip = 1e-6;  // where Blender begins to see
  spec.clip_start_m = at_least(camera.clip_start_m, kLeastClip, false, "clip_start_m", context);
  spec.clip_end_m = at_least(camera.clip_end_m, spec.clip_start_m, true, "clip_end_m", context);
  check_focal_lengths(camera, render, spec, context);
}

/// The lens behind an f-stop: its aperture is its focal length over the f-stop, and it is as long
/// as the sensor's width asks for.
void set_focus(const CompiledCamera& camera, const RenderSettings& render, double target_distance,
               CameraSpec& spec, EvaluationContext& context) {
  const double f_stop = not_negative(camera.f_stop, "f_stop", context);
  if (f_stop == 0.0) return;
  const double sensor_mm = positive(camera.sensor_width_mm, "sensor_width_mm", context);
  const double focal_m = 0.001 * spec.focal_px[0] * sensor_mm / render.width;
  spec.aperture_radius_m = 0.5 * focal_m / f_stop;
  spec.focus_distance_m = camera.focus_distance_m
                              ? positive(*camera.focus_distance_m, "focus_distance_m", context)
                              : target_distance;
}

Eigen::Vector3d middle_of_objects(const FrameDraft& draft) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PlacedInstance& instance : draft.placed) {
    if (instance.spec.id != 0) sum += instance.centre;
  }
  return draft.objects > 0 ? Eigen::Vector3d(sum / draft.objects) : sum;
}

Affine parent_of(const CompiledConfig& config, const FrameDraft& draft,
                 EvaluationContext& context) {
  if (!config.camera.parent) return Affine::Identity();
  const auto object = std::find_if(
      config.objects.begin(), config.objects.end(),
      [&](const CompiledObject& candidate) { return candidate.name == *config.camera.parent; });
  const FrameDraft::Section& section = draft.sections[object->section];
  if (section.copies == 0) {
    context.report(config.camera.place, "the camera's parent '" + *config.camera.parent +
                                            "' has no copies in this frame");
  }
  return section.world_from_first;
}

/// Gains that make this light white, of which green is 1.
std::array<double, 3> gains_for(const CompiledSensor& sensor, EvaluationContext& context) {
  const Rgb light = sensor.white_balance.evaluate(context);
  constexpr double kMostGain = 64.0;
  const auto [least, most] = std::minmax_element(light.begin(), light.end());
  if (*least <= 0.0 || *most / *least > kMostGain) {
    context.report(sensor.place,
                   fmt::format("white_balance must have red, green and blue, none above {} times "
                               "another, found [{}, {}, {}]",
                               kMostGain, light[0], light[1], light[2]));
    return {1.0, 1.0, 1.0};
  }
  return {light[1] / light[0], 1.0, light[1] / light[2]};
}

}  // namespace

Affine place_camera(const CompiledConfig& config, FrameDraft& draft, EvaluationContext& context) {
  const CompiledCamera& camera = config.camera;
  camera.variables.evaluate(context);
  set_intrinsics(camera, draft.spec.render, draft.spec.camera, context);
  const Eigen::Vector3d target =
      camera.target ? camera.target->evaluate(context) : middle_of_objects(draft);
  Eigen::Vector3d position;
  if (camera.position) {
    position = camera.position->evaluate(context);
  } else {
    position = on_shell(target, positive(camera.distance_m, "distance_m", context),
                        camera.azimuth_deg.evaluate(context),
                        within(camera.elevation_deg, -90, 90, "elevation_deg", context));
  }
  const double distance = (target - position).norm();
  set_focus(camera, draft.spec.render, distance, draft.spec.camera, context);
  if (distance == 0.0) {
    context.report(camera.place, "the camera stands where it looks: move position or target");
    return Affine::Identity();
  }
  if (!std::isfinite(distance)) {
    context.report(camera.place, "the position or the target is too large to compute with");
  }
  return parent_of(config, draft, context) *
         looking_at(position, target, camera.roll_deg.evaluate(context));
}

void set_sensor(const std::optional<CompiledSensor>& sensor, FrameSpec& spec,
                EvaluationContext& context) {
  if (!sensor) return;
  constexpr double kMostStops = 16.0, kMostBlurPx = 32.0, kMostElectrons = 1e7;
  SensorSettings& settings = spec.sensor.emplace();
  settings.blur_px = within(sensor->blur_px, 0.0, kMostBlurPx, "blur_px", context);
  settings.exposure_stops =
      within(sensor->exposure_stops, -kMostStops, kMostStops, "exposure_stops", context);
  settings.full_well = within(sensor->full_well, 0.0, kMostElectrons, "full_well", context);
  settings.read_noise = within(sensor->read_noise, 0.0, kMostElectrons, "read_noise", context);
  if (settings.read_noise > 0.0 && settings.full_well == 0.0) {
    context.report(sensor->read_noise.place(),
                   "read_noise is in electrons: say with full_well how many of them are white");
  }
  settings.white_balance = gains_for(*sensor, context);
  settings.jpeg_quality = static_cast<int>(
      std::floor(within(sensor->jpeg_quality, 0.0, 100.0, "jpeg_quality", context) + 0.5));
  settings.seed = sensor->seed.cycles_seed(context.position(Level::kFrame));
}

}  // namespace seedframe
