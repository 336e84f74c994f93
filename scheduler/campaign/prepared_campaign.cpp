#include "campaign/prepared_campaign.h"

#include <algorithm>

#include "base/files.h"
#include "config/config_text.h"

namespace seedframe {
namespace fs = std::filesystem;

Result<CampaignSource> read_source(const fs::path& file, const std::vector<Override>& overrides,
                                   const fs::path& home, const std::vector<std::string>& allowed) {
  Result<std::string> text = read_file(file, kLargestConfig);
  if (!text) return fail(ErrorKind::kInput, "{}", text.error().message);
  AllowedFolders folders({file.parent_path(), ".", "/usr/share"});
  for (const std::string& folder : allowed) folders.add(folder);
  return CampaignSource{std::move(*text), file, overrides, home, std::move(folders)};
}

Result<PreparedCampaign> prepare(CampaignSource source) {
  AllowedFolders allowed = source.allowed;
  allowed.add(source.home);
  Result<CampaignConfig> config =
      read_campaign_config(source.text, source.file, source.overrides, allowed);
  if (!config) return forward_error(config);
  std::vector<fs::path> asset_folders = config->asset_folders;
  asset_folders.push_back(source.home / "assets");
  std::vector<fs::path> material_folders = config->material_folders;
  material_folders.push_back(source.home / "materials");
  Result<AssetLibrary> assets = AssetLibrary::open(asset_folders, allowed);
  if (!assets) return forward_error(assets);
  Result<MaterialLibrary> materials =
      MaterialLibrary::open(material_folders, config->materials, allowed);
  if (!materials) return forward_error(materials);
  std::optional<Graphs> graphs;
  if (config->graphs) {
    Result<Graphs> opened = Graphs::open(*config->graphs);
    if (!opened) return forward_error(opened);
    config->scenes = opened->size();
    if (config->frame_count() > kMostFrames) {
      return fail(ErrorKind::kInput,
                  "{} has {} scenes: with {} frames each, the campaign has more "
                  "than {}",
                  config->graphs->string(), config->scenes, config->frames_per_scene, kMostFrames);
    }
    graphs = std::move(*opened);
  }
  Result<SceneExpander> expander =
      SceneExpander::compile(*config, std::move(*assets), std::move(*materials), std::move(graphs));
  if (!expander) return forward_error(expander);
  return PreparedCampaign{std::move(source), std::move(*config), std::move(*expander)};
}

Result<CampaignSize> expand_all(SceneExpander& expander, const ExpansionWishes& wishes,
                                const std::function<Status(const ExpandedFrame&)>& visit) {
  CampaignSize size{expander.frame_count(), SIZE_MAX, 0, 0};
  for (std::int64_t frame = 0; frame < size.frames; ++frame) {
    const Result<ExpandedFrame> expanded = expander.expand(frame, wishes);
    if (!expanded) return forward_error(expanded);
    const std::size_t instances = expanded->spec.instances.size();
    size.least_instances = std::min(size.least_instances, instances);
    size.most_instances = std::max(size.most_instances, instances);
    size.attempts += expanded->attempts;
    if (!visit) continue;
    if (Status visited = visit(*expanded); !visited) return forward_error(visited);
  }
  return size;
}

std::string describe_constraints(const SceneExpander& expander) {
  std::string text;
  for (const ConstraintTally& tally : expander.constraint_tallies()) {
    text +=
        fmt::format("constraint {}: met in {} of {} draws\n", tally.name, tally.met, tally.checked);
  }
  return text;
}

}  // namespace seedframe
