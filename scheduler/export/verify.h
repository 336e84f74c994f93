// Reads an export back and compares it with its source.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "export/dataset.h"
#include "export/format.h"

namespace seedframe {

struct VerifySummary {
  std::string format;
  std::int64_t frames = 0;       ///< compared
  std::int64_t annotations = 0;  ///< in them
  std::int64_t differences = 0;
  std::vector<std::string> first_differences;  ///< at most twenty, each names its frame or file
};

/// Decodes every frame's part of the export in `folder`, by the one of `formats` that it was made
/// with, with the same options, and compares masks, boxes, classes and images with the source, and
/// what belongs to no frame with what it should be. What the export has beside that is a difference
/// too: files that belong to nothing, unless trainers are known to leave them there, entries that
/// no frame has, missing frames. kCorrupt errors for a folder that is not an export, or a source
/// frame that is not as it was written.
Result<VerifySummary> verify_export(const Dataset& dataset, const FormatList& formats,
                                    const std::filesystem::path& folder, int workers);

}  // namespace seedframe
