// seedframe check: is this config right? Renders and writes nothing.

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>

#include <CLI/CLI.hpp>

#include "campaign/input_images.h"
#include "campaign/prepared_campaign.h"
#include "cli/allow_option.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/verb.h"

namespace seedframe {
namespace {

struct CheckArguments {
  std::string config;
  std::vector<std::string> set;
  std::vector<std::string> allowed;
  std::string graphs;
  bool json = false;
};

/// Expands all frames; with a file to write to, their variables go there as JSON lines.
Result<CampaignSize> check_frames(SceneExpander& expander, const std::string& graphs) {
  if (graphs.empty()) return expand_all(expander, {.id = false});
  std::ofstream out(graphs);
  const auto visit = [&](const ExpandedFrame& frame) -> Status {
    out << canonical_json(frame.graph) << '\n';
    if (out) return {};
    return fail(ErrorKind::kInput, "cannot write {}: {}", graphs, std::strerror(errno));
  };
  Result<CampaignSize> size = expand_all(expander, {.id = false, .graph = true}, visit);
  out.flush();
  if (size && !out) return fail(ErrorKind::kInput, "cannot write {}", graphs);
  return size;
}

Json constraints_json(const SceneExpander& expander) {
  Json constraints = Json::object();
  for (const ConstraintTally& tally : expander.constraint_tallies()) {
    constraints[tally.name] = {{"checked", tally.checked}, {"met", tally.met}};
  }
  return constraints;
}

int check(const CheckArguments& arguments) {
  std::vector<Override> overrides;
  for (const std::string& text : arguments.set) {
    Result<Override> change = parse_override(text);
    if (!change) return report(change.error());
    overrides.push_back(std::move(*change));
  }
  Result<CampaignSource> source =
      read_source(arguments.config, overrides, seedframe_home(), arguments.allowed);
  if (!source) return report(source.error());
  Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (!prepared) return report(prepared.error());
  if (Status good = check_input_images(*prepared, cache_folder()); !good) {
    return report(good.error());
  }
  const Result<CampaignSize> size = check_frames(prepared->expander, arguments.graphs);
  if (!size) return report(size.error());
  const CampaignConfig& config = prepared->config;
  if (arguments.json) {
    fmt::print("{}", readable_json({{"name", config.name},
                                    {"seed", config.seed},
                                    {"scenes", config.scenes},
                                    {"frames", size->frames},
                                    {"categories", config.categories},
                                    {"least_instances", size->least_instances},
                                    {"most_instances", size->most_instances},
                                    {"attempts", size->attempts},
                                    {"constraints", constraints_json(prepared->expander)},
                                    {"assets", prepared->expander.asset_hashes()}}));
    return kExitOk;
  }
  fmt::print(
      "{} is good: {} scenes × {} frames, {} to {} instances a frame, {} categories, {} assets, {} "
      "images\n'seedframe submit {}' renders it\n",
      arguments.config, config.scenes, config.frames_per_scene, size->least_instances,
      size->most_instances, config.categories.size(), prepared->expander.asset_hashes().size(),
      prepared->expander.image_files().size(), arguments.config);
  fmt::print("{}", describe_constraints(prepared->expander));
  return kExitOk;
}

}  // namespace

void add_check_verb(CLI::App& app, const OnSelected& on_selected) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* verb = app.add_subcommand(
      "check", "validate a config and expand all its frames, without rendering or writing");
  verb->add_option("CONFIG", arguments->config, "campaign config (docs/config.md)")->required();
  verb->add_option("--set", arguments->set, "path=value: replaces a value of the config")
      ->allow_extra_args(false);
  add_allow_option(*verb, arguments->allowed);
  verb->add_option(
          "--graphs", arguments->graphs,
          "write each frame's variables to this file, as JSON lines (docs/formats/graphs.md)")
      ->type_name("FILE");
  verb->add_flag("--json", arguments->json, "print what was found as JSON");
  verb->footer("Example: seedframe check configs/parts.yaml");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return check(*arguments); }); });
}

}  // namespace seedframe
