// From a config and one seed to frame specs: every frame by itself, in any order, always the same.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "assets/asset_library.h"
#include "assets/offered_asset.h"
#include "assets/offered_image.h"
#include "base/allowed_folders.h"
#include "base/error.h"
#include "draws/variables.h"
#include "scene/expanded_frame.h"
#include "spec/quality_wish.h"
#include "spec/rendering_wish.h"

namespace seedframe {

struct CampaignConfig;
class Graphs;
class MaterialLibrary;

/// A compiled config. Safe to use from several threads; what a frame becomes does not depend on
/// which were expanded before.
class SceneExpander {
 public:
  /// Compiles every formula, resolves every name that can be known without a draw, and loads those
  /// assets. The error names every mistake.
  static Result<SceneExpander> compile(const CampaignConfig& config, AssetLibrary assets,
                                       MaterialLibrary materials,
                                       std::shared_ptr<const Graphs> graphs = nullptr);
  ~SceneExpander();
  SceneExpander(SceneExpander&&) noexcept;
  SceneExpander& operator=(SceneExpander&&) noexcept;

  /// Frames are numbered scene by scene: frame = scene · frames_per_scene + view. Errors say which
  /// key of the config made the frame impossible.
  Result<ExpandedFrame> expand(std::int64_t frame, const ExpansionWishes& wishes = {}) const;

  /// The one frame of a scene whose variables are given, and rendered as wished, as a line of
  /// graphs says it (docs/formats/graphs.md); other draws are the scene's. Of a config whose scenes
  /// have one frame. `where` begins what is said against the values.
  Result<ExpandedFrame> expand_given(std::int64_t scene, const Json& values,
                                     const RenderingWish& rendering, const std::string& where,
                                     const ExpansionWishes& wishes = {}) const;
  /// What may be given.
  const GraphVariables& variables() const;

  std::int64_t frame_count() const;

  /// From now on these frames are rendered with what was chosen for them: to be called before the
  /// expander is shared by threads. Nothing where nothing was chosen.
  void set_choices(std::shared_ptr<const RenderChoices> choices);
  const std::shared_ptr<const RenderChoices>& choices() const;

  /// What any frame can hold; see offered_assets.
  Result<std::vector<OfferedAsset>> offered_assets() const;
  /// Which image files any frame can hold; see offered_images.
  std::vector<OfferedImage> offered_images() const;
  /// Where these, followed through symbolic links, may be.
  const AllowedFolders& allowed_folders() const;
  /// In the order of the config, as ExpandedFrame::constraints.
  std::vector<std::string> constraint_names() const;

 private:
  class Program;
  explicit SceneExpander(std::unique_ptr<Program> program);
  std::unique_ptr<Program> program_;
};

}  // namespace seedframe
