#include "formats/webdataset.h"

#include "annotate/mask.h"
#include "base/files.h"
#include "base/sha256.h"
#include "formats/coco_entry.h"
#include "formats/tar_member.h"
#include "frames/campaign_files.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

class WebDataset : public ExportFormat {
 public:
  WebDataset(const Dataset& dataset, const ExportOptions&) : dataset_(dataset) {}

  FrameParts needs() const override { return {.image_file = dataset_.has_images}; }

  std::vector<DocumentKind> documents() const override {
    return {{.path = "{split}-{shard}.tar",
             .scope = DocumentKind::Scope::kShard,
             .header = {},
             .breaks = {},
             .footer = tar_end(),
             .separator = {}}};
  }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    FrameRecord record;
    record.counts = count_instances(frame);
    std::string sample;
    const auto add = [&](const std::string& suffix, std::string_view content) -> Status {
      const auto member = tar_member(frame.stem + suffix, content);
      if (!member) return forward_error(member);
      sample += *member;
      return {};
    };
    if (Status added = add(".instances.png", encode_png(annotated_ids(frame))); !added) {
      return forward_error(added);
    }
    if (Status added = add(".json", annotations(frame)); !added) return forward_error(added);
    if (dataset_.has_images) {
      const auto image = read_file(frame.frame.folder / frame.loaded.image_file);
      if (!image) return forward_error(image);
      if (Status added =
              add(std::filesystem::path(frame.loaded.image_file).extension().string(), *image);
          !added)
        return forward_error(added);
    }
    record.chunks.push_back({0, 0, std::move(sample)});
    return record;
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    const auto members = read_tar_members(written.chunks.size() == 1 ? written.chunks[0].text : "");
    const std::size_t expected = dataset_.has_images ? 3 : 2;
    if (!members || members->size() != expected ||
        (*members)[0].first != frame.stem + ".instances.png" ||
        (*members)[1].first != frame.stem + ".json" ||
        (expected == 3 && (*members)[2].first != image_name(frame))) {
      return {"its members in the tar are others"};
    }
    std::vector<std::string> found;
    const auto ids = decode_png16((*members)[0].second, (*members)[0].first);
    if (!ids || ids->values != annotated_ids(frame).values) {
      found.push_back((*members)[0].first + " is another image");
    }
    const auto json = parse_json((*members)[1].second, (*members)[1].first);
    const Json list = json && json->is_object() ? json->value("annotations", Json()) : Json();
    if (!list.is_array() || list.size() != frame.instances.size()) {
      found.push_back((*members)[1].first + " has another number of annotations");
      return found;
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
      const ExportInstance& instance = frame.instances[i];
      std::string difference = coco_difference(list[i], frame, instance);
      if (difference.empty() &&
          !coco_rle_is(list[i].value("segmentation", Json()), instance.mask)) {
        difference = "its mask is another";
      }
      if (!difference.empty()) found.push_back(instance.label->name + ": " + difference);
    }
    if (expected == 3 && sha256_hex((*members)[2].second) != frame.loaded.image_sha256) {
      found.push_back((*members)[2].first + " is another image");
    }
    return found;
  }

 private:
  /// Visible pixels of what is annotated; a silhouette has no pixels of its own where it is hidden.
  static Image<std::uint16_t> annotated_ids(const ExportFrame& frame) {
    const Image<std::uint16_t>& ids = frame.loaded.instance_ids;
    Image<std::uint16_t> out(ids.width, ids.height);
    for (const ExportInstance& instance : frame.instances) {
      const PixelRect& box = instance.label->box;
      const auto id = static_cast<std::uint16_t>(instance.label->id);
      for (int row = box.y; row < box.end_y(); ++row) {
        for (int column = box.x; column < box.end_x(); ++column) {
          if (ids.at(row, column) == id) out.at(row, column) = id;
        }
      }
    }
    return out;
  }

  std::string annotations(const ExportFrame& frame) const {
    std::string text = "{\"annotations\":[";
    for (std::size_t i = 0; i < frame.instances.size(); ++i) {
      const ExportInstance& instance = frame.instances[i];
      std::string annotation = coco_annotation(frame, instance, coco_rle(instance.mask));
      const auto category = static_cast<std::size_t>(instance.label->category) - 1;
      annotation.pop_back();
      annotation += ",\"category\":";
      append_canonical(annotation, dataset_.categories[category]);
      text += (i > 0 ? ",\n" : "\n") + annotation + "}";
    }
    const FrameLabels& labels = frame.loaded.labels;
    text += fmt::format(
        R"(],"frame":{},"frame_id":"{}","height":{},"image_id":{},"scene":{},"width":{}}})",
        frame.frame.index, frame.frame.frame_id, labels.height, coco_image_id(frame.frame.index),
        frame.frame.scene, labels.width);
    return text + "\n";
  }

  const Dataset& dataset_;
};

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_webdataset(const Dataset& dataset,
                                                      const ExportOptions& options) {
  return std::make_unique<WebDataset>(dataset, options);
}

}  // namespace seedframe
