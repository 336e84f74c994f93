// Post-processing of one attempt: from the worker's EXR to the files of the frame.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "image/color_management.h"
#include "scene/frame_spec.h"

namespace seedframe {

struct FinishTask {
  FrameSpec spec;
  std::string frame_id;
  std::filesystem::path attempt_folder;  ///< holds the worker's passes
};

/// The worker writes here, inside the attempt folder.
std::filesystem::path rendered_passes(const std::filesystem::path& attempt_folder);

/// Reads and checks the passes, writes image.png, instances.png, semantic.png, labels.json,
/// frame.json, the passes without dates, depth.exr and normal.exr when asked for, and the manifest,
/// all into the attempt folder; StoreWriter brings them to the disk and into place. Returns the
/// frame's pixel hash. A kRender error is the worker's fault, a kEnvironment error the disk's.
/// Thread-safe.
Result<std::string> finish_frame(const FinishTask& task, const ColorManagement& color);

}  // namespace seedframe
