#include "scene/prepared_campaign.h"

#include "base/files.h"
#include "config/campaign_config.h"
#include "config/config_node.h"
#include "config/config_text.h"
#include "config/settings.h"
#include "draws/graphs.h"
#include "scene/material_library.h"

namespace seedframe {
namespace fs = std::filesystem;

Result<std::vector<Override>> read_overrides(const std::vector<std::string>& set) {
  std::vector<Override> overrides;
  for (const std::string& change : set) {
    Result<Override> parsed = parse_override(change);
    if (!parsed) return forward_error(parsed);
    overrides.push_back(std::move(*parsed));
  }
  return overrides;
}

Result<CampaignSource> read_source(const fs::path& file, const std::vector<std::string>& set,
                                   const fs::path& home, const std::vector<std::string>& allowed) {
  Result<std::vector<Override>> overrides = read_overrides(set);
  if (!overrides) return forward_error(overrides);
  Result<std::string> text = read_file(file, kLargestConfig);
  if (!text) return fail(ErrorKind::kInput, "{}", text.error().message);
  AllowedFolders folders({file.parent_path(), ".", "/usr/share"});
  for (const std::string& folder : allowed) folders.add(folder);
  return CampaignSource{std::move(*text), file, std::move(*overrides), home, std::move(folders)};
}

namespace {

/// As YAML, whatever is in it.
std::string quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

Result<CampaignConfig> read_config(const CampaignSource& source, AllowedFolders allowed) {
  std::vector<Override> overrides = source.overrides;
  if (!source.graphs.empty()) {
    allowed.add(source.graphs);
    overrides.push_back({"graphs", quoted(source.graphs.string())});
  }
  Result<CampaignConfig> config =
      read_campaign_config(source.text, source.file, overrides, allowed);
  // That it grows is no change of what frames depend on.
  if (config) std::erase(config->files, source.graphs);
  return config;
}

}  // namespace

Result<PreparedCampaign> prepare(CampaignSource source) {
  AllowedFolders allowed = source.allowed;
  allowed.add(source.home);
  Result<CampaignConfig> config = read_config(source, allowed);
  if (!config) return forward_error(config);
  std::vector<fs::path> asset_folders = config->asset_folders;
  asset_folders.push_back(source.home / "assets");
  std::vector<fs::path> material_folders = config->material_folders;
  material_folders.push_back(source.home / "materials");
  Result<AssetLibrary> assets = AssetLibrary::open(asset_folders, allowed, source.copies);
  if (!assets) return forward_error(assets);
  Result<MaterialLibrary> materials =
      MaterialLibrary::open(material_folders, config->materials, allowed);
  if (!materials) return forward_error(materials);
  std::shared_ptr<const Graphs> graphs;
  if (config->graphs) {
    const bool grows = !source.graphs.empty();
    Result<Graphs> opened =
        Graphs::open(*config->graphs, grows ? Graphs::Kind::kGrowing : Graphs::Kind::kWhole);
    if (!opened) return forward_error(opened);
    config->scenes = opened->size();
    if (config->frame_count() > kMostFrames) {
      return fail(ErrorKind::kInput,
                  "{} has {} scenes: with {} frames each, the campaign has more "
                  "than {}",
                  config->graphs->string(), config->scenes, config->frames_per_scene, kMostFrames);
    }
    graphs = std::make_shared<const Graphs>(std::move(*opened));
  }
  CampaignInputs inputs{config->files, asset_folders};
  inputs.folders.insert(inputs.folders.end(), material_folders.begin(), material_folders.end());
  // Those in folders behind symbolic links too.
  const std::vector<fs::path> images = materials->image_files();
  inputs.files.insert(inputs.files.end(), images.begin(), images.end());
  Result<SceneExpander> expander =
      SceneExpander::compile(*config, std::move(*assets), std::move(*materials), std::move(graphs));
  if (!expander) return forward_error(expander);
  CampaignSettings settings = settings_of(*config);
  settings.input_folders = source.allowed.folders();
  return PreparedCampaign{std::move(source), std::move(settings), std::move(inputs),
                          std::move(*expander)};
}

}  // namespace seedframe
