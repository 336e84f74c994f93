// A config read, checked and compiled against its assets and materials: ready to be expanded,
// nothing written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/campaign_config.h"
#include "scene/expander.h"

namespace seedframe {

struct CampaignSource {
  std::string text;                 ///< of the config
  std::filesystem::path file;       ///< as the user gave it; relative paths start at its folder
  std::vector<Override> overrides;  ///< of --set
  std::filesystem::path home;       ///< where the built-in assets/ and materials/ are
};

Result<CampaignSource> read_source(const std::filesystem::path& file,
                                   const std::vector<Override>& overrides,
                                   const std::filesystem::path& home);

struct PreparedCampaign {
  CampaignSource source;
  CampaignConfig config;
  SceneExpander expander;
};

Result<PreparedCampaign> prepare(CampaignSource source);

/// Scene and id of every frame, in order; an error if any frame cannot be expanded.
struct FrameIdentity {
  std::int64_t scene = 0;
  std::string id;
};
Result<std::vector<FrameIdentity>> expand_all(SceneExpander& expander);

}  // namespace seedframe
