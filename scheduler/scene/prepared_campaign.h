// A config read, checked and compiled against its assets and materials: ready to be expanded,
// nothing written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/expander.h"
#include "spec/campaign_settings.h"
#include "spec/campaign_source.h"

namespace seedframe {

/// Of --set: each as "path=value".
Result<std::vector<Override>> read_overrides(const std::vector<std::string>& set);

/// `set`: overrides as "path=value". Allows the working directory, /usr/share (for colour configs)
/// and `allowed`.
Result<CampaignSource> read_source(const std::filesystem::path& file,
                                   const std::vector<std::string>& set,
                                   const std::filesystem::path& home,
                                   const std::vector<std::string>& allowed = {});

/// All that frames can depend on beside the config's text; what is in a folder counts too.
struct CampaignInputs {
  std::vector<std::filesystem::path> files;
  std::vector<std::filesystem::path> folders;
};

struct PreparedCampaign {
  CampaignSource source;
  CampaignSettings settings;
  CampaignInputs inputs;
  SceneExpander expander;
};

Result<PreparedCampaign> prepare(CampaignSource source);

}  // namespace seedframe
