// The text that a campaign is made from, and what reading it depends on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/allowed_folders.h"
#include "base/place.h"

namespace seedframe {

/// One `--set path=value`: replaces or adds the value at a path of keys, such as
/// "variables.scene.parts" or "render.samples"; the value is YAML.
struct Override {
  std::string path;
  std::string value;
  /// Where it was written, when that was a config's `set`; empty for the command line.
  Place origin = {};
};

struct CampaignSource {
  std::string text;                 ///< of the config
  std::filesystem::path file;       ///< as the user gave it; relative paths start at its folder
  std::vector<Override> overrides;  ///< of --set
  std::filesystem::path home;       ///< where the built-in assets/ and materials/ are
  /// Besides the folder of `file`, and `home`.
  AllowedFolders allowed = {};
  /// A campaign's own file of graphs, which may still grow; it comes in place of what the config
  /// and its overrides say of scenes. Empty: there is none.
  std::filesystem::path graphs = {};
  /// See AssetLibrary::open; of no influence on any frame.
  std::filesystem::path copies = {};
};

}  // namespace seedframe
