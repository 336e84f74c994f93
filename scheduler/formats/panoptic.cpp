#include <algorithm>

#include "annotate/mask.h"
#include "formats/coco.h"
#include "formats/coco_entry.h"
#include "formats/voc_colors.h"
#include "image/png_file.h"

namespace seedframe {
namespace {

constexpr std::uint32_t kVoid = 0;
constexpr std::uint32_t kBackground = 65536;  // instance ids end before it

std::string png_path(const ExportFrame& frame) {
  return "annotations/panoptic_" + frame.split + "/" + frame.stem + ".png";
}

/// Whatever the image's content is: detectron2 makes its name of that of the segments.
std::string panoptic_image_name(const ExportFrame& frame) { return frame.stem + ".jpg"; }

/// Each pixel's segment: the instance, or the background. What the options left out is void.
Image<std::uint32_t> segment_ids(const ExportFrame& frame) {
  const Image<std::uint16_t>& ids = frame.loaded.instance_ids;
  Image<std::uint32_t> segments(ids.width, ids.height);
  std::fill(segments.values.begin(), segments.values.end(), kBackground);
  const auto paint = [&](const InstanceLabel& label, std::uint32_t segment) {
    const PixelRect& box = label.box;
    for (int row = box.y; row < box.end_y(); ++row) {
      for (int column = box.x; column < box.end_x(); ++column) {
        if (ids.at(row, column) == label.id) segments.at(row, column) = segment;
      }
    }
  };
  for (const ExportInstance& instance : frame.instances) {
    paint(*instance.label, static_cast<std::uint32_t>(instance.label->id));
  }
  for (const ExportFrame::LeftOut& left_out : frame.left_out) paint(*left_out.label, kVoid);
  return segments;
}

Image<std::uint8_t> segments_image(const Image<std::uint32_t>& segments) {
  Image<std::uint8_t> rgb(segments.width, segments.height, 3);
  for (std::size_t i = 0; i < segments.values.size(); ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      rgb.values[3 * i + channel] =
          static_cast<std::uint8_t>(segments.values[i] >> (8 * channel) & 0xff);
    }
  }
  return rgb;
}

class CocoPanoptic : public ExportFormat {
 public:
  CocoPanoptic(const Dataset& dataset, const ExportOptions& options)
      : dataset_(dataset), options_(options) {}

  FrameParts needs() const override { return {.image_file = dataset_.has_images}; }

  std::vector<DocumentKind> documents() const override {
    Json categories = coco_categories(dataset_);
    for (Json& category : categories) category["isthing"] = 1;
    categories.push_back({{"id", background_category()},
                          {"name", background_name()},
                          {"supercategory", "background"},
                          {"isthing", 0}});
    for (std::size_t k = 0; k < categories.size(); ++k) categories[k]["color"] = voc_color(k + 1);
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

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    FrameRecord record;
    record.counts = count_instances(frame);
    const Image<std::uint32_t> segments = segment_ids(frame);
    record.chunks.push_back({0, kCocoImages, coco_image(frame, panoptic_image_name(frame))});
    record.chunks.push_back({0, kCocoAnnotations, entry(frame, segments)});
    record.files.push_back(
        {png_path(frame), encode_png(segments_image(segments), PngContent::kLabels)});
    if (dataset_.has_images) {
      record.placed.push_back(
          image_at("images/" + frame.split + "/" + panoptic_image_name(frame), frame));
    }
    return record;
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    std::vector<std::string> found;
    const Image<std::uint32_t> segments = segment_ids(frame);
    const auto json = parse_json(written.chunks.size() == 2 ? written.chunks[1].text : "", "");
    if (!json || canonical_json(*json) != entry(frame, segments)) {
      found.emplace_back("the entry of its segments is another");
    }
    const auto png = decode_png8(written.file(png_path(frame)), png_path(frame));
    if (!png || png->channels != 3) {
      found.push_back(png ? png_path(frame) + " is not RGB" : png.error().message);
    } else if (png->values != segments_image(segments).values) {
      found.push_back(png_path(frame) + " has other segments");
    }
    return found;
  }

 private:
  std::size_t background_category() const { return dataset_.categories.size() + 1; }

  /// "background", unless a class is called so.
  std::string background_name() const {
    const std::vector<std::string>& names = dataset_.categories;
    std::string name = "background";
    if (std::find(names.begin(), names.end(), name) == names.end()) return name;
    return fmt::format("{}~{}", name, background_category());
  }

  std::string entry(const ExportFrame& frame, const Image<std::uint32_t>& segments) const {
    Json infos = Json::array();
    const auto add = [&infos](std::uint32_t id, std::size_t category, std::int64_t area,
                              const PixelRect& box) {
      infos.push_back({{"id", id},
                       {"category_id", category},
                       {"area", area},
                       {"bbox", {box.x, box.y, box.width, box.height}},
                       {"iscrowd", 0}});
    };
    for (const ExportInstance& instance : frame.instances) {
      add(static_cast<std::uint32_t>(instance.label->id),
          static_cast<std::size_t>(instance.label->category), instance.area_px, instance.box());
    }
    PixelRect box;
    std::int64_t area = 0;
    for (int row = 0; row < segments.height; ++row) {
      for (int column = 0; column < segments.width; ++column) {
        if (segments.at(row, column) != kBackground) continue;
        ++area;
        box = union_of(box, {column, row, 1, 1});
      }
    }
    if (area > 0) add(kBackground, background_category(), area, box);
    return canonical_json({{"image_id", coco_image_id(frame.frame.index)},
                           {"file_name", frame.stem + ".png"},
                           {"segments_info", std::move(infos)}});
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
