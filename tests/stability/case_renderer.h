// Frames of all cases, rendered by one Blender.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/error.h"
#include "tests/stability/agreement.h"
#include "tests/stability/cases.h"

namespace seedframe {

/// A frame as it came from Blender, or why it did not.
struct RenderedFrame {
  std::filesystem::path passes;
  std::string failure;
};

struct CaseRendering {
  std::string blender;                             ///< its version
  std::vector<std::vector<RenderedFrame>> frames;  ///< of each case
};

struct RenderFolders {
  std::filesystem::path scripts;  ///< blender_scripts/, as stability.py moves it
  std::filesystem::path scratch;  ///< for passes and a log
  std::map<std::string, std::filesystem::path> meshes;  ///< SHA-256 -> mesh buffer
};

/// By one worker of two threads. An error means that no frame could be rendered at all.
Result<CaseRendering> render_cases(const std::vector<StabilityCase>& cases,
                                   const std::string& blender, const RenderFolders& folders);

Result<FrameImages> read_rendered(const RenderedFrame& frame, const FrameSpec& spec);

}  // namespace seedframe
