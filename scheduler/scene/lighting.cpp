#include "scene/lighting.h"

#include <cmath>

#include "base/portable_math.h"
#include "scene/grid.h"
#include "scene/placement.h"

namespace seedframe {
namespace {

constexpr std::uint32_t kMostLights = 1024;
constexpr double kLumensPerWatt = 683.0;

double luminance(const Rgb& color) {
  return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
}

void set_power(const CompiledLight& light, LightSpec& spec, EvaluationContext& context) {
  if (light.power) {
    spec.power = not_negative(*light.power, "power", context);
    return;
  }
  const NumberDraw& output = light.lux ? *light.lux : *light.lumens;
  const double amount = not_negative(output, light.lux ? "lux" : "lumens", context);
  const double y = luminance(spec.color);
  if (y <= 0.0 && amount > 0.0) {
    context.report(output.place(), "black light has no lumens: give the light a colour");
    return;
  }
  spec.power = light.type == LightType::kSpot ? spot_watts_from_lumens(amount, y, spec.angle_rad)
                                              : watts_from_lumens(amount, y);
  if (!std::isfinite(spec.power)) {
    context.report(output.place(),
                   "this takes more watts than can be computed with: the colour is "
                   "too dark, or the cone of the spot too narrow");
  }
}

LightSpec one_light(const CompiledLight& light, const Eigen::Vector3d& offset,
                    const Affine& world_from_camera, EvaluationContext& context) {
  light.variables.evaluate(context);
  LightSpec spec;
  spec.kind = static_cast<LightKind>(light.type);
  const Eigen::Vector3d position = light.position.evaluate(context) + offset;
  Eigen::Vector3d target = light.target_below ? position : light.target.evaluate(context);
  const double distance = (target - position).norm();
  if (distance == 0.0) target = position - Eigen::Vector3d::UnitZ();
  if (!std::isfinite(distance)) {
    context.report(light.place, "the position or the target is too large to compute with");
  }
  spec.camera_from_light = relative_to_camera(world_from_camera, looking_at(position, target, 0.0));
  spec.color = light.color.evaluate(context);
  if (light.type == LightType::kPoint || light.type == LightType::kSpot) {
    spec.radius_m = not_negative(light.radius_m, "radius_m", context);
  }
  if (light.type == LightType::kSun || light.type == LightType::kSpot) {
    // A narrower spot would be one of a degree in Blender, without a word.
    const double least = light.type == LightType::kSpot ? 1.0 : 0.0;
    spec.angle_rad = portable::radians(within(light.angle_deg, least, 180, "angle_deg", context));
  }
  if (light.type == LightType::kSpot) spec.blend = within(light.blend, 0, 1, "blend", context);
  if (light.type == LightType::kArea) {
    spec.width_m = positive(light.width_m, "width_m", context);
    spec.height_m = positive(light.height_m, "height_m", context);
  }
  set_power(light, spec, context);
  return spec;
}

}  // namespace

double watts_from_lumens(double lumens, double luminance) {
  return lumens == 0.0 ? 0.0 : lumens / (kLumensPerWatt * luminance);
}

double spot_watts_from_lumens(double lumens, double luminance, double cone_rad) {
  const double share_of_sphere = 0.5 * (1.0 - portable::cos(0.5 * cone_rad));
  return lumens == 0.0 ? 0.0 : watts_from_lumens(lumens, luminance) / share_of_sphere;
}

void add_lights(const CompiledConfig& config, const Affine& world_from_camera, FrameDraft& draft,
                EvaluationContext& context) {
  for (const CompiledLight& light : config.lights) {
    const Grid grid = light.grid ? evaluate_grid(*light.grid, kMostLights, context) : Grid();
    const std::uint32_t copies =
        light.grid ? grid.size() : copies_of(light.count, kMostLights, context);
    context.values.numbers[config.built_in.copies] = copies;
    for (std::uint32_t copy = 0; copy < copies && !context.error; ++copy) {
      context.copy = copy;
      context.ordinal = copy;
      context.values.numbers[config.built_in.copy_index] = copy;
      draft.spec.lights.push_back(one_light(light, grid.offset(copy), world_from_camera, context));
    }
    context.copy = kNoIndex;
  }
}

void set_world(const CompiledWorld& world, const Affine& world_from_camera,
               const MaterialPicker& materials, FrameDraft& draft, EvaluationContext& context) {
  WorldSpec& spec = draft.spec.world;
  spec.color = world.color.evaluate(context);
  spec.strength = not_negative(world.strength, "the world's strength", context);
  if (!world.hdri) return;
  spec.hdri = materials.hdri(*world.hdri, draft, context);
  spec.importance_map_px = world.importance_map_px;
  const double angle = world.rotation_deg.evaluate(context);
  const Eigen::Matrix3d map_from_world =
      rotation_and_scale({0.0, 0.0, -angle}, Eigen::Vector3d::Ones());
  spec.map_from_camera = map_from_world * world_from_camera.linear();
}

}  // namespace seedframe
