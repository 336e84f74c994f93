// From a config and one seed to frame specs: every frame by itself, in any order, always the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "assets/asset_library.h"
#include "base/error.h"
#include "config/campaign_config.h"
#include "draws/draw.h"
#include "draws/graphs.h"
#include "mesh/mesh_buffer.h"
#include "scene/constraints.h"
#include "scene/material_library.h"
#include "scene/offered_assets.h"
#include "scene/offered_images.h"
#include "spec/frame_spec.h"

namespace seedframe {

struct ExpandedFrame {
  FrameSpec spec;
  std::string id;              ///< frame_id(spec), when asked for
  std::int64_t scene = 0;      ///< index of the scene
  std::int64_t view = 0;       ///< index of the frame within its scene
  std::uint32_t attempts = 1;  ///< to meet the constraints
  std::vector<Draw> draws;     ///< when asked for
  Json graph;                  ///< the values of all variables, when asked for
  /// The mesh of the ground, if there is one; its SHA-256 is in the spec.
  std::shared_ptr<const std::string> ground_buffer;
};

/// What expanding a frame should tell beside its spec.
struct ExpansionWishes {
  bool id = true;
  bool draws = false;
  bool graph = false;
};

/// A compiled config. Not for use from several threads at once.
class SceneExpander {
 public:
  /// Compiles every formula, resolves every name that can be known without a draw, and loads those
  /// assets. The error names every mistake.
  static Result<SceneExpander> compile(const CampaignConfig& config, AssetLibrary assets,
                                       MaterialLibrary materials,
                                       std::optional<Graphs> graphs = std::nullopt);
  ~SceneExpander();
  SceneExpander(SceneExpander&&) noexcept;
  SceneExpander& operator=(SceneExpander&&) noexcept;

  /// Frames are numbered scene by scene: frame = scene · frames_per_scene + view. Errors say which
  /// key of the config made the frame impossible.
  Result<ExpandedFrame> expand(std::int64_t frame, const ExpansionWishes& wishes = {});

  std::int64_t frame_count() const;

  /// Of all frames expanded so far; grounds are with their frames.
  const MeshBuffers& mesh_buffers() const;
  /// Of the instances of a frame that this expanded, its ground included.
  MeshBuffers mesh_buffers_of(const ExpandedFrame& frame) const;
  /// Textures and environment maps of all frames expanded so far, by SHA-256.
  const std::map<std::string, std::filesystem::path>& image_files() const;
  /// Assets used so far: name to SHA-256 of its file, for provenance.
  const std::map<std::string, std::string>& asset_hashes() const;
  /// What any frame can hold; see offered_assets.
  Result<std::vector<OfferedAsset>> offered_assets() const;
  /// Which image files any frame can hold; see offered_images.
  std::vector<OfferedImage> offered_images() const;
  const MaterialLibrary& material_library() const;
  /// Over all frames expanded so far, in the order of the config.
  const std::vector<ConstraintTally>& constraint_tallies() const;

 private:
  class Program;
  explicit SceneExpander(std::unique_ptr<Program> program);
  std::unique_ptr<Program> program_;
};

}  // namespace seedframe
