// From the text of a config to its frames, with the built-in assets and materials.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "config/campaign_config.h"
#include "draws/graphs.h"
#include "scene/expander.h"
#include "scene/material_library.h"

namespace seedframe {

inline const std::filesystem::path kHome = SEEDFRAME_HOME;

/// The built-in assets; each is read once for all tests.
inline const AssetLibrary& built_in_assets() {
  static const AssetLibrary library = *AssetLibrary::open({kHome / "assets"});
  return library;
}

/// Relative paths in the config start at the folder of `file`.
inline Result<SceneExpander> expander_of(const std::string& text,
                                         const std::filesystem::path& file = "scene.yaml") {
  auto config = read_campaign_config(text, file);
  if (!config) return forward_error(config);
  auto materials = MaterialLibrary::open({kHome / "materials"}, config->materials);
  if (!materials) return forward_error(materials);
  std::shared_ptr<const Graphs> graphs;
  if (config->graphs) {
    auto opened = Graphs::open(*config->graphs);
    if (!opened) return forward_error(opened);
    config->scenes = opened->size();
    graphs = std::make_shared<const Graphs>(std::move(*opened));
  }
  return SceneExpander::compile(*config, built_in_assets(), *materials, std::move(graphs));
}

inline ExpandedFrame frame_of(const SceneExpander& expander, std::int64_t frame = 0) {
  auto expanded = expander.expand(frame, {.id = true, .draws = true, .graph = true});
  EXPECT_TRUE(expanded) << expanded.error().message;
  return expanded ? std::move(*expanded) : ExpandedFrame{};
}

/// Of a config that must be right.
inline std::vector<ExpandedFrame> all_frames(const std::string& text,
                                             const std::filesystem::path& file = "scene.yaml") {
  std::vector<ExpandedFrame> frames;
  auto expander = expander_of(text, file);
  EXPECT_TRUE(expander) << expander.error().message;
  if (!expander) return {ExpandedFrame{}};
  for (std::int64_t i = 0; i < expander->frame_count(); ++i) {
    frames.push_back(frame_of(*expander, i));
  }
  return frames;
}

inline ExpandedFrame first_frame(const std::string& text) { return all_frames(text).front(); }

/// The first error of a config, from its text to its last frame.
inline std::string scene_error(const std::string& text,
                               const std::filesystem::path& file = "scene.yaml") {
  auto expander = expander_of(text, file);
  if (!expander) return expander.error().message;
  for (std::int64_t frame = 0; frame < expander->frame_count(); ++frame) {
    const auto expanded = expander->expand(frame);
    if (!expanded) return expanded.error().message;
  }
  return "(no error)";
}

inline std::map<std::string, Json> draws_by_name(const ExpandedFrame& frame) {
  std::map<std::string, Json> draws;
  for (const Draw& draw : frame.draws) draws[draw.name] = draw.value;
  return draws;
}

/// In the world, if the camera stands at the origin and looks along y: `kCameraAtOrigin`.
inline Eigen::Vector3d place_of(const InstanceSpec& instance) {
  const Eigen::Vector3d seen = instance.camera_from_object.translation();
  return {seen.x(), -seen.z(), seen.y()};
}

inline constexpr const char* kCameraAtOrigin = "camera: {position: [0, 0, 0], target: [0, 1, 0]}\n";

}  // namespace seedframe
