// What a worker wrote for one frame.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"
#include "base/pixel_rect.h"
#include "image/pass_reader.h"
#include "spec/frame_spec.h"

namespace seedframe {

/// Inside a folder of the frame's own.
std::filesystem::path rendered_passes(const std::filesystem::path& folder);

/// Where the worker writes the passes without depth of field, beside those with it.
std::filesystem::path sharp_passes(const std::filesystem::path& rendered);

/// The passes of a frame, each from the rendering that it comes from (plan/pass_plan.h): of the
/// pixels that were rendered, RenderSettings::rendered_pixels. `sample_counts`: whether they were
/// asked for, too. Errors: those of read_passes.
Result<FramePasses> read_rendered_frame(const FrameSpec& spec, const std::string& frame_id,
                                        const std::filesystem::path& rendered,
                                        bool sample_counts = false);

/// The same passes with the pixels of the whole image: where nothing was rendered they are black,
/// of no instance, and infinitely far. Their hashes stay those of what was rendered.
FramePasses on_whole_image(FramePasses rendered, const RenderSettings& render);

/// Which pixels of its image the passes in a finished frame's folder have. kCorrupt: its frame.json
/// is missing or damaged.
Result<PixelRect> rendered_pixels_of(const std::filesystem::path& folder);

}  // namespace seedframe
