#include "campaign/prepared_campaign.h"

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;

Result<CampaignSource> read_source(const fs::path& file, const std::vector<Override>& overrides,
                                   const fs::path& home) {
  Result<std::string> text = read_file(file);
  if (!text) return fail(ErrorKind::kInput, "{}", text.error().message);
  constexpr std::size_t kLargestConfig = 16u << 20;
  if (text->size() > kLargestConfig) {
    return fail(ErrorKind::kInput, "{} has {} bytes; a config may have {}", file.string(),
                text->size(), kLargestConfig);
  }
  return CampaignSource{std::move(*text), file, overrides, home};
}

Result<PreparedCampaign> prepare(CampaignSource source) {
  Result<CampaignConfig> config = read_campaign_config(source.text, source.file, source.overrides);
  if (!config) return forward_error(config);
  std::vector<fs::path> asset_folders = config->asset_folders;
  asset_folders.push_back(source.home / "assets");
  std::vector<fs::path> material_folders = config->material_folders;
  material_folders.push_back(source.home / "materials");
  Result<AssetLibrary> assets = AssetLibrary::open(asset_folders);
  if (!assets) return forward_error(assets);
  Result<MaterialLibrary> materials = MaterialLibrary::open(material_folders, config->materials);
  if (!materials) return forward_error(materials);
  Result<SceneExpander> expander =
      SceneExpander::compile(*config, std::move(*assets), std::move(*materials));
  if (!expander) return forward_error(expander);
  return PreparedCampaign{std::move(source), std::move(*config), std::move(*expander)};
}

Result<std::vector<FrameIdentity>> expand_all(SceneExpander& expander) {
  std::vector<FrameIdentity> frames;
  frames.reserve(static_cast<std::size_t>(expander.frame_count()));
  for (std::int64_t frame = 0; frame < expander.frame_count(); ++frame) {
    const Result<ExpandedFrame> expanded = expander.expand(frame);
    if (!expanded) return forward_error(expanded);
    frames.push_back({expanded->scene, expanded->id});
  }
  return frames;
}

}  // namespace seedframe
