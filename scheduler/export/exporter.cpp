#include "export/exporter.h"

#include "base/nearest_name.h"
#include "export/coco.h"
#include "export/yolo.h"

namespace seedframe {

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats = {
      {"coco", "COCO instances, masks as run lengths (exact, and the smallest)",
       [](const Dataset& dataset, const ExportOptions& options) {
         return export_coco(dataset, options, CocoMasks::kRle);
       }},
      {"coco-polygon", "COCO instances, masks as polygons (decode to the same pixels)",
       [](const Dataset& dataset, const ExportOptions& options) {
         return export_coco(dataset, options, CocoMasks::kPolygon);
       }},
      {"yolo-detect", "YOLO boxes: a row 'class x y width height' for each instance",
       [](const Dataset& dataset, const ExportOptions& options) {
         return export_yolo(dataset, options, YoloTask::kDetect);
       }},
      {"yolo-segment", "YOLO segments: a row 'class x1 y1 x2 y2 ...' for each instance",
       [](const Dataset& dataset, const ExportOptions& options) {
         return export_yolo(dataset, options, YoloTask::kSegment);
       }},
  };
  return formats;
}

Result<const ExportFormat*> find_export_format(std::string_view name) {
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) {
    if (format.name == name) return &format;
    names.emplace_back(format.name);
  }
  return fail(ErrorKind::kInput, "there is no export format '{}'{}", name,
              did_you_mean(name, names));
}

}  // namespace seedframe
