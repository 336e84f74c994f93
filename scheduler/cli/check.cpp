// seedframe check: is this config right? Renders and writes nothing.

#include <memory>

#include <CLI/CLI.hpp>

#include "campaign/prepared_campaign.h"
#include "cli/exit_code.h"
#include "cli/home.h"
#include "cli/verb.h"

namespace seedframe {
namespace {

struct CheckArguments {
  std::string config;
  std::vector<std::string> set;
  bool json = false;
};

struct CampaignSize {
  std::int64_t frames = 0;
  std::size_t least_instances = 0;
  std::size_t most_instances = 0;
};

Result<CampaignSize> measure(SceneExpander& expander) {
  CampaignSize size{expander.frame_count(), SIZE_MAX, 0};
  for (std::int64_t frame = 0; frame < size.frames; ++frame) {
    const Result<ExpandedFrame> expanded = expander.expand(frame);
    if (!expanded) return forward_error(expanded);
    const std::size_t instances = expanded->spec.instances.size();
    size.least_instances = std::min(size.least_instances, instances);
    size.most_instances = std::max(size.most_instances, instances);
  }
  return size;
}

int check(const CheckArguments& arguments) {
  std::vector<Override> overrides;
  for (const std::string& text : arguments.set) {
    Result<Override> change = parse_override(text);
    if (!change) return report(change.error());
    overrides.push_back(std::move(*change));
  }
  Result<CampaignSource> source = read_source(arguments.config, overrides, seedframe_home());
  if (!source) return report(source.error());
  Result<PreparedCampaign> prepared = prepare(std::move(*source));
  if (!prepared) return report(prepared.error());
  const Result<CampaignSize> size = measure(prepared->expander);
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
                                    {"assets", prepared->expander.asset_hashes()}}));
    return kExitOk;
  }
  fmt::print(
      "{} is good: {} scenes × {} frames, {} to {} instances a frame, {} categories, {} assets, {} "
      "textures\n'seedframe submit {}' renders it\n",
      arguments.config, config.scenes, config.frames_per_scene, size->least_instances,
      size->most_instances, config.categories.size(), prepared->expander.asset_hashes().size(),
      prepared->expander.textures().size(), arguments.config);
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
  verb->add_flag("--json", arguments->json, "print what was found as JSON");
  verb->footer("Example: seedframe check configs/parts.yaml");
  verb->callback(
      [arguments, on_selected] { on_selected([arguments] { return check(*arguments); }); });
}

}  // namespace seedframe
