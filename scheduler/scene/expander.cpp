#include "scene/expander.h"

#include <utility>

#include "scene/camera_placer.h"
#include "scene/compiled_config.h"
#include "scene/ground.h"
#include "scene/lighting.h"
#include "scene/object_placer.h"
#include "scene/placement.h"

namespace seedframe {

class SceneExpander::Program {
 public:
  Program(const CampaignConfig& config, AssetLibrary assets, MaterialLibrary materials,
          std::optional<Graphs> graphs)
      : config_(config),
        graphs_(std::move(graphs)),
        placer_(std::move(assets), config.categories),
        materials_(std::move(materials)),
        render_seed_(config.seed, "render.seed") {}

  Status compile();
  Result<ExpandedFrame> expand(std::int64_t frame, const ExpansionWishes& wishes);

  std::int64_t frame_count() const { return config_.frame_count(); }
  const ObjectPlacer& placer() const { return placer_; }
  const MaterialPicker& materials() const { return materials_; }
  const std::vector<ConstraintTally>& tallies() const { return checker_->tallies(); }
  Result<std::vector<OfferedAsset>> offered() const {
    return seedframe::offered_assets(compiled_.objects, placer_.assets(), config_.categories);
  }
  std::vector<OfferedImage> offered_images() const {
    return seedframe::offered_images(compiled_, materials_.library());
  }

 private:
  RenderSettings render_settings(const EvaluationContext& context) const;
  void set_sweep(std::int64_t combination);
  void evaluate_variables(EvaluationContext& context);
  /// One attempt at the frame.
  FrameDraft draft_frame(EvaluationContext& context);
  void check_cut_outs(FrameSpec& spec, EvaluationContext& context) const;

  CampaignConfig config_;
  std::optional<Graphs> graphs_;
  std::int64_t graph_line_ = -1;  ///< the one that the variables have now
  ObjectPlacer placer_;
  MaterialPicker materials_;
  GroundMaker ground_;
  PhiloxStream render_seed_;
  CompiledConfig compiled_;
  std::unique_ptr<ConstraintChecker> checker_;
};

Status SceneExpander::Program::compile() {
  Diagnostics errors;
  compile_config(config_, materials_.library(), compiled_, errors);
  for (const CompiledObject& object : compiled_.objects) placer_.check_names(object, errors);
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  checker_ = std::make_unique<ConstraintChecker>(compiled_.constraints);
  return {};
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

void SceneExpander::Program::set_sweep(std::int64_t combination) {
  std::vector<std::size_t> indices(config_.sweep.axes.size());
  for (std::size_t i = indices.size(); i-- > 0;) {  // the last axis fastest
    const auto points = static_cast<std::int64_t>(config_.sweep.axes[i].points.size());
    indices[i] = static_cast<std::size_t>(combination % points);
    combination /= points;
  }
  for (const CompiledSweep::Variable& variable : compiled_.sweep.variables) {
    const auto& value =
        config_.sweep.axes[variable.axis].points[indices[variable.axis]].at(variable.name);
    if (variable.number != nullptr) {
      *variable.number = std::get<double>(value);
    } else {
      *variable.text = std::get<std::string>(value);
    }
  }
}

void SceneExpander::Program::evaluate_variables(EvaluationContext& context) {
  *compiled_.built_in.scene_index = static_cast<double>(context.scene);
  *compiled_.built_in.frame_index = static_cast<double>(context.frame);
  compiled_.campaign_variables.evaluate(context);
  compiled_.scene_variables.evaluate(context);
  compiled_.frame_variables.evaluate(context);
}

/// A texture that cuts holes is beyond the twin, which knows triangles only.
void SceneExpander::Program::check_cut_outs(FrameSpec& spec, EvaluationContext& context) const {
  const auto cut_out = std::find_if(
      spec.materials.begin(), spec.materials.end(),
      [](const MaterialSpec& material) { return material.textures.contains("alpha"); });
  if (cut_out == spec.materials.end()) return;
  spec.labels.twin_exact = false;
  if (spec.labels.source == LabelSource::kTwin) {
    context.report(config_.labels.place,
                   "a material of this frame has an opacity texture, whose holes only the renderer "
                   "sees: use 'labels: render', or a material without such a texture");
  }
}

FrameDraft SceneExpander::Program::draft_frame(EvaluationContext& context) {
  FrameDraft draft;
  FrameSpec& spec = draft.spec;
  evaluate_variables(context);
  spec.render = render_settings(context);
  spec.image = config_.image.settings;
  spec.labels.source = config_.labels.source;
  if (compiled_.ground) ground_.add(*compiled_.ground, materials_, draft, context);
  placer_.place_all(compiled_, materials_, draft, context);
  const Affine world_from_camera = place_camera(compiled_, draft, context);
  add_lights(compiled_, world_from_camera, draft, context);
  set_world(compiled_.world, world_from_camera, materials_, draft, context);
  check_cut_outs(spec, context);
  std::string beyond = non_finite_part(spec);
  for (PlacedInstance& instance : draft.placed) {
    instance.spec.camera_from_object =
        relative_to_camera(world_from_camera, instance.world_from_object);
    if (!instance.spec.camera_from_object.matrix().allFinite()) {
      beyond = "the position of '" + instance.spec.name + "'";
    }
  }
  if (!beyond.empty()) {
    context.report(Place{config_.camera.place.file, 0, 0, ""},
                   beyond + " has a number that is too large to compute with");
  }
  return draft;
}

Result<ExpandedFrame> SceneExpander::Program::expand(std::int64_t frame,
                                                     const ExpansionWishes& wishes) {
  ExpandedFrame result;
  result.scene = frame / config_.frames_per_scene;
  result.view = frame % config_.frames_per_scene;
  const std::int64_t combinations = config_.sweep.size();
  EvaluationContext context;
  context.scene = static_cast<std::uint32_t>(result.scene);
  context.frame = static_cast<std::uint32_t>(result.view);
  context.frames_per_scene = static_cast<std::uint32_t>(config_.frames_per_scene);
  context.draw_scene = static_cast<std::uint32_t>(
      config_.sweep.hold_draws ? result.scene / combinations : result.scene);
  set_sweep(result.scene % combinations);
  if (graphs_ && graph_line_ != result.scene) {
    graph_line_ = -1;  // should this line be wrong, none is in force
    if (Status applied = graphs_->apply(result.scene, compiled_.graph_variables); !applied) {
      return forward_error(applied);
    }
    graph_line_ = result.scene;
  }
  const CompiledConstraint* unmet = nullptr;
  std::optional<FrameDraft> draft;
  const auto most = static_cast<std::uint32_t>(config_.max_attempts);
  for (; context.frame_attempt < most; ++context.frame_attempt) {
    result.draws.clear();
    context.record = wishes.draws ? &result.draws : nullptr;
    result.graph = wishes.graph ? Json::object() : Json();
    context.graph = wishes.graph ? &result.graph : nullptr;
    draft = draft_frame(context);
    if (context.error) return tl::unexpected(*context.error);
    unmet = checker_->first_unmet(*draft, context);
    if (context.error) return tl::unexpected(*context.error);
    if (unmet == nullptr) break;
  }
  if (unmet != nullptr) {
    context.report(unmet->place,
                   fmt::format("no draw of this frame met all constraints in {} attempts; in the "
                               "last one '{}' was not met. Loosen it, widen what is drawn for each "
                               "frame (only frame-level draws are made again), or raise "
                               "max_attempts",
                               most, unmet->name));
    return tl::unexpected(*context.error);
  }
  placer_.choose_levels(*draft, context);
  if (context.error) return tl::unexpected(*context.error);
  result.attempts = context.frame_attempt + 1;
  result.spec = std::move(draft->spec);
  result.ground_buffer = draft->ground_buffer;
  result.spec.instances.reserve(draft->placed.size());
  for (PlacedInstance& instance : draft->placed) {
    result.spec.instances.push_back(std::move(instance.spec));
  }
  if (wishes.id) result.id = frame_id(result.spec);
  return result;
}

SceneExpander::SceneExpander(std::unique_ptr<Program> program) : program_(std::move(program)) {}
SceneExpander::~SceneExpander() = default;
SceneExpander::SceneExpander(SceneExpander&&) noexcept = default;
SceneExpander& SceneExpander::operator=(SceneExpander&&) noexcept = default;

Result<SceneExpander> SceneExpander::compile(const CampaignConfig& config, AssetLibrary assets,
                                             MaterialLibrary materials,
                                             std::optional<Graphs> graphs) {
  auto program =
      std::make_unique<Program>(config, std::move(assets), std::move(materials), std::move(graphs));
  if (Status compiled = program->compile(); !compiled) return forward_error(compiled);
  return SceneExpander(std::move(program));
}

Result<ExpandedFrame> SceneExpander::expand(std::int64_t frame, const ExpansionWishes& wishes) {
  return program_->expand(frame, wishes);
}

std::int64_t SceneExpander::frame_count() const { return program_->frame_count(); }

const MeshBuffers& SceneExpander::mesh_buffers() const { return program_->placer().mesh_buffers(); }

MeshBuffers SceneExpander::mesh_buffers_of(const ExpandedFrame& frame) const {
  MeshBuffers buffers;
  for (const InstanceSpec& instance : frame.spec.instances) {
    const auto known = mesh_buffers().find(instance.mesh);
    buffers[instance.mesh] = known != mesh_buffers().end() ? known->second : frame.ground_buffer;
  }
  return buffers;
}

const std::map<std::string, std::filesystem::path>& SceneExpander::image_files() const {
  return program_->materials().files();
}

const std::map<std::string, std::string>& SceneExpander::asset_hashes() const {
  return program_->placer().asset_hashes();
}

Result<std::vector<OfferedAsset>> SceneExpander::offered_assets() const {
  return program_->offered();
}

std::vector<OfferedImage> SceneExpander::offered_images() const {
  return program_->offered_images();
}

const MaterialLibrary& SceneExpander::material_library() const {
  return program_->materials().library();
}

const std::vector<ConstraintTally>& SceneExpander::constraint_tallies() const {
  return program_->tallies();
}

}  // namespace seedframe
