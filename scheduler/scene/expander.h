// From a config and one seed to frame specs: every frame by itself, in any order, always the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "config/campaign_config.h"
#include "geometry/asset_library.h"
#include "scene/draw.h"
#include "scene/frame_spec.h"
#include "scene/material_library.h"

namespace seedframe {

struct ExpandedFrame {
  FrameSpec spec;
  std::string id;           ///< frame_id(spec)
  std::int64_t scene = 0;   ///< index of the scene
  std::int64_t view = 0;    ///< index of the frame within its scene
  std::vector<Draw> draws;  ///< when asked for
};

/// A compiled config. Not for use from several threads at once.
class SceneExpander {
 public:
  /// Compiles every formula, resolves every name that can be known without a draw, and loads those
  /// assets. The error names every mistake.
  static Result<SceneExpander> compile(const CampaignConfig& config, AssetLibrary assets,
                                       MaterialLibrary materials);
  ~SceneExpander();
  SceneExpander(SceneExpander&&) noexcept;
  SceneExpander& operator=(SceneExpander&&) noexcept;

  /// Frames are numbered scene by scene: frame = scene · frames_per_scene + view. Errors say which
  /// key of the config made the frame impossible.
  Result<ExpandedFrame> expand(std::int64_t frame, bool record_draws = false);

  std::int64_t frame_count() const;

  /// Mesh buffers of all frames expanded so far, by SHA-256.
  const std::map<std::string, std::shared_ptr<const std::string>>& mesh_buffers() const;
  /// Texture files of all frames expanded so far, by SHA-256.
  const std::map<std::string, std::filesystem::path>& textures() const;
  /// Assets used so far: name to SHA-256 of its file, for provenance.
  const std::map<std::string, std::string>& asset_hashes() const;

 private:
  class Program;
  explicit SceneExpander(std::unique_ptr<Program> program);
  std::unique_ptr<Program> program_;
};

}  // namespace seedframe
