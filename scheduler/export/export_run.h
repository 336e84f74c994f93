// Writes exports: every frame is read once for all formats, checked, encoded beside others, and
// appended in order. Memory does not grow with the number of frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "export/dataset.h"
#include "export/export_options.h"
#include "export/format.h"

namespace seedframe {

/// kInput errors for options out of range, no categories, no frames, or an empty training split;
/// kCorrupt errors name up to ten frames that are not as they were written. Nothing is written
/// then, and exports that were there stay.
Result<std::vector<ExportSummary>> run_export(const Dataset& dataset,
                                              const std::vector<const FormatEntry*>& formats,
                                              const ExportOptions& options);

}  // namespace seedframe
