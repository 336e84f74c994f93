#include "scene/compiled_config.h"

#include "base/nearest_name.h"
#include "scene/section_compiler.h"

namespace seedframe {
namespace {

class Compiler {
 public:
  Compiler(const CampaignConfig& config, const MaterialLibrary& materials, CompiledConfig& compiled,
           Diagnostics& errors)
      : config_(config), materials_(materials), compiled_(compiled), errors_(errors) {
    scope_.seed = config.draw_seed();
  }

  void run() {
    const auto block = [&](const auto& variables, const char* prefix, Level level) {
      return VariableBlock::compile(variables, prefix, level, compiled_.variables, scope_, errors_);
    };
    BuiltInSlots& built_in = compiled_.built_in;
    compiled_.campaign_variables =
        block(config_.campaign_variables, "variables.campaign.", Level::kCampaign);
    built_in.scene_index = add_built_in("scene_index");
    compile_sweep();
    compiled_.scene_variables = block(config_.scene_variables, "variables.scene.", Level::kScene);
    built_in.frame_index = add_built_in("frame_index");
    compiled_.frame_variables = block(config_.frame_variables, "variables.frame.", Level::kFrame);
    compile_world_and_ground();
    compile_camera();
    compile_sensor();
    count_scope_ = scope_;
    built_in.copy_index = add_built_in("copy_index");
    built_in.copies = add_built_in("copies");
    for (const ObjectConfig& object : config_.objects) {
      compiled_.objects.push_back(compile_object(object, "objects.", count_scope_, scope_));
      if (!object.material_of_parent) continue;
      errors_.add(object.place,
                  "material: parent, but '" + object.name + "' is in no other object");
    }
    compiled_.sections = sections_.size();
    for (const LightConfig& light : config_.lights) compile_light(light);
    for (const ConstraintConfig& constraint : config_.constraints) compile_constraint(constraint);
  }

 private:
  std::size_t add_built_in(const char* name) {
    const std::size_t slot = compiled_.variables.add_numbers();
    scope_.symbols[name] = number_symbol(slot);
    return slot;
  }

  void compile_sweep() {
    for (std::size_t axis = 0; axis < config_.sweep.axes.size(); ++axis) {
      const SweepAxis& config = config_.sweep.axes[axis];
      if (config.points.empty()) continue;
      for (const auto& [name, value] : config.points.front()) {
        CompiledSweep::Variable variable;
        variable.name = name;
        variable.axis = axis;
        refuse_taken_name(name, config.place, scope_, errors_);
        variable.is_text = std::holds_alternative<std::string>(value);
        VariableTable& table = compiled_.variables;
        variable.slot = variable.is_text ? table.add_text() : table.add_numbers();
        const ValueType type = variable.is_text ? ValueType::kText : ValueType::kNumber;
        scope_.symbols[name] = {{type, {}}, variable.slot};
        compiled_.sweep.variables.push_back(variable);
      }
    }
  }

  void compile_world_and_ground() {
    const SectionCompiler world(scope_, "world", config_.world.redraw, errors_);
    compiled_.world.place = config_.world.place;
    compiled_.world.color = world.color(config_.world.color, "color");
    compiled_.world.strength = world.number(config_.world.strength, "strength");
    compiled_.world.rotation_deg = world.number(config_.world.rotation_deg, "rotation_deg");
    if (config_.world.hdri) {
      compiled_.world.hdri = world.text(*config_.world.hdri, "hdri");
      compiled_.world.importance_map_px = config_.world.importance_map_px;
      world.refuse_unknown(*compiled_.world.hdri, materials_.hdris(), materials_,
                           &MaterialLibrary::no_hdri);
    }
    if (!config_.ground) return;
    const SectionCompiler section(scope_, "ground", config_.ground->redraw, errors_);
    compiled_.ground =
        CompiledGround{section.number(config_.ground->width_m, "width_m"),
                       section.number(config_.ground->depth_m, "depth_m"),
                       section.number(config_.ground->curvature_per_m, "curvature_per_m"),
                       section.materials(config_.ground->material, materials_, "material", false),
                       config_.ground->place};
  }

  void compile_sensor() {
    if (!config_.sensor) return;
    const SensorConfig& config = *config_.sensor;
    const SectionCompiler section(scope_, "sensor", config.redraw, errors_);
    compiled_.sensor = CompiledSensor{config.place,
                                      section.number(config.blur_px, "blur_px"),
                                      section.number(config.exposure_stops, "exposure_stops"),
                                      section.number(config.full_well, "full_well"),
                                      section.number(config.read_noise, "read_noise"),
                                      section.number(config.jpeg_quality, "jpeg_quality"),
                                      section.color(config.white_balance, "white_balance"),
                                      PhiloxStream(scope_.seed, "sensor.seed")};
  }

  void compile_camera() {
    const CameraConfig& config = config_.camera;
    CompiledCamera& camera = compiled_.camera;
    CompileScope scope = scope_;
    camera.place = config.place;
    camera.variables = VariableBlock::compile(config.variables, "camera.variables.", config.redraw,
                                              compiled_.variables, scope, errors_);
    const SectionCompiler section(scope, "camera", config.redraw, errors_);
    const auto pair = [&](const std::array<NumberSource, 2>& sources, const std::string& key) {
      return std::array<NumberDraw, 2>{section.number(sources[0], (key + "[0]").c_str()),
                                       section.number(sources[1], (key + "[1]").c_str())};
    };
    camera.fov_deg = section.number(config.fov_deg, "fov_deg");
    for (std::size_t i = 0; i < config.focal_px.size(); ++i) {
      const std::string key =
          config.focal_px.size() == 1 ? "focal_px" : fmt::format("focal_px[{}]", i);
      camera.focal_px.push_back(section.number(config.focal_px[i], key.c_str()));
    }
    if (config.center_px) camera.center_px = pair(*config.center_px, "center_px");
    if (config.target) camera.target = section.vector(*config.target, "target");
    if (config.position) camera.position = section.vector(*config.position, "position");
    camera.distance_m = section.number(config.distance_m, "distance_m");
    camera.azimuth_deg = section.number(config.azimuth_deg, "azimuth_deg");
    camera.elevation_deg = section.number(config.elevation_deg, "elevation_deg");
    camera.roll_deg = section.number(config.roll_deg, "roll_deg");
    camera.clip_start_m = section.number(config.clip_start_m, "clip_start_m");
    camera.clip_end_m = section.number(config.clip_end_m, "clip_end_m");
    camera.f_stop = section.number(config.f_stop, "f_stop");
    camera.sensor_width_mm = section.number(config.sensor_width_mm, "sensor_width_mm");
    camera.focus_distance_m = section.number(config.focus_distance_m, "focus_distance_m");
    camera.parent = config.parent;
    if (!config.parent) return;
    std::vector<std::string> names;
    for (const ObjectConfig& object : config_.objects) names.push_back(object.name);
    if (std::find(names.begin(), names.end(), *config.parent) == names.end()) {
      errors_.add(config.place, "there is no object '" + *config.parent +
                                    "' to be the camera's "
                                    "parent" +
                                    did_you_mean(*config.parent, names));
    }
  }

  /// `outer` is what a count may refer to, `inner` what everything else may.
  CompiledObject compile_object(const ObjectConfig& config, const std::string& prefix,
                                const CompileScope& outer, const CompileScope& inner) {
    CompileScope scope = inner;
    scope.copies = true;
    const std::string section_name = prefix + config.name;
    const SectionCompiler count_section(outer, section_name, config.redraw, errors_);
    CompiledObject object;
    object.name = config.name;
    object.section = sections_.size();
    sections_.push_back(config.name);
    object.place = config.place;
    object.count = count_section.number(config.count, "count");
    object.grid = count_section.grid(config.grid);
    object.variables = VariableBlock::compile(config.variables, section_name + ".variables.",
                                              config.redraw, compiled_.variables, scope, errors_);
    const SectionCompiler section(scope, section_name, config.redraw, errors_);
    if (config.asset) object.asset = section.text(*config.asset, "asset");
    if (config.category) object.category = section.text(*config.category, "category");
    object.category_of_asset = config.category_of_asset;
    object.material_of_parent = config.material_of_parent;
    if (!config.material_of_parent && (config.asset || config.has_material)) {
      object.materials =
          section.materials(config.material, materials_, "material", config.asset.has_value());
    }
    if (config.asset) {
      for (const auto& [slot, source] : config.slots) {
        object.slots.emplace(slot, section.materials(source, materials_, "slots." + slot, true));
      }
    }
    object.scale = section.vector(config.scale, "scale");
    object.rotation_deg = section.vector(config.rotation_deg, "rotation_deg");
    compile_attitude(config, section, object);
    object.position = section.vector(config.position, "position");
    if (config.scatter) object.scatter = compile_scatter(*config.scatter, section);
    object.rest_on_ground = config.rest_on_ground || config.rest_stable;
    object.hidden_from = config.hidden_from;
    object.auto_detail = config.auto_detail;
    for (const ObjectConfig& child : config.objects) {
      object.objects.push_back(compile_object(child, section_name + ".objects.", scope, scope));
      if (!child.material_of_parent) continue;
      object.material_for_objects = true;
      if (config.asset || config.has_material) continue;
      errors_.add(child.place, "material: parent, but '" + config.name + "' has no material");
    }
    return object;
  }

  /// Uniform over [0, 1].
  static NumberSource anywhere_in_unit(const Place& place) {
    auto unit = std::make_shared<Distribution>();
    unit->parameters = {number_constant(0.0), number_constant(1.0)};
    return {place, unit};
  }

  static void compile_attitude(const ObjectConfig& config, const SectionCompiler& section,
                               CompiledObject& object) {
    const NumberSource anywhere = anywhere_in_unit(config.place);
    if (config.random_rotation) {
      object.random_rotation = {section.number(anywhere, "rotation[0]"),
                                section.number(anywhere, "rotation[1]"),
                                section.number(anywhere, "rotation[2]")};
    }
    if (config.quaternion) {
      object.quaternion.emplace();
      for (std::size_t i = 0; i < 4; ++i) {
        const std::string key = fmt::format("rotation.quaternion[{}]", i);
        (*object.quaternion)[i] = section.number((*config.quaternion)[i], key.c_str());
      }
    }
    if (config.rest_stable) object.stable_face = section.number(anywhere, "rest");
  }

  static CompiledScatter compile_scatter(const ScatterConfig& config,
                                         const SectionCompiler& section) {
    const NumberSource anywhere = anywhere_in_unit(config.place);
    return {
        {section.number(config.x[0], "scatter.x[0]"), section.number(config.x[1], "scatter.x[1]")},
        {section.number(config.y[0], "scatter.y[0]"), section.number(config.y[1], "scatter.y[1]")},
        section.number(anywhere, "scatter.x"),
        section.number(anywhere, "scatter.y"),
        section.number(config.gap_m, "scatter.gap_m"),
        config.pile,
        section.number(anywhere, "scatter.pile"),
        section.level(),
        config.place};
  }

  void compile_light(const LightConfig& config) {
    CompileScope scope = scope_;
    scope.copies = true;
    const std::string section_name = "lights." + config.name;
    const SectionCompiler count_section(count_scope_, section_name, config.redraw, errors_);
    CompiledLight light;
    light.name = config.name;
    light.place = config.place;
    light.type = config.type;
    light.count = count_section.number(config.count, "count");
    light.grid = count_section.grid(config.grid);
    light.variables = VariableBlock::compile(config.variables, section_name + ".variables.",
                                             config.redraw, compiled_.variables, scope, errors_);
    const SectionCompiler section(scope, section_name, config.redraw, errors_);
    light.position = section.vector(config.position, "position");
    light.target = section.vector(config.target, "target");
    light.target_below = config.target_below;
    light.color = section.color(config.color, "color");
    light.power = section.number(config.power, "power");
    light.lumens = section.number(config.lumens, "lumens");
    light.lux = section.number(config.lux, "lux");
    light.radius_m = section.number(config.radius_m, "radius_m");
    light.angle_deg = section.number(config.angle_deg, "angle_deg");
    light.blend = section.number(config.blend, "blend");
    light.width_m = section.number(config.width_m, "width_m");
    light.height_m = section.number(config.height_m, "height_m");
    compiled_.lights.push_back(std::move(light));
  }

  void compile_constraint(const ConstraintConfig& config) {
    CompiledConstraint constraint;
    constraint.name = config.name;
    constraint.place = config.place;
    constraint.kind = config.kind;
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      const auto& wanted = config.objects;
      if (std::find(wanted.begin(), wanted.end(), sections_[i]) != wanted.end()) {
        constraint.sections.push_back(i);
      }
    }
    const bool metres =
        config.kind == ConstraintKind::kApart || config.kind == ConstraintKind::kDistance;
    const SectionCompiler section(count_scope_, "constraints." + config.name, Level::kFrame,
                                  errors_);
    constraint.at_least = section.number(config.at_least, metres ? "at_least_m" : "at_least");
    compiled_.constraints.push_back(std::move(constraint));
  }

  const CampaignConfig& config_;
  const MaterialLibrary& materials_;
  CompiledConfig& compiled_;
  Diagnostics& errors_;
  CompileScope scope_;
  std::vector<std::string> sections_;  ///< names of all objects
  CompileScope count_scope_;           ///< how many copies there are cannot depend on the copy
};

}  // namespace

void compile_config(const CampaignConfig& config, const MaterialLibrary& materials,
                    CompiledConfig& compiled, Diagnostics& errors) {
  Compiler(config, materials, compiled, errors).run();
}

}  // namespace seedframe
