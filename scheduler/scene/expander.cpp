#include "scene/expander.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/nearest_name.h"
#include "base/portable_math.h"
#include "base/sha256.h"
#include "geometry/mesh_buffer.h"
#include "geometry/primitives.h"
#include "scene/compiled_config.h"
#include "scene/placement.h"

namespace seedframe {
namespace {

constexpr int kLargestInstanceId = 32767;  // Blender's limit of pass_index
constexpr int kMostLights = 1024;
constexpr std::uint32_t kPlacementAttempts = 1000;

/// An object in the world, before the camera is known.
struct PlacedInstance {
  InstanceSpec spec;
  Affine world_from_object = Affine::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of its bounding box, world
};

double at_least(const NumberDraw& draw, double least, bool open, const char* what,
                EvaluationContext& context) {
  const double value = draw.evaluate(context);
  if (open ? value > least : value >= least) return value;
  context.report(draw.place(), fmt::format("{} must be {} {}, found {}", what,
                                           open ? "above" : "at least", least, value));
  return least + 1.0;
}

double positive(const NumberDraw& draw, const char* what, EvaluationContext& context) {
  return at_least(draw, 0.0, true, what, context);
}

double not_negative(const NumberDraw& draw, const char* what, EvaluationContext& context) {
  return at_least(draw, 0.0, false, what, context);
}

double within(const NumberDraw& draw, double least, double most, const char* what,
              EvaluationContext& context) {
  const double value = draw.evaluate(context);
  if (value >= least && value <= most) return value;
  context.report(draw.place(),
                 fmt::format("{} must be from {} to {}, found {}", what, least, most, value));
  return least;
}

std::uint32_t copies_of(const NumberDraw& count, int most, EvaluationContext& context) {
  const double value = std::floor(count.evaluate(context) + 0.5);
  if (value >= 0.0 && value <= most) return static_cast<std::uint32_t>(value);
  context.report(count.place(), fmt::format("a count must be from 0 to {}, found {}", most, value));
  return 0;
}

}  // namespace

class SceneExpander::Program {
 public:
  Program(const CampaignConfig& config, AssetLibrary assets, MaterialLibrary materials)
      : config_(config),
        assets_(std::move(assets)),
        materials_(std::move(materials)),
        render_seed_(config.seed, "render.seed") {}

  Status compile();
  Result<ExpandedFrame> expand(std::int64_t frame, bool record_draws);

  std::int64_t frame_count() const { return config_.frame_count(); }

  std::map<std::string, std::shared_ptr<const std::string>> mesh_buffers;
  std::map<std::string, std::filesystem::path> textures;
  std::map<std::string, std::string> asset_hashes;

 private:
  void check_names(const CompiledObject& object, Diagnostics& errors);
  RenderSettings render_settings(const EvaluationContext& context) const;
  void place_ground(FrameSpec& spec, std::vector<PlacedInstance>& placed,
                    EvaluationContext& context);
  void place_object(const CompiledObject& object, FrameSpec& spec,
                    std::vector<PlacedInstance>& placed, EvaluationContext& context);
  void scatter(const CompiledScatter& scatter, double radius, Eigen::Vector3d& position,
               EvaluationContext& context) const;
  int add_material(const CompiledMaterials& materials, FrameSpec& spec, EvaluationContext& context);
  void add_textures(const std::string& set, const Place& place, MaterialSpec& material,
                    EvaluationContext& context);
  int category_index(const CompiledObject& object, const Asset& asset, EvaluationContext& context);
  std::shared_ptr<const Asset> load_asset(const std::string& name, const Place& place,
                                          EvaluationContext& context);
  Affine place_camera(const std::vector<PlacedInstance>& placed, FrameSpec& spec,
                      EvaluationContext& context);
  void add_lights(const Affine& world_from_camera, FrameSpec& spec, EvaluationContext& context);
  LightSpec one_light(const CompiledLight& light, const Affine& world_from_camera,
                      EvaluationContext& context);

  CampaignConfig config_;
  AssetLibrary assets_;
  MaterialLibrary materials_;
  PhiloxStream render_seed_;
  CompiledConfig compiled_;
  std::vector<Footprint> footprints_;  ///< of the frame being expanded
  std::map<std::filesystem::path, std::string> texture_hashes_;
};

Status SceneExpander::Program::compile() {
  Diagnostics errors;
  compile_config(config_, materials_, compiled_, errors);
  for (const CompiledObject& object : compiled_.objects) check_names(object, errors);
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  return {};
}

void SceneExpander::Program::check_names(const CompiledObject& object, Diagnostics& errors) {
  for (const std::string& name :
       object.asset.possible_values().value_or(std::vector<std::string>())) {
    const auto asset = assets_.load(name);
    if (!asset) errors.add(object.asset.place(), asset.error().message);
  }
  if (!object.category) return;
  for (const std::string& name :
       object.category->possible_values().value_or(std::vector<std::string>())) {
    const bool known =
        name == "none" || std::find(config_.categories.begin(), config_.categories.end(), name) !=
                              config_.categories.end();
    if (!known) {
      errors.add(object.category->place(), "'" + name + "' is not among the campaign's categories" +
                                               did_you_mean(name, config_.categories));
    }
  }
}

RenderSettings SceneExpander::Program::render_settings(const EvaluationContext& context) const {
  RenderSettings render;
  render.width = config_.render.width;
  render.height = config_.render.height;
  render.samples = config_.render.samples;
  render.max_bounces = config_.render.max_bounces;
  render.filter_width_px = config_.render.filter_width_px;
  render.clamp_indirect = config_.render.clamp_indirect;
  render.depth = config_.render.depth;
  render.normal = config_.render.normal;
  // Cycles' seed is a signed 32-bit integer.
  render.seed =
      static_cast<std::uint32_t>(render_seed_.bits(context.position(Level::kFrame)) >> 33);
  return render;
}

Result<ExpandedFrame> SceneExpander::Program::expand(std::int64_t frame, bool record_draws) {
  ExpandedFrame result;
  result.scene = frame / config_.frames_per_scene;
  result.view = frame % config_.frames_per_scene;
  EvaluationContext context;
  context.scene = static_cast<std::uint32_t>(result.scene);
  context.frame = static_cast<std::uint32_t>(result.view);
  context.record = record_draws ? &result.draws : nullptr;
  *compiled_.built_in.scene_index = static_cast<double>(result.scene);
  *compiled_.built_in.frame_index = static_cast<double>(result.view);
  compiled_.campaign_variables.evaluate(context);
  compiled_.scene_variables.evaluate(context);
  compiled_.frame_variables.evaluate(context);

  FrameSpec& spec = result.spec;
  spec.render = render_settings(context);
  spec.image = {config_.image.display, config_.image.view, config_.image.look,
                config_.image.exposure_stops, config_.image.gamma};
  spec.world = {compiled_.world_color.evaluate(context),
                not_negative(compiled_.world_strength, "the world's strength", context)};
  footprints_.clear();
  std::vector<PlacedInstance> placed;
  place_ground(spec, placed, context);
  for (const CompiledObject& object : compiled_.objects) {
    place_object(object, spec, placed, context);
    if (context.error) break;
  }
  const Affine world_from_camera = place_camera(placed, spec, context);
  add_lights(world_from_camera, spec, context);
  if (context.error) return tl::unexpected(*context.error);

  for (PlacedInstance& instance : placed) {
    instance.spec.camera_from_object =
        relative_to_camera(world_from_camera, instance.world_from_object);
    if (!instance.spec.camera_from_object.matrix().allFinite()) {
      return fail(ErrorKind::kInput, "{}: the position of '{}' is too large to compute with",
                  config_.name, instance.spec.name);
    }
    spec.instances.push_back(std::move(instance.spec));
  }
  result.id = frame_id(spec);
  return result;
}

void SceneExpander::Program::place_ground(FrameSpec& spec, std::vector<PlacedInstance>& placed,
                                          EvaluationContext& context) {
  if (!compiled_.ground) return;
  const double width = positive(compiled_.ground->width_m, "the ground's width_m", context);
  const double depth = positive(compiled_.ground->depth_m, "the ground's depth_m", context);
  const std::string buffer = mesh_buffer(ground_plane(width, depth));
  PlacedInstance ground;
  ground.spec.name = "ground";
  ground.spec.mesh = sha256_hex(buffer);
  ground.spec.materials = {add_material(compiled_.ground->materials, spec, context)};
  mesh_buffers.try_emplace(ground.spec.mesh, std::make_shared<const std::string>(buffer));
  placed.push_back(std::move(ground));
}

std::shared_ptr<const Asset> SceneExpander::Program::load_asset(const std::string& name,
                                                                const Place& place,
                                                                EvaluationContext& context) {
  auto asset = assets_.load(name);
  if (!asset) {
    context.report(place, asset.error().message);
    return nullptr;
  }
  asset_hashes.try_emplace(name, (*asset)->mesh_sha256);
  // Shares the asset's bytes instead of copying them.
  mesh_buffers.try_emplace((*asset)->buffer_sha256, *asset, &(*asset)->buffer);
  return *asset;
}

int SceneExpander::Program::category_index(const CompiledObject& object, const Asset& asset,
                                           EvaluationContext& context) {
  const std::string name = object.category ? object.category->evaluate(context) : asset.category;
  if (name.empty() || name == "none") return 0;
  const auto found = std::find(config_.categories.begin(), config_.categories.end(), name);
  if (found == config_.categories.end()) {
    context.report(object.category ? object.category->place() : object.place,
                   fmt::format("the category '{}' of asset '{}' is not among the campaign's "
                               "categories; add it there, or set category: none",
                               name, asset.name));
    return 0;
  }
  return static_cast<int>(found - config_.categories.begin()) + 1;
}

void SceneExpander::Program::place_object(const CompiledObject& object, FrameSpec& spec,
                                          std::vector<PlacedInstance>& placed,
                                          EvaluationContext& context) {
  const std::uint32_t copies = copies_of(object.count, kLargestInstanceId, context);
  *compiled_.built_in.copies = copies;
  for (std::uint32_t copy = 0; copy < copies && !context.error; ++copy) {
    context.copy = copy;
    *compiled_.built_in.copy_index = copy;
    object.variables.evaluate(context);
    const auto asset = load_asset(object.asset.evaluate(context), object.asset.place(), context);
    if (!asset) break;
    const Eigen::Matrix3d linear = rotation_and_scale(object.rotation_deg.evaluate(context),
                                                      positive(object.scale, "scale", context));
    Eigen::Vector3d position = object.position.evaluate(context);
    const double radius = footprint_radius(asset->box.low, asset->box.high, linear);
    if (object.scatter) scatter(*object.scatter, radius, position, context);
    footprints_.push_back({position.x(), position.y(), radius});
    if (object.rest_on_ground) position.z() -= asset->lowest_z(linear);

    PlacedInstance instance;
    instance.spec.name = fmt::format("{}/{}", object.name, copy);
    const auto ground_count = static_cast<std::size_t>(compiled_.ground.has_value());
    instance.spec.id = static_cast<int>(placed.size() - ground_count) + 1;
    if (instance.spec.id > kLargestInstanceId) {
      context.report(object.place,
                     fmt::format("a frame can hold at most {} objects", kLargestInstanceId));
    }
    instance.spec.category = category_index(object, *asset, context);
    instance.spec.mesh = asset->buffer_sha256;
    instance.spec.materials.assign(asset->mesh.slot_names.size(),
                                   add_material(object.materials, spec, context));
    instance.world_from_object.linear() = linear;
    instance.world_from_object.translation() = position;
    instance.centre = linear * asset->box.centre() + position;
    placed.push_back(std::move(instance));
  }
  context.copy = kNoIndex;
}

void SceneExpander::Program::scatter(const CompiledScatter& scatter, double radius,
                                     Eigen::Vector3d& position, EvaluationContext& context) const {
  const double gap = not_negative(scatter.gap_m, "gap_m", context);
  const std::array<double, 2> x = {scatter.x[0].evaluate(context), scatter.x[1].evaluate(context)};
  const std::array<double, 2> y = {scatter.y[0].evaluate(context), scatter.y[1].evaluate(context)};
  if (x[0] > x[1] || y[0] > y[1]) {
    context.report(scatter.place, "x and y want [least, most] with least <= most");
    return;
  }
  auto* const record = std::exchange(context.record, nullptr);  // rejected draws would confuse
  const auto draw = [&] {
    position.x() = x[0] + (x[1] - x[0]) * scatter.x_draw.evaluate(context);
    position.y() = y[0] + (y[1] - y[0]) * scatter.y_draw.evaluate(context);
  };
  bool found = false;
  while (!found && context.attempt < kPlacementAttempts) {
    draw();
    found = is_clear({position.x(), position.y(), radius}, footprints_, gap);
    if (!found) ++context.attempt;
  }
  context.record = record;
  if (found && record != nullptr) draw();
  context.attempt = 0;
  if (!found) {
    context.report(scatter.place,
                   fmt::format("no free place was found in {} attempts: enlarge x and y, or lower "
                               "count, scale or gap_m",
                               kPlacementAttempts));
  }
}

int SceneExpander::Program::add_material(const CompiledMaterials& materials, FrameSpec& spec,
                                         EvaluationContext& context) {
  const std::string name = materials.name.evaluate(context);
  const auto found = materials.by_name.find(name);
  if (found == materials.by_name.end()) {
    context.report(materials.name.place(), "there is no material '" + name + "'" +
                                               did_you_mean(name, materials_.material_names()));
    return 0;
  }
  const CompiledMaterial& source = found->second;
  MaterialSpec material;
  material.base_color = source.base_color.evaluate(context);
  material.metallic = within(source.metallic, 0, 1, "metallic", context);
  material.roughness = within(source.roughness, 0, 1, "roughness", context);
  material.specular = within(source.specular, 0, 1, "specular", context);
  material.transmission = within(source.transmission, 0, 1, "transmission", context);
  material.ior = within(source.ior, 1, 5, "ior", context);
  material.clearcoat = within(source.clearcoat, 0, 1, "clearcoat", context);
  material.texture_repeat = positive(source.texture_repeat, "texture_repeat", context);
  if (source.textures) {
    add_textures(source.textures->evaluate(context), source.textures->place(), material, context);
  }
  const auto same = std::find(spec.materials.begin(), spec.materials.end(), material);
  if (same != spec.materials.end()) return static_cast<int>(same - spec.materials.begin());
  spec.materials.push_back(std::move(material));
  return static_cast<int>(spec.materials.size()) - 1;
}

void SceneExpander::Program::add_textures(const std::string& set, const Place& place,
                                          MaterialSpec& material, EvaluationContext& context) {
  const auto found = materials_.texture_sets().find(set);
  if (found == materials_.texture_sets().end()) {
    context.report(place, "there is no texture set '" + set + "'" +
                              did_you_mean(set, materials_.texture_set_names()));
    return;
  }
  for (const auto& [role, file] : found->second.files) {
    auto hash = texture_hashes_.find(file);
    if (hash == texture_hashes_.end()) {
      const Result<std::string> computed = sha256_of_file(file);
      if (!computed) {
        context.report(place, computed.error().message);
        return;
      }
      hash = texture_hashes_.emplace(file, *computed).first;
      textures.try_emplace(*computed, file);
    }
    material.textures[role] = hash->second;
  }
}

Affine SceneExpander::Program::place_camera(const std::vector<PlacedInstance>& placed,
                                            FrameSpec& spec, EvaluationContext& context) {
  const CompiledCamera& camera = compiled_.camera;
  camera.variables.evaluate(context);
  if (camera.focal_px) {
    spec.camera.focal_px = positive(*camera.focal_px, "focal_px", context);
  } else {
    const double fov = within(*camera.fov_deg, 0.01, 179.0, "fov_deg", context);
    spec.camera.focal_px = 0.5 * config_.render.width / portable::tan(0.5 * portable::radians(fov));
  }
  // The sensor is 36 mm wide in Blender, and it clamps a lens below 1 mm without a word.
  if (spec.camera.focal_px < config_.render.width / 36.0) {
    context.report(camera.fov_deg ? camera.fov_deg->place() : camera.focal_px->place(),
                   "the view is too wide: Blender's lenses reach 173.6 degrees (a focal length of "
                   "1/36 of the image's width)");
  }
  spec.camera.clip_start_m = positive(camera.clip_start_m, "clip_start_m", context);
  spec.camera.clip_end_m =
      at_least(camera.clip_end_m, spec.camera.clip_start_m, true, "clip_end_m", context);
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  if (camera.target) {
    target = camera.target->evaluate(context);
  } else {
    int objects = 0;
    for (const PlacedInstance& instance : placed) {
      if (instance.spec.id == 0) continue;
      target += instance.centre;
      ++objects;
    }
    if (objects > 0) target /= objects;
  }
  Eigen::Vector3d position;
  if (camera.position) {
    position = camera.position->evaluate(context);
  } else {
    position = on_shell(target, positive(camera.distance_m, "distance_m", context),
                        camera.azimuth_deg.evaluate(context),
                        within(camera.elevation_deg, -90, 90, "elevation_deg", context));
  }
  if (position == target) {
    context.report(camera.place, "the camera stands where it looks: move position or target");
    return Affine::Identity();
  }
  return looking_at(position, target, camera.roll_deg.evaluate(context));
}

void SceneExpander::Program::add_lights(const Affine& world_from_camera, FrameSpec& spec,
                                        EvaluationContext& context) {
  for (const CompiledLight& light : compiled_.lights) {
    const std::uint32_t copies = copies_of(light.count, kMostLights, context);
    *compiled_.built_in.copies = copies;
    for (std::uint32_t copy = 0; copy < copies && !context.error; ++copy) {
      context.copy = copy;
      *compiled_.built_in.copy_index = copy;
      spec.lights.push_back(one_light(light, world_from_camera, context));
    }
    context.copy = kNoIndex;
  }
}

LightSpec SceneExpander::Program::one_light(const CompiledLight& light,
                                            const Affine& world_from_camera,
                                            EvaluationContext& context) {
  light.variables.evaluate(context);
  LightSpec spec;
  spec.kind = static_cast<LightKind>(light.type);
  const Eigen::Vector3d position = light.position.evaluate(context);
  Eigen::Vector3d target = light.target.evaluate(context);
  if (position == target) target -= Eigen::Vector3d::UnitZ();
  spec.camera_from_light = relative_to_camera(world_from_camera, looking_at(position, target, 0.0));
  spec.color = light.color.evaluate(context);
  spec.power = not_negative(light.power, "power", context);
  if (light.type == LightType::kPoint || light.type == LightType::kSpot) {
    spec.radius_m = not_negative(light.radius_m, "radius_m", context);
  }
  if (light.type == LightType::kSun || light.type == LightType::kSpot) {
    spec.angle_rad = portable::radians(within(light.angle_deg, 0, 180, "angle_deg", context));
  }
  if (light.type == LightType::kSpot) spec.blend = within(light.blend, 0, 1, "blend", context);
  if (light.type == LightType::kArea) {
    spec.width_m = positive(light.width_m, "width_m", context);
    spec.height_m = positive(light.height_m, "height_m", context);
  }
  return spec;
}

SceneExpander::SceneExpander(std::unique_ptr<Program> program) : program_(std::move(program)) {}
SceneExpander::~SceneExpander() = default;
SceneExpander::SceneExpander(SceneExpander&&) noexcept = default;
SceneExpander& SceneExpander::operator=(SceneExpander&&) noexcept = default;

Result<SceneExpander> SceneExpander::compile(const CampaignConfig& config, AssetLibrary assets,
                                             MaterialLibrary materials) {
  auto program = std::make_unique<Program>(config, std::move(assets), std::move(materials));
  if (Status compiled = program->compile(); !compiled) return forward_error(compiled);
  return SceneExpander(std::move(program));
}

Result<ExpandedFrame> SceneExpander::expand(std::int64_t frame, bool record_draws) {
  return program_->expand(frame, record_draws);
}

std::int64_t SceneExpander::frame_count() const { return program_->frame_count(); }

const std::map<std::string, std::shared_ptr<const std::string>>& SceneExpander::mesh_buffers()
    const {
  return program_->mesh_buffers;
}

const std::map<std::string, std::filesystem::path>& SceneExpander::textures() const {
  return program_->textures;
}

const std::map<std::string, std::string>& SceneExpander::asset_hashes() const {
  return program_->asset_hashes;
}

}  // namespace seedframe
