// A config read, checked and compiled against its assets and materials: ready to be expanded,
// nothing written.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/allowed_folders.h"
#include "base/error.h"
#include "config/campaign_config.h"
#include "scene/expander.h"

namespace seedframe {

struct CampaignSource {
  std::string text;                 ///< of the config
  std::filesystem::path file;       ///< as the user gave it; relative paths start at its folder
  std::vector<Override> overrides;  ///< of --set
  std::filesystem::path home;       ///< where the built-in assets/ and materials/ are
  /// Besides the folder of `file`, and `home`.
  AllowedFolders allowed = {};
};

/// Allows the working directory, /usr/share (for colour configs) and `allowed`.
Result<CampaignSource> read_source(const std::filesystem::path& file,
                                   const std::vector<Override>& overrides,
                                   const std::filesystem::path& home,
                                   const std::vector<std::string>& allowed = {});

struct PreparedCampaign {
  CampaignSource source;
  CampaignConfig config;
  SceneExpander expander;
};

Result<PreparedCampaign> prepare(CampaignSource source);

/// What expanding every frame tells.
struct CampaignSize {
  std::int64_t frames = 0;
  std::size_t least_instances = 0;
  std::size_t most_instances = 0;
  std::int64_t attempts = 0;  ///< to meet the constraints, over all frames
};

/// Expands every frame and keeps none; an error if any cannot be expanded. `visit`, if given, sees
/// each.
Result<CampaignSize> expand_all(SceneExpander& expander, const ExpansionWishes& wishes,
                                const std::function<Status(const ExpandedFrame&)>& visit = {});

/// "ball_seen: met by 812 of 1020", a line for each constraint.
std::string describe_constraints(const SceneExpander& expander);

}  // namespace seedframe
