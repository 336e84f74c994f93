// What holds for every frame of a campaign: all that those who render, keep and export its frames
// need of its config.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/isa.h"
#include "base/place.h"
#include "spec/frame_spec.h"
#include "spec/image_encoding.h"
#include "spec/image_settings.h"
#include "spec/quality_wish.h"
#include "spec/render_device.h"
#include "spec/twin_check.h"

namespace seedframe {

/// What is promised of the pixels.
struct Determinism {
  enum class Mode {
    kMachine,   ///< the same on one kind of CPU
    kPortable,  ///< the same on every CPU that has the instruction set
    kNone,      ///< nothing
  };
  Mode mode = Mode::kMachine;
  Isa isa = Isa::kAvx2;  ///< that a portable campaign is rendered with
};

struct CampaignSettings {
  std::string name;
  std::uint64_t seed = 0;
  std::int64_t scenes = 1;
  std::int64_t frames_per_scene = 1;
  std::vector<std::string> categories;
  RenderSettings render;  ///< but for its seed, which every frame has its own of
  RenderDevice device = RenderDevice::kCpu;
  bool persistent_data = false;  ///< Cycles keeps scenes: pixels depend on earlier frames
  Determinism determinism;
  ImageSettings image;
  ImageEncoding image_encoding;
  std::optional<std::filesystem::path> ocio_config;  ///< none: Blender's own
  std::vector<std::filesystem::path> input_folders;  ///< that files of frames may lie in
  Place image_place;                                 ///< for errors that only OCIO can find
  LabelSource labels = LabelSource::kIndexPass;
  TwinCheck twin_check;
  /// What frames are rendered with is then chosen for each; render has the most samples.
  std::optional<QualityWish> quality;

  std::int64_t frame_count() const { return scenes * frames_per_scene; }
};

}  // namespace seedframe
