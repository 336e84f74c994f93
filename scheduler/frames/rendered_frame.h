// What a worker wrote for one frame.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "image/pass_reader.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// Inside a folder of the frame's own.
std::filesystem::path rendered_passes(const std::filesystem::path& folder);

/// Where the worker writes the passes without depth of field, beside those with it.
std::filesystem::path sharp_passes(const std::filesystem::path& rendered);

/// The passes of a frame, each from the rendering that it comes from (plan/pass_plan.h). Errors:
/// those of read_passes.
Result<FramePasses> read_rendered_frame(const FrameSpec& spec, const std::string& frame_id,
                                        const std::filesystem::path& rendered);

}  // namespace seedframe
