// YOLO label files for detection and segmentation (docs/formats/yolo.md).
#pragma once

#include "export/exporter.h"

namespace seedframe {

enum class YoloTask { kDetect, kSegment };

/// Writes OUTPUT/yolo-detect or OUTPUT/yolo-segment. A kInput error when a side of an image is 9
/// pixels or less: the loaders refuse it.
Result<ExportSummary> export_yolo(const Dataset& dataset, const ExportOptions& options,
                                  YoloTask task);

}  // namespace seedframe
