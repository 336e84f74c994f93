#include "scene/expander.h"

#include <utility>

#include "base/last_made.h"
#include "config/campaign_config.h"
#include "config/settings.h"
#include "draws/graphs.h"
#include "scene/camera_placer.h"
#include "scene/compiled_config.h"
#include "scene/constraints.h"
#include "scene/ground.h"
#include "scene/lighting.h"
#include "scene/object_placer.h"
#include "scene/offered_assets.h"
#include "scene/offered_images.h"
#include "scene/placement.h"
#include "scene/view_window.h"

namespace seedframe {

class SceneExpander::Program {
 public:
  Program(const CampaignConfig& config, AssetLibrary assets, MaterialLibrary materials,
          std::shared_ptr<const Graphs> graphs)
      : config_(config),
        settings_(settings_of(config)),
        graphs_(std::move(graphs)),
        placer_(std::move(assets), config.categories),
        materials_(std::move(materials)),
        render_seed_(config.draw_seed(), "render.seed") {}

  Status compile();
  using Given = std::shared_ptr<const Graph>;

  /// `given`: null, what the graphs give.
  Result<ExpandedFrame> expand(std::int64_t frame, const ExpansionWishes& wishes,
                               Given given = nullptr) const;
  const GraphVariables& variables() const { return compiled_.variables.graph_variables; }

  std::int64_t frame_count() const { return config_.frame_count(); }
  std::shared_ptr<const RenderChoices> choices;  ///< null: everything is as the config says
  const std::vector<CompiledConstraint>& constraints() const { return compiled_.constraints; }
  Result<std::vector<OfferedAsset>> offered() const {
    return seedframe::offered_assets(compiled_.objects, placer_.assets(), config_.categories);
  }
  std::vector<OfferedImage> offered_images() const {
    return seedframe::offered_images(compiled_, materials_.library(), placer_.assets());
  }
  const AllowedFolders& allowed() const { return materials_.library().allowed(); }

 private:
  void apply_choice(std::int64_t frame, RenderSettings& render) const;
  RenderSettings render_settings(const EvaluationContext& context) const;
  /// Before anything is evaluated.
  EvaluationContext context_of(std::int64_t scene, std::int64_t view, const Given& given) const;
  void set_sweep(std::int64_t combination, VariableValues& values) const;
  void add_sweep(const VariableValues& values, Json& graph) const;
  /// Nothing without graphs.
  Result<Given> given_for(std::int64_t scene) const;
  void evaluate_variables(EvaluationContext& context) const;
  /// One attempt at the frame; `used` is what those before used.
  FrameDraft draft_frame(UsedFiles used, EvaluationContext& context) const;
  void check_cut_outs(FrameSpec& spec, EvaluationContext& context) const;

  CampaignConfig config_;
  CampaignSettings settings_;
  std::shared_ptr<const Graphs> graphs_;  ///< null: every variable is drawn
  ObjectPlacer placer_;
  MaterialPicker materials_;
  PhiloxStream render_seed_;
  CompiledConfig compiled_;
  // These keep what the next frame may want again, whichever thread expands it.
  mutable LastMade<std::int64_t, Graph> graph_;  ///< by scene
  mutable GroundMaker ground_;
  std::unique_ptr<ConstraintChecker> checker_;
  std::optional<PatchWindow> patches_;
};

Status SceneExpander::Program::compile() {
  Diagnostics errors;
  compile_config(config_, materials_.library(), compiled_, errors);
  for (const CompiledObject& object : compiled_.objects) placer_.check_names(object, errors);
  if (!errors.empty()) return tl::unexpected(errors.as_error());
  checker_ = std::make_unique<ConstraintChecker>(compiled_.constraints);
  if (config_.patches) patches_.emplace(*config_.patches, config_.draw_seed());
  return {};
}

RenderSettings SceneExpander::Program::render_settings(const EvaluationContext& context) const {
  RenderSettings render = settings_.render;
  render.width = config_.render.width;  // of the whole image, if patches are cut out of it
  render.height = config_.render.height;
  render.seed = render_seed_.cycles_seed(context.position(Level::kFrame));
  return render;
}

void SceneExpander::Program::apply_choice(std::int64_t frame, RenderSettings& render) const {
  const auto found = choices->find(frame);
  if (found == choices->end()) return;
  render.samples = found->second.samples;
  render.adaptive = found->second.adaptive;
  render.denoise = found->second.denoise;
}

void SceneExpander::Program::set_sweep(std::int64_t combination, VariableValues& values) const {
  std::vector<std::size_t> indices(config_.sweep.axes.size());
  for (std::size_t i = indices.size(); i-- > 0;) {  // the last axis fastest
    const auto points = static_cast<std::int64_t>(config_.sweep.axes[i].points.size());
    indices[i] = static_cast<std::size_t>(combination % points);
    combination /= points;
  }
  for (const CompiledSweep::Variable& variable : compiled_.sweep.variables) {
    const auto& value =
        config_.sweep.axes[variable.axis].points[indices[variable.axis]].at(variable.name);
    if (variable.is_text) {
      values.texts[variable.slot] = std::get<std::string>(value);
    } else {
      values.numbers[variable.slot] = std::get<double>(value);
    }
  }
}

void SceneExpander::Program::add_sweep(const VariableValues& values, Json& graph) const {
  for (const CompiledSweep::Variable& variable : compiled_.sweep.variables) {
    if (variable.is_text) {
      graph[variable.name] = values.texts[variable.slot];
    } else {
      graph[variable.name] = values.numbers[variable.slot];
    }
  }
}

Result<SceneExpander::Program::Given> SceneExpander::Program::given_for(std::int64_t scene) const {
  if (graphs_ == nullptr) return nullptr;
  Given given = graph_.find(scene);
  if (given != nullptr) return given;
  Result<Graph> read = graphs_->read(scene, compiled_.variables.graph_variables);
  if (!read) return forward_error(read);
  given = std::make_shared<const Graph>(std::move(*read));
  graph_.keep(scene, given);
  return given;
}

EvaluationContext SceneExpander::Program::context_of(std::int64_t scene, std::int64_t view,
                                                     const Given& given) const {
  if (given && given->scene) scene = *given->scene;
  const std::int64_t combinations = config_.sweep.size();
  EvaluationContext context;
  context.scene = static_cast<std::uint32_t>(scene);
  context.frame = static_cast<std::uint32_t>(view);
  context.frames_per_scene = static_cast<std::uint32_t>(config_.frames_per_scene);
  context.draw_scene =
      static_cast<std::uint32_t>(config_.sweep.hold_draws ? scene / combinations : scene);
  context.values = compiled_.variables.blank_values();
  set_sweep(scene % combinations, context.values);
  if (given) context.given = {given, &given->values};
  return context;
}

void SceneExpander::Program::evaluate_variables(EvaluationContext& context) const {
  context.values.numbers[compiled_.built_in.scene_index] = static_cast<double>(context.scene);
  context.values.numbers[compiled_.built_in.frame_index] = static_cast<double>(context.frame);
  if (context.graph != nullptr) add_sweep(context.values, *context.graph);
  compiled_.campaign_variables.evaluate(context);
  compiled_.scene_variables.evaluate(context);
  compiled_.frame_variables.evaluate(context);
}

/// The twin sees triangles only: not the holes that a texture cuts.
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

FrameDraft SceneExpander::Program::draft_frame(UsedFiles used, EvaluationContext& context) const {
  FrameDraft draft;
  draft.used = std::move(used);
  FrameSpec& spec = draft.spec;
  evaluate_variables(context);
  spec.render = render_settings(context);
  spec.image = settings_.image;
  spec.labels.source = settings_.labels;
  if (compiled_.ground) ground_.add(*compiled_.ground, materials_, draft, context);
  placer_.place_all(compiled_, materials_, draft, context);
  lower_flush_ground(draft);
  const Affine world_from_camera = place_camera(compiled_, draft, context);
  draft.world_from_camera = world_from_camera;
  set_sensor(compiled_.sensor, spec, context);
  add_lights(compiled_, world_from_camera, draft, context);
  set_world(compiled_.world, world_from_camera, materials_, draft, context);
  check_cut_outs(spec, context);
  std::string infinite = non_finite_part(spec);
  for (PlacedInstance& instance : draft.placed) {
    instance.spec.camera_from_object =
        relative_to_camera(world_from_camera, instance.world_from_object);
    if (!instance.spec.camera_from_object.matrix().allFinite()) {
      infinite = "the position of '" + instance.spec.name + "'";
    }
  }
  if (!infinite.empty()) {
    context.report(Place{config_.camera.place.file, 0, 0, ""},
                   infinite + " has a number that is too large to compute with");
  }
  return draft;
}

Result<ExpandedFrame> SceneExpander::Program::expand(std::int64_t frame,
                                                     const ExpansionWishes& wishes,
                                                     Given given) const {
  ExpandedFrame result;
  result.scene = frame / config_.frames_per_scene;
  result.view = frame % config_.frames_per_scene;
  result.constraints.resize(compiled_.constraints.size());
  if (given == nullptr) {
    Result<Given> read = given_for(result.scene);
    if (!read) return forward_error(read);
    given = std::move(*read);
  }
  EvaluationContext context = context_of(result.scene, result.view, given);
  const CompiledConstraint* unmet = nullptr;
  std::vector<std::size_t> seen;  ///< may be cut out as patches
  FrameDraft draft;
  const auto most = static_cast<std::uint32_t>(config_.max_attempts);
  for (; context.frame_attempt < most; ++context.frame_attempt) {
    do {
      result.draws.clear();
      context.record = wishes.draws ? &result.draws : nullptr;
      result.graph = wishes.graph ? Json::object() : Json();
      context.graph = wishes.graph ? &result.graph : nullptr;
      draft = draft_frame(std::move(draft.used), context);
    } while (context.take_next_layout());
    if (context.crowded == Level::kFrame && context.frame_attempt + 1 < most) {
      context.forget_error();
      continue;
    }
    if (context.error) return tl::unexpected(*context.error);
    unmet = checker_->first_unmet(draft, context, result.constraints);
    if (context.error) return tl::unexpected(*context.error);
    if (unmet != nullptr) continue;
    if (!patches_) break;
    seen = checker_->seen(draft, config_.patches->least_visible);
    if (!seen.empty()) break;
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
  if (patches_ && seen.empty()) {
    context.report(
        config_.patches->place,
        fmt::format("no object of this frame shows {} of its silhouette or more, in any of "
                    "{} attempts: lower least_visible, or let the camera see objects",
                    config_.patches->least_visible, most));
    return tl::unexpected(*context.error);
  }
  if (patches_) patches_->cut(draft, patches_->choose(draft, seen, context));
  if (config_.render.region.of_objects) draft.spec.render.region = region_of_objects(draft);
  placer_.choose_levels(draft, context);
  if (context.error) return tl::unexpected(*context.error);
  result.attempts = context.frame_attempt + 1;
  result.world_from_camera = draft.world_from_camera;
  result.spec = std::move(draft.spec);
  result.used = std::move(draft.used);
  result.spec.instances.reserve(draft.placed.size());
  for (PlacedInstance& instance : draft.placed) {
    result.meshes.try_emplace(instance.spec.mesh, std::move(instance.buffer));
    result.spec.instances.push_back(std::move(instance.spec));
  }
  if (choices) apply_choice(frame, result.spec.render);
  if (given) {
    if (Status applied = apply(given->rendering, result.spec.render); !applied) {
      context.report_frame(applied.error().message);
      return tl::unexpected(*context.error);
    }
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
                                             std::shared_ptr<const Graphs> graphs) {
  auto program =
      std::make_unique<Program>(config, std::move(assets), std::move(materials), std::move(graphs));
  if (Status compiled = program->compile(); !compiled) return forward_error(compiled);
  return SceneExpander(std::move(program));
}

Result<ExpandedFrame> SceneExpander::expand(std::int64_t frame,
                                            const ExpansionWishes& wishes) const {
  return program_->expand(frame, wishes);
}

Result<ExpandedFrame> SceneExpander::expand_given(std::int64_t scene, const Json& values,
                                                  const RenderingWish& rendering,
                                                  const std::string& where,
                                                  const ExpansionWishes& wishes) const {
  Result<std::vector<GivenValues>> given = read_values(values, variables(), where);
  if (!given) return forward_error(given);
  return program_->expand(scene, wishes,
                          std::make_shared<const Graph>(Graph{std::move(*given), {}, rendering}));
}

const GraphVariables& SceneExpander::variables() const { return program_->variables(); }

void SceneExpander::set_choices(std::shared_ptr<const RenderChoices> choices) {
  program_->choices = std::move(choices);
}

const std::shared_ptr<const RenderChoices>& SceneExpander::choices() const {
  return program_->choices;
}

std::int64_t SceneExpander::frame_count() const { return program_->frame_count(); }

Result<std::vector<OfferedAsset>> SceneExpander::offered_assets() const {
  return program_->offered();
}

std::vector<OfferedImage> SceneExpander::offered_images() const {
  return program_->offered_images();
}

const AllowedFolders& SceneExpander::allowed_folders() const { return program_->allowed(); }

std::vector<std::string> SceneExpander::constraint_names() const {
  std::vector<std::string> names;
  for (const CompiledConstraint& constraint : program_->constraints()) {
    names.push_back(constraint.name);
  }
  return names;
}

}  // namespace seedframe
