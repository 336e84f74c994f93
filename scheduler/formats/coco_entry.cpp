#include "formats/coco_entry.h"

#include <fmt/format.h>

#include "annotate/rle.h"

namespace seedframe {
namespace {

constexpr std::int64_t kInstancesPerImage = 100'000;  // more than an instance id can be

std::string json_text(std::string_view text) {
  std::string out;
  append_canonical(out, text);
  return out;
}

std::string box_text(const PixelRect& box) {
  return fmt::format("[{},{},{},{}]", box.x, box.y, box.width, box.height);
}

}  // namespace

std::int64_t coco_image_id(std::int64_t frame) { return frame + 1; }

std::int64_t coco_annotation_id(std::int64_t frame, int instance) {
  return coco_image_id(frame) * kInstancesPerImage + instance;
}

std::string coco_rle(const Mask& mask) {
  const Rle rle = encode_rle(mask);
  return fmt::format(R"({{"counts":{},"size":[{},{}]}})", json_text(rle_string(rle)), rle.height,
                     rle.width);
}

std::string coco_image(const ExportFrame& frame, std::string_view file_name) {
  const FrameLabels& labels = frame.loaded.labels;
  return fmt::format(
      R"({{"file_name":"{}","height":{},"id":{},"seedframe_frame_id":"{}","width":{}}})", file_name,
      labels.height, coco_image_id(frame.frame.index), frame.frame.frame_id, labels.width);
}

std::string coco_annotation(const ExportFrame& frame, const ExportInstance& instance,
                            std::string_view segmentation, std::string_view keypoints) {
  const InstanceLabel& label = *instance.label;
  std::string text = fmt::format(
      R"({{"area":{},"bbox":{},"category_id":{},"id":{},"image_id":{},"iscrowd":0,{}"segmentation":{})",
      instance.area_px, box_text(instance.box()), label.category,
      coco_annotation_id(frame.frame.index, label.id), coco_image_id(frame.frame.index), keypoints,
      segmentation);
  if (instance.silhouette) {
    const Mask visible(frame.loaded.instance_ids, label.id, label.box);
    text +=
        fmt::format(R"(,"visible_area":{},"visible_bbox":{})", label.area_px, box_text(label.box));
    if (label.amodal) {
      text += ",\"visible_fraction\":";
      append_canonical(text, label.visible_fraction());
    }
    text += ",\"visible_segmentation\":" + coco_rle(visible);
  } else if (label.amodal) {
    text += ",\"visible_fraction\":";
    append_canonical(text, label.visible_fraction());
  }
  return text + "}";
}

DocumentKind coco_document(std::string path, DocumentKind::Scope scope, const Dataset& dataset,
                           const Json& categories) {
  const Json info = {{"description", fmt::format("Seedframe campaign '{}'", dataset.name)},
                     {"version", "1"}};
  const std::string separator = ",\n";
  std::string header =
      "{\n\"info\":" + canonical_json(info) + ",\n\"licenses\":[],\n\"categories\":[\n";
  for (std::size_t i = 0; i < categories.size(); ++i) {
    if (i > 0) header += separator;
    header += canonical_json(categories[i]);
  }
  header += "\n],\n\"images\":[\n";
  return {.path = std::move(path),
          .scope = scope,
          .header = std::move(header),
          .breaks = {"\n],\n\"annotations\":[\n"},
          .footer = "\n]\n}\n",
          .separator = separator};
}

Json coco_categories(const Dataset& dataset) {
  Json categories = Json::array();
  for (std::size_t i = 0; i < dataset.categories.size(); ++i) {
    categories.push_back(
        {{"id", i + 1}, {"name", dataset.categories[i]}, {"supercategory", "object"}});
  }
  return categories;
}

std::string coco_difference(const Json& annotation, const ExportFrame& frame,
                            const ExportInstance& instance) {
  const PixelRect& box = instance.box();
  const std::pair<const char*, Json> expected[] = {
      {"id", coco_annotation_id(frame.frame.index, instance.label->id)},
      {"image_id", coco_image_id(frame.frame.index)},
      {"category_id", instance.label->category},
      {"iscrowd", 0},
      {"area", instance.area_px},
      {"bbox", {box.x, box.y, box.width, box.height}}};
  for (const auto& [key, value] : expected) {
    const Json found = annotation.is_object() ? annotation.value(key, Json()) : Json();
    if (found != value) {
      return fmt::format("{} is {} instead of {}", key, found.dump(), value.dump());
    }
  }
  return {};
}

bool coco_rle_is(const Json& segmentation, const Mask& mask) {
  if (!segmentation.is_object() ||
      segmentation.value("size", Json()) != Json{mask.image_height(), mask.image_width()}) {
    return false;
  }
  const Json counts = segmentation.value("counts", Json());
  if (!counts.is_string()) return false;
  const auto rle =
      rle_from_string(counts.get<std::string>(), mask.image_width(), mask.image_height());
  if (!rle || rle_area(*rle) != mask.area_px()) return false;
  bool same = true;  // every pixel of theirs is of the mask, and they are as many
  for_each_stretch(*rle, [&](int column, int first, int end) {
    for (int row = first; row < end; ++row) same = same && mask.at(row, column);
  });
  return same;
}

}  // namespace seedframe
