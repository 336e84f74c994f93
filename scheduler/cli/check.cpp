// seedframe check: is this config right? Renders and writes nothing.

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include <CLI/CLI.hpp>

#include "campaign/input_images.h"
#include "campaign/provenance.h"
#include "campaign/run_setup.h"
#include "cli/verb.h"
#include "console/arguments.h"
#include "console/blender_option.h"
#include "console/exit_code.h"
#include "console/home.h"
#include "console/say.h"
#include "report/scene_survey.h"
#include "report/variable_description.h"
#include "scene/expansion_summary.h"
#include "scene/prepared_campaign.h"

namespace seedframe {
namespace {

struct CheckArguments {
  std::string config;
  std::vector<std::string> set;
  std::vector<std::string> allowed;
  std::string graphs;
  std::string blender;
  bool json = false;
  bool describe = false;
};

/// Expands all frames; with a file to write to, their variables go there as JSON lines.
Result<ExpansionSummary> check_frames(const SceneExpander& expander, const std::string& graphs) {
  if (graphs.empty()) return expand_all(expander, {.id = false});
  std::ofstream out(graphs);
  const auto visit = [&](const ExpandedFrame& frame) -> Status {
    out << canonical_json(frame.graph) << '\n';
    if (out) return {};
    return fail(ErrorKind::kInput, "cannot write {}: {}", graphs, std::strerror(errno));
  };
  Result<ExpansionSummary> summary = expand_all(expander, {.id = false, .graph = true}, visit);
  out.flush();
  if (summary && !out) return fail(ErrorKind::kInput, "cannot write {}", graphs);
  return summary;
}

Json constraints_json(const std::vector<std::string>& names,
                      const std::vector<ConstraintTally>& tallies) {
  Json constraints = Json::object();
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    constraints[names[i]] = {{"checked", tallies[i].checked}, {"met", tallies[i].met}};
  }
  return constraints;
}

/// Of the Blender that would render. Without one, which is no mistake of the config, nothing is
/// said.
Status check_colors(const CampaignSettings& settings, const std::string& blender) {
  const bool asked = !settings.image_place.file.empty();
  if (!asked || settings.labels != LabelSource::kIndexPass) return {};
  const std::unique_ptr<FrameCache> cache = FrameCache::open(cache_folder());
  const Result<Renderer> renderer = find_renderer(blender, &settings, cache.get());
  if (!renderer && renderer.error().kind == ErrorKind::kEnvironment) return {};
  if (!renderer) return forward_error(renderer);
  return check_view(settings, *renderer->color);
}

int check(const CheckArguments& arguments) {
  Result<CampaignSource> source = read_source(arguments.config, arguments.set, seedframe_home(),
                                              with_own_assets(arguments.allowed));
  if (!source) return report(source.error());
  Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (!prepared) return report(prepared.error());
  if (arguments.describe) {
    const Result<Json> variables = describe_variables(prepared->expander);
    if (!variables) return report(variables.error());
    fmt::print("{}", readable_json({{"name", prepared->settings.name}, {"variables", *variables}}));
    return kExitOk;
  }
  if (Status good = check_input_images(*prepared, cache_folder()); !good) {
    return report(good.error());
  }
  if (Status good = check_colors(prepared->settings, arguments.blender); !good) {
    return report(good.error());
  }
  const Result<ExpansionSummary> summary = check_frames(prepared->expander, arguments.graphs);
  if (!summary) return report(summary.error());
  const CampaignSettings& settings = prepared->settings;
  const Result<SceneSurvey> survey = survey_scenes(prepared->expander, settings.categories);
  if (!survey) return report(survey.error());
  if (arguments.json) {
    fmt::print(
        "{}", readable_json({{"name", settings.name},
                             {"seed", settings.seed},
                             {"scenes", settings.scenes},
                             {"frames", summary->frames},
                             {"categories", settings.categories},
                             {"least_instances", summary->least_instances},
                             {"most_instances", summary->most_instances},
                             {"attempts", summary->attempts},
                             {"constraints", constraints_json(prepared->expander.constraint_names(),
                                                              summary->constraints)},
                             {"assets", asset_hashes(summary->used)},
                             {"looked_at", survey->frames},
                             {"warnings", survey->warnings}}));
    return kExitOk;
  }
  say("{} is good: {} scenes × {} frames, {} to {} instances a frame, {} categories, {} assets, {} "
      "images\n'seedframe submit {}' renders it\n",
      arguments.config, settings.scenes, settings.frames_per_scene, summary->least_instances,
      summary->most_instances, settings.categories.size(), summary->used.assets.size(),
      summary->used.images.size(), arguments.config);
  say("{}", describe_constraints(prepared->expander, summary->constraints));
  say("looked at {} of {} frames, {} × {} pixels: {}\n", survey->frames.size(), summary->frames,
      survey->width, survey->height, survey->warnings.empty() ? "nothing to warn of" : "");
  for (const std::string& warning : survey->warnings) {
    say("  warning: {}\n", printable(warning));
  }
  return kExitOk;
}

}  // namespace

void add_check_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* verb = app.add_subcommand(
      "check",
      "validate a config, expand all its frames, and look at some: renders and writes nothing");
  verb->add_option("CONFIG", arguments->config, "campaign config (docs/config.md)")->required();
  verb->add_option("--set", arguments->set, "path=value: replaces a value of the config")
      ->allow_extra_args(false);
  add_allow_option(*verb, arguments->allowed);
  add_blender_option(*verb, arguments->blender);
  verb->add_option(
          "--graphs", arguments->graphs,
          "write each frame's variables to this file, as JSON lines (docs/formats/graphs.md)")
      ->type_name("FILE");
  verb->add_flag("--describe", arguments->describe,
                 "only print the variables that can be set from outside, as JSON: type, unit, "
                 "range, distribution, and value in the first frame");
  verb->add_flag("--json", arguments->json, "print what was found as JSON");
  verb->footer("Example: seedframe check configs/parts.yaml");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return check(*arguments); }); });
}

}  // namespace seedframe
