#include "export/kept_inputs.h"

#include "assets/asset_files.h"
#include "base/canonical_json.h"
#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kInputsVersion = 1;
constexpr std::size_t kMostBytes = 1u << 26;

Json to_json(const KeptInputs& inputs) {
  Json assets = Json::array();
  for (const OfferedAsset& offered : inputs.assets) {
    assets.push_back({{"name", offered.asset->name}, {"categories", offered.categories}});
  }
  return {{"seedframe_inputs", kInputsVersion},
          {"name", inputs.name},
          {"seed", inputs.seed},
          {"categories", inputs.categories},
          {"assets", assets},
          {"has_images", inputs.has_images},
          {"has_depth", inputs.has_depth},
          {"image_format", name_of(inputs.image_format)}};
}

/// Of one folder, or a name that could be anywhere.
bool is_folder_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos;
}

Status write_if_other(const fs::path& file, const std::string& bytes) {
  std::error_code missing;
  if (fs::exists(file, missing)) {
    const Result<std::string> present = read_file(file);
    if (present && *present == bytes) return {};
  }
  return write_file_atomically(file, bytes);
}

/// Its description, and its mesh; coarser levels are not what exports show.
Status keep_asset(const Asset& asset, const fs::path& folder) {
  if (Status made = make_folders(folder); !made) return made;
  for (const char* file : {asset_files::kMesh, asset_files::kDescription}) {
    const Result<std::string> bytes = read_file(asset.folder / file);
    if (!bytes) return forward_error(bytes);
    if (Status written = write_if_other(folder / file, *bytes); !written) return written;
  }
  return {};
}

Result<KeptInputs> inputs_from_json(const Json& json, const CampaignFiles& files) {
  KeptInputs inputs;
  if (json.at("seedframe_inputs").get<int>() > kInputsVersion) {
    return fail(ErrorKind::kInput, "{} was written by a later Seedframe",
                files.kept_inputs().string());
  }
  inputs.name = json.at("name").get<std::string>();
  inputs.seed = json.at("seed").get<std::uint64_t>();
  inputs.categories = json.at("categories").get<std::vector<std::string>>();
  inputs.has_images = json.at("has_images").get<bool>();
  inputs.has_depth = json.at("has_depth").get<bool>();
  const auto format = image_format_of(json.at("image_format").get<std::string>());
  if (!format) {
    return fail(ErrorKind::kCorrupt, "{}: unknown image format", files.kept_inputs().string());
  }
  inputs.image_format = *format;
  for (const Json& entry : json.at("assets")) {
    const std::string name = entry.at("name").get<std::string>();
    if (!is_folder_name(name)) {
      return fail(ErrorKind::kCorrupt, "{}: '{}' is no name of an asset",
                  files.kept_inputs().string(), name);
    }
    Result<Asset> asset = read_asset(files.kept_asset(name));
    if (!asset) return forward_error(asset);
    inputs.assets.push_back({std::make_shared<const Asset>(std::move(*asset)),
                             entry.at("categories").get<std::set<std::string>>()});
  }
  return inputs;
}

}  // namespace

Result<KeptInputs> inputs_of(const PreparedCampaign& prepared) {
  const CampaignSettings& settings = prepared.settings;
  auto assets = prepared.expander.offered_assets();
  if (!assets) return forward_error(assets);
  return KeptInputs{settings.name,
                    settings.seed,
                    settings.categories,
                    std::move(*assets),
                    settings.labels == LabelSource::kIndexPass,
                    settings.render.depth,
                    settings.image_encoding.format};
}

Status keep_inputs(const CampaignFiles& files, const KeptInputs& inputs) {
  for (const OfferedAsset& offered : inputs.assets) {
    const fs::path folder = files.kept_asset(offered.asset->name);
    if (Status kept = keep_asset(*offered.asset, folder); !kept) return kept;
  }
  if (Status made = make_folders(files.kept_inputs().parent_path()); !made) return made;
  return write_if_other(files.kept_inputs(), readable_json(to_json(inputs)));
}

Result<std::optional<KeptInputs>> read_kept_inputs(const CampaignFiles& files) {
  std::error_code missing;
  if (!fs::exists(files.kept_inputs(), missing)) return std::nullopt;
  const Result<std::string> text = read_file(files.kept_inputs(), kMostBytes);
  if (!text) return forward_error(text);
  const Result<Json> json = parse_json(*text, files.kept_inputs().string());
  if (!json) return forward_error(json);
  try {
    Result<KeptInputs> inputs = inputs_from_json(*json, files);
    if (!inputs) return forward_error(inputs);
    return std::optional(std::move(*inputs));
  } catch (const Json::exception&) {
    return fail(ErrorKind::kCorrupt, "{} is not as Seedframe writes it",
                files.kept_inputs().string());
  }
}

Result<KeptInputs> inputs_of(const Campaign& campaign, const std::filesystem::path& home,
                             const std::vector<std::string>& allowed) {
  Result<std::optional<KeptInputs>> kept = read_kept_inputs(campaign.files);
  if (!kept) return forward_error(kept);
  if (*kept) return std::move(**kept);
  const Result<PreparedCampaign> prepared = prepare_again(campaign, home, allowed);
  if (!prepared) return forward_error(prepared);
  return inputs_of(*prepared);
}

}  // namespace seedframe
