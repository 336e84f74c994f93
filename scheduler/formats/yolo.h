// YOLO label files: boxes, polygons, oriented boxes, keypoints (docs/formats/yolo.md).
#pragma once

#include <memory>

#include "export/format.h"

namespace seedframe {

Result<std::unique_ptr<ExportFormat>> make_yolo_detect(const Dataset& dataset,
                                                       const ExportOptions& options);
Result<std::unique_ptr<ExportFormat>> make_yolo_segment(const Dataset& dataset,
                                                        const ExportOptions& options);
Result<std::unique_ptr<ExportFormat>> make_yolo_obb(const Dataset& dataset,
                                                    const ExportOptions& options);
/// A kInput error when no asset of the dataset has keypoints.
Result<std::unique_ptr<ExportFormat>> make_yolo_pose(const Dataset& dataset,
                                                     const ExportOptions& options);

}  // namespace seedframe
