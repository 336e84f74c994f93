#include "annotate/mask.h"
#include "formats/coco.h"
#include "formats/coco_entry.h"
#include "formats/voc_colors.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

std::string png_path(const ExportFrame& frame) {
  return "annotations/panoptic_" + frame.split + "/" + frame.stem + ".png";
}

class CocoPanoptic : public ExportFormat {
 public:
  CocoPanoptic(const Dataset& dataset, const ExportOptions& options)
      : dataset_(dataset), options_(options) {}

  FrameParts needs() const override { return {.image_file = dataset_.has_images}; }

  std::vector<DocumentKind> documents() const override {
    Json categories = coco_categories(dataset_);
    for (std::size_t k = 0; k < categories.size(); ++k) {
      categories[k]["isthing"] = 1;
      categories[k]["color"] = voc_color(k + 1);
    }
    return {coco_document("annotations/panoptic_{split}.json", DocumentKind::Scope::kSplit,
                          dataset_, categories)};
  }

  std::vector<std::filesystem::path> folders() const override {
    std::vector<std::filesystem::path> folders;
    for (const SplitShare& split : options_.splits) {
      folders.push_back(std::filesystem::path("images") / split.name);
      folders.push_back("annotations/panoptic_" + split.name);
    }
    return folders;
  }

  bool is_common_file(const std::string&) const override { return false; }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    FrameRecord record;
    record.counts = frame.counts;
    record.chunks.push_back({0, kCocoImages, coco_image(frame, image_name(frame))});
    record.chunks.push_back({0, kCocoAnnotations, entry(frame)});
    record.files.push_back({png_path(frame), encode_png(segments(frame), PngContent::kLabels)});
    if (dataset_.has_images) {
      record.placed.push_back(image_at("images/" + frame.split + "/" + image_name(frame), frame));
    }
    return record;
  }

  Status finish(ExportFolder&, ExportSummary&) const override { return {}; }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    std::vector<std::string> found;
    const auto json = parse_json(written.chunks.size() == 2 ? written.chunks[1].text : "", "");
    if (!json || canonical_json(*json) != entry(frame)) {
      found.emplace_back("the entry of its segments is another");
    }
    const auto png = decode_png8(written.file(png_path(frame)), png_path(frame));
    if (!png || png->channels != 3) {
      found.push_back(png ? png_path(frame) + " is not RGB" : png.error().message);
      return found;
    }
    for (const ExportInstance& instance : frame.instances) {
      const Mask& mask = instance.mask;
      const int id = instance.label->id;
      for (int row = 0; row < png->height; ++row) {
        for (int column = 0; column < png->width; ++column) {
          const int value = png->at(row, column, 0) + 256 * png->at(row, column, 1) +
                            65536 * png->at(row, column, 2);
          if ((value == id) == mask.at(row, column)) continue;
          found.push_back(fmt::format("{}: another mask, first at row {}, column {}",
                                      instance.label->name, row, column));
          return found;
        }
      }
    }
    return found;
  }

 private:
  static std::string entry(const ExportFrame& frame) {
    Json segments = Json::array();
    for (const ExportInstance& instance : frame.instances) {
      const PixelRect& box = instance.box();
      segments.push_back({{"id", instance.label->id},
                          {"category_id", instance.label->category},
                          {"area", instance.area_px},
                          {"bbox", {box.x, box.y, box.width, box.height}},
                          {"iscrowd", 0}});
    }
    return canonical_json({{"image_id", coco_image_id(frame.frame.index)},
                           {"file_name", frame.stem + ".png"},
                           {"segments_info", std::move(segments)}});
  }

  static Image<std::uint8_t> segments(const ExportFrame& frame) {
    const Image<std::uint16_t>& ids = frame.loaded.instance_ids;
    Image<std::uint8_t> rgb(ids.width, ids.height, 3);
    for (const ExportInstance& instance : frame.instances) {
      const PixelRect& box = instance.box();
      for (int row = box.y; row < box.end_y(); ++row) {
        for (int column = box.x; column < box.end_x(); ++column) {
          if (!instance.mask.at(row, column)) continue;
          rgb.at(row, column, 0) = static_cast<std::uint8_t>(instance.label->id & 0xff);
          rgb.at(row, column, 1) = static_cast<std::uint8_t>(instance.label->id >> 8);
        }
      }
    }
    return rgb;
  }

  const Dataset& dataset_;
  const ExportOptions& options_;
};

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_coco_panoptic(const Dataset& dataset,
                                                         const ExportOptions& options) {
  if (options.amodal) {
    return fail(ErrorKind::kInput,
                "coco-panoptic gives each pixel to one object, and silhouettes overlap: export it "
                "without --amodal");
  }
  return std::make_unique<CocoPanoptic>(dataset, options);
}

}  // namespace seedframe
