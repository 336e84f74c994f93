// Pascal VOC boxes and segmentation (docs/formats/voc.md).
#pragma once

#include <memory>

#include "export/format.h"

namespace seedframe {

/// kInput errors for more classes than a palette has, and for silhouettes, which overlap.
Result<std::unique_ptr<ExportFormat>> make_voc(const Dataset& dataset,
                                               const ExportOptions& options);

}  // namespace seedframe
