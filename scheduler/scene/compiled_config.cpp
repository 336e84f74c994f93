#include "scene/compiled_config.h"

#include "base/nearest_name.h"

namespace seedframe {
namespace {

/// Compiles the values of one section, whose draws are keyed by "<section>.<key>".
class SectionCompiler {
 public:
  SectionCompiler(const CompileScope& scope, std::string section, Level level, Diagnostics& errors)
      : scope_(scope), section_(std::move(section)), level_(level), errors_(errors) {}

  NumberDraw number(const NumberSource& source, const char* key) const {
    return NumberDraw::compile(source, scope_, name(key), level_, errors_);
  }
  VectorDraw vector(const VectorSource& source, const char* key) const {
    return VectorDraw::compile(source.components, scope_, name(key), level_, errors_);
  }
  ColorDraw color(const ColorSource& source, const char* key) const {
    return ColorDraw::compile(source, scope_, name(key), level_, errors_);
  }
  NameDraw text(const NameSource& source, const char* key) const {
    return NameDraw::compile(source, scope_, name(key), level_, errors_);
  }

  CompiledMaterial material(const MaterialConfig& config, const MaterialLibrary& library) const {
    const SectionCompiler inner(scope_, name("material.") + config.name, level_, errors_);
    CompiledMaterial material;
    material.place = config.place;
    material.base_color = inner.color(config.base_color, "base_color");
    material.metallic = inner.number(config.metallic, "metallic");
    material.roughness = inner.number(config.roughness, "roughness");
    material.specular = inner.number(config.specular, "specular");
    material.transmission = inner.number(config.transmission, "transmission");
    material.ior = inner.number(config.ior, "ior");
    material.clearcoat = inner.number(config.clearcoat, "clearcoat");
    material.texture_repeat = inner.number(config.texture_repeat, "texture_repeat");
    if (config.textures) {
      material.textures = inner.text(*config.textures, "textures");
      refuse_unknown(*material.textures, library.texture_set_names(), "texture set");
    }
    return material;
  }

  /// Only the materials that the name can become, for each is compiled anew.
  CompiledMaterials materials(const NameSource& source, const MaterialLibrary& library) const {
    CompiledMaterials result{text(source, "material"), {}};
    const auto possible = result.name.possible_values();
    if (possible) {
      refuse_unknown(result.name, library.material_names(), "material");
      for (const std::string& wanted : *possible) {
        const auto found = library.materials().find(wanted);
        if (found != library.materials().end()) {
          result.by_name.emplace(wanted, material(found->second, library));
        }
      }
    } else {
      for (const auto& [known, config] : library.materials()) {
        result.by_name.emplace(known, material(config, library));
      }
    }
    return result;
  }

 private:
  std::string name(const char* key) const { return section_ + "." + key; }

  void refuse_unknown(const NameDraw& draw, const std::vector<std::string>& known,
                      const char* kind) const {
    const auto possible = draw.possible_values();
    if (!possible) return;
    for (const std::string& value : *possible) {
      if (std::find(known.begin(), known.end(), value) == known.end()) {
        errors_.add(draw.place(),
                    fmt::format("there is no {} '{}'{}", kind, value, did_you_mean(value, known)));
      }
    }
  }

  const CompileScope& scope_;
  std::string section_;
  Level level_;
  Diagnostics& errors_;
};

class Compiler {
 public:
  Compiler(const CampaignConfig& config, const MaterialLibrary& materials, CompiledConfig& compiled,
           Diagnostics& errors)
      : config_(config), materials_(materials), compiled_(compiled), errors_(errors) {
    scope_.seed = config.seed;
  }

  void run() {
    const auto block = [&](const auto& variables, const char* prefix, Level level) {
      return VariableBlock::compile(variables, prefix, level, compiled_.values, scope_, errors_);
    };
    BuiltInValues& built_in = compiled_.built_in;
    compiled_.campaign_variables =
        block(config_.campaign_variables, "variables.campaign.", Level::kCampaign);
    built_in.scene_index = add_built_in("scene_index");
    compiled_.scene_variables = block(config_.scene_variables, "variables.scene.", Level::kScene);
    built_in.frame_index = add_built_in("frame_index");
    compiled_.frame_variables = block(config_.frame_variables, "variables.frame.", Level::kFrame);
    compile_world_and_ground();
    compile_camera();
    count_scope_ = scope_;
    built_in.copy_index = add_built_in("copy_index");
    built_in.copies = add_built_in("copies");
    for (const ObjectConfig& object : config_.objects) compile_object(object);
    for (const LightConfig& light : config_.lights) compile_light(light);
  }

 private:
  double* add_built_in(const char* name) {
    double* value = compiled_.values.number();
    if (scope_.numbers.contains(name) || scope_.names.contains(name)) {
      errors_.add(Place{}, fmt::format("the variable '{}' has the name of a built-in one", name));
    }
    scope_.numbers[name] = value;
    return value;
  }

  void compile_world_and_ground() {
    const SectionCompiler world(scope_, "world", config_.world.redraw, errors_);
    compiled_.world_color = world.color(config_.world.color, "color");
    compiled_.world_strength = world.number(config_.world.strength, "strength");
    if (!config_.ground) return;
    const SectionCompiler section(scope_, "ground", config_.ground->redraw, errors_);
    compiled_.ground = CompiledGround{section.number(config_.ground->width_m, "width_m"),
                                      section.number(config_.ground->depth_m, "depth_m"),
                                      section.materials(config_.ground->material, materials_),
                                      config_.ground->place};
  }

  void compile_camera() {
    const CameraConfig& config = config_.camera;
    CompiledCamera& camera = compiled_.camera;
    CompileScope scope = scope_;
    camera.place = config.place;
    camera.variables = VariableBlock::compile(config.variables, "camera.variables.", config.redraw,
                                              compiled_.values, scope, errors_);
    const SectionCompiler section(scope, "camera", config.redraw, errors_);
    if (config.fov_deg) camera.fov_deg = section.number(*config.fov_deg, "fov_deg");
    if (config.focal_px) camera.focal_px = section.number(*config.focal_px, "focal_px");
    if (config.target) camera.target = section.vector(*config.target, "target");
    if (config.position) camera.position = section.vector(*config.position, "position");
    camera.distance_m = section.number(config.distance_m, "distance_m");
    camera.azimuth_deg = section.number(config.azimuth_deg, "azimuth_deg");
    camera.elevation_deg = section.number(config.elevation_deg, "elevation_deg");
    camera.roll_deg = section.number(config.roll_deg, "roll_deg");
    camera.clip_start_m = section.number(config.clip_start_m, "clip_start_m");
    camera.clip_end_m = section.number(config.clip_end_m, "clip_end_m");
  }

  void compile_object(const ObjectConfig& config) {
    CompileScope scope = scope_;
    const std::string section_name = "objects." + config.name;
    CompiledObject object;
    object.name = config.name;
    object.place = config.place;
    object.count = SectionCompiler(count_scope_, section_name, config.redraw, errors_)
                       .number(config.count, "count");
    object.variables = VariableBlock::compile(config.variables, section_name + ".variables.",
                                              config.redraw, compiled_.values, scope, errors_);
    const SectionCompiler section(scope, section_name, config.redraw, errors_);
    object.asset = section.text(config.asset, "asset");
    if (config.category) object.category = section.text(*config.category, "category");
    object.materials = section.materials(config.material, materials_);
    object.scale = section.number(config.scale, "scale");
    object.rotation_deg = section.vector(config.rotation_deg, "rotation_deg");
    object.position = section.vector(config.position, "position");
    if (config.scatter) object.scatter = compile_scatter(*config.scatter, section);
    object.rest_on_ground = config.rest_on_ground;
    compiled_.objects.push_back(std::move(object));
  }

  static CompiledScatter compile_scatter(const ScatterConfig& config,
                                         const SectionCompiler& section) {
    auto unit = std::make_shared<Distribution>();
    unit->parameters = {number_constant(0.0), number_constant(1.0)};
    const NumberSource anywhere{config.place, unit};
    return {
        {section.number(config.x[0], "scatter.x[0]"), section.number(config.x[1], "scatter.x[1]")},
        {section.number(config.y[0], "scatter.y[0]"), section.number(config.y[1], "scatter.y[1]")},
        section.number(anywhere, "scatter.x"),
        section.number(anywhere, "scatter.y"),
        section.number(config.gap_m, "scatter.gap_m"),
        config.place};
  }

  void compile_light(const LightConfig& config) {
    CompileScope scope = scope_;
    const std::string section_name = "lights." + config.name;
    CompiledLight light;
    light.name = config.name;
    light.place = config.place;
    light.type = config.type;
    light.count = SectionCompiler(count_scope_, section_name, config.redraw, errors_)
                      .number(config.count, "count");
    light.variables = VariableBlock::compile(config.variables, section_name + ".variables.",
                                             config.redraw, compiled_.values, scope, errors_);
    const SectionCompiler section(scope, section_name, config.redraw, errors_);
    light.position = section.vector(config.position, "position");
    light.target = section.vector(config.target, "target");
    light.color = section.color(config.color, "color");
    light.power = section.number(config.power, "power");
    light.radius_m = section.number(config.radius_m, "radius_m");
    light.angle_deg = section.number(config.angle_deg, "angle_deg");
    light.blend = section.number(config.blend, "blend");
    light.width_m = section.number(config.width_m, "width_m");
    light.height_m = section.number(config.height_m, "height_m");
    compiled_.lights.push_back(std::move(light));
  }

  const CampaignConfig& config_;
  const MaterialLibrary& materials_;
  CompiledConfig& compiled_;
  Diagnostics& errors_;
  CompileScope scope_;
  CompileScope count_scope_;  ///< how many copies there are cannot depend on the copy
};

}  // namespace

void compile_config(const CampaignConfig& config, const MaterialLibrary& materials,
                    CompiledConfig& compiled, Diagnostics& errors) {
  Compiler(config, materials, compiled, errors).run();
}

}  // namespace seedframe
