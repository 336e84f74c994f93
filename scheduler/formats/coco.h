// COCO instances, keypoints and panoptic segmentation (docs/formats/coco.md).
#pragma once

#include <memory>

#include "export/format.h"

namespace seedframe {

Result<std::unique_ptr<ExportFormat>> make_coco(const Dataset& dataset,
                                                const ExportOptions& options);
Result<std::unique_ptr<ExportFormat>> make_coco_polygon(const Dataset& dataset,
                                                        const ExportOptions& options);
/// A kInput error when no asset of the dataset has keypoints.
Result<std::unique_ptr<ExportFormat>> make_coco_keypoints(const Dataset& dataset,
                                                          const ExportOptions& options);
/// A kInput error for silhouettes, which overlap.
Result<std::unique_ptr<ExportFormat>> make_coco_panoptic(const Dataset& dataset,
                                                         const ExportOptions& options);

}  // namespace seedframe
