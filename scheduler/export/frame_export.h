// The way of every frame through an export, the same for all formats: read, checked, filtered, put
// into its split, its image placed, and counted. A format only adds what it writes about the frame.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "export/dataset.h"
#include "export/export_folder.h"
#include "export/exporter.h"
#include "export/split.h"

namespace seedframe {

struct ExportFrame {
  const DatasetFrame& frame;
  const LoadedFrame& loaded;
  Split split;
  std::string stem;  ///< the image is images/<split>/<stem>.png
  /// Those that are annotated: they have a category and at least min_pixels visible pixels.
  std::vector<const InstanceLabel*> instances;
};

using WriteFrame = std::function<Status(const ExportFrame&, SplitSummary&)>;

/// kInput errors for options out of range, no frames, no categories, or an empty training split.
Status check_export(const Dataset& dataset, const ExportOptions& options);

/// The splits that an export with these options has: train, and val if it can hold anything.
std::vector<Split> splits_of(const ExportOptions& options);

/// Calls `write_frame` for each frame in the order of the dataset, after its image is in place.
/// Fails at the first error.
Result<ExportSummary> export_frames(const Dataset& dataset, const ExportOptions& options,
                                    ExportFolder& folder, const WriteFrame& write_frame);

/// The content of seedframe.json: what was exported, and with which options.
std::string export_marker(const Dataset& dataset, const ExportOptions& options,
                          const std::string& format);

}  // namespace seedframe
