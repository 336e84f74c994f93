#include "export/coco.h"

#include "annotate/mask.h"
#include "annotate/polygon.h"
#include "annotate/rle.h"
#include "export/coco_file.h"
#include "export/frame_export.h"

namespace seedframe {
namespace {

Json rle_json(const Mask& mask) {
  const Rle rle = encode_rle(mask);
  return {{"size", {rle.height, rle.width}}, {"counts", rle_string(rle)}};
}

Json polygons_json(const Mask& mask) {
  Json polygons = Json::array();
  for (const Polygon& polygon : part_polygons(mask, kOnPixelEdges)) {
    Json numbers = Json::array();
    for (const Vertex& vertex : polygon) {
      numbers.push_back(vertex.x / kVerticesPerPixel);  // on pixel edges: whole pixels
      numbers.push_back(vertex.y / kVerticesPerPixel);
    }
    polygons.push_back(std::move(numbers));
  }
  return polygons;
}

// COCO has no image 0 in use, and evaluation reads an annotation id of 0 as "no match".
std::int64_t image_id(const DatasetFrame& frame) { return frame.index + 1; }

Json image_json(const ExportFrame& frame) {
  return {{"id", image_id(frame.frame)},
          {"file_name", frame.stem + ".png"},
          {"width", frame.loaded.labels.width},
          {"height", frame.loaded.labels.height},
          {"seedframe_frame_id", frame.frame.frame_id}};
}

Json annotation_json(const ExportFrame& frame, const InstanceLabel& label, std::int64_t id,
                     CocoMasks masks) {
  const Mask mask(frame.loaded.instance_ids, label.id, label.box);
  return {{"id", id},
          {"image_id", image_id(frame.frame)},
          {"category_id", label.category},
          {"iscrowd", 0},
          {"area", label.area_px},
          {"bbox", {label.box.x, label.box.y, label.box.width, label.box.height}},
          {"segmentation", masks == CocoMasks::kRle ? rle_json(mask) : polygons_json(mask)}};
}

}  // namespace

Result<ExportSummary> export_coco(const Dataset& dataset, const ExportOptions& options,
                                  CocoMasks masks) {
  if (Status valid = check_export(dataset, options); !valid) return forward_error(valid);
  const std::string format = masks == CocoMasks::kRle ? "coco" : "coco-polygon";
  auto folder = ExportFolder::create(options.output, format);
  if (!folder) return forward_error(folder);
  if (Status made = folder->make_folder("annotations"); !made) return forward_error(made);

  std::vector<CocoFile> files;
  for (const Split split : splits_of(options)) {
    files.emplace_back(
        folder->partial() / "annotations" / fmt::format("instances_{}.json", split_name(split)),
        fmt::format("Seedframe campaign '{}'", dataset.name), dataset.categories);
  }
  std::int64_t annotations = 0;  // over all splits: an id means one annotation in the whole export
  auto summary = export_frames(
      dataset, options, *folder, [&](const ExportFrame& frame, SplitSummary&) -> Status {
        CocoFile& file = files[static_cast<std::size_t>(frame.split)];
        file.add_image(image_json(frame));
        for (const InstanceLabel* label : frame.instances) {
          file.add_annotation(annotation_json(frame, *label, ++annotations, masks));
        }
        return {};
      });
  if (!summary) return summary;
  for (CocoFile& file : files) {
    if (Status finished = file.finish(); !finished) return forward_error(finished);
  }
  const Status committed = folder->commit(export_marker(dataset, options, format));
  if (!committed) return forward_error(committed);
  return summary;
}

}  // namespace seedframe
