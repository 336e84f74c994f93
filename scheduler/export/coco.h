// COCO instance annotations (docs/formats/coco.md).
#pragma once

#include "export/exporter.h"

namespace seedframe {

enum class CocoMasks {
  kRle,      ///< compressed run lengths
  kPolygon,  ///< one polygon a part, holes by keyholes
};

/// Writes OUTPUT/coco or OUTPUT/coco-polygon. Annotations are streamed: the memory used does not
/// depend on the number of frames.
Result<ExportSummary> export_coco(const Dataset& dataset, const ExportOptions& options,
                                  CocoMasks masks);

}  // namespace seedframe
