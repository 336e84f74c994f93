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

/// A format that cannot hold the dataset or one of its frames.
struct ImpossibleExport {
  std::string format;
  Error error;  ///< kInput
};

struct ExportOutcome {
  std::vector<ExportSummary> written;  ///< at least one
  std::vector<ImpossibleExport> impossible;
};

/// Formats that are impossible do not keep the others from being written; what was there of them
/// stays. kInput errors for options out of range, no categories, no frames, an empty training
/// split, or no format that is possible; kCorrupt errors name up to ten frames that are not as they
/// were written. Nothing is written then, and exports that were there stay.
Result<ExportOutcome> run_export(const Dataset& dataset,
                                 const std::vector<const FormatEntry*>& formats,
                                 const ExportOptions& options);

}  // namespace seedframe
