#include "formats/coco.h"

#include <algorithm>
#include <cmath>

#include "annotate/mask.h"
#include "annotate/polygon.h"
#include "annotate/polygon_fill.h"
#include "annotate/polygon_simplify.h"
#include "formats/coco_entry.h"
#include "formats/keypoint_rows.h"
#include "frames/campaign_files.h"

namespace seedframe {
namespace {

enum class Kind { kRle, kPolygon, kKeypoints };

/// COCO's whole numbers are the pixels' centres. Readers take what is below 0 for a mistake, so a
/// point in the first half of the first pixel is put on its centre.
double pixel_index(double px, int side) {
  constexpr double kHalf = 0.5;
  const double index = std::clamp(px - kHalf, 0.0, side - kHalf);
  return std::round(index * 100.0) / 100.0;
}

std::string polygons_text(const std::vector<Polygon>& polygons) {
  std::string text = "[";
  for (const Polygon& polygon : polygons) {
    text += text.size() > 1 ? ",[" : "[";
    for (const Vertex& vertex : polygon) {
      for (const std::int32_t coordinate : {vertex.x, vertex.y}) {
        append_canonical(text, static_cast<double>(coordinate) / kVerticesPerPixel);
        text += ',';
      }
    }
    text.back() = ']';
  }
  return text + "]";
}

std::optional<std::vector<Polygon>> polygons_from_json(const Json& json) {
  std::vector<Polygon> polygons;
  if (!json.is_array()) return std::nullopt;
  for (const Json& ring : json) {
    if (!ring.is_array() || ring.size() % 2 != 0 || ring.size() < 6) return std::nullopt;
    Polygon& polygon = polygons.emplace_back();
    for (std::size_t i = 0; i < ring.size(); i += 2) {
      if (!ring[i].is_number() || !ring[i + 1].is_number()) return std::nullopt;
      const auto vertex = [&](std::size_t at) {
        return static_cast<std::int32_t>(std::lround(ring[at].get<double>() * kVerticesPerPixel));
      };
      polygon.push_back({vertex(i), vertex(i + 1)});
    }
  }
  return polygons;
}

class CocoInstances : public ExportFormat {
 public:
  CocoInstances(const Dataset& dataset, const ExportOptions& options, Kind kind)
      : dataset_(dataset), options_(options), kind_(kind) {}

  FrameParts needs() const override { return {.image_file = dataset_.has_images}; }

  std::vector<DocumentKind> documents() const override {
    Json categories = coco_categories(dataset_);
    if (kind_ == Kind::kKeypoints) add_keypoint_names(categories);
    const char* path = kind_ == Kind::kKeypoints ? "annotations/person_keypoints_{split}.json"
                                                 : "annotations/instances_{split}.json";
    return {coco_document(path, DocumentKind::Scope::kSplit, dataset_, categories)};
  }

  std::vector<std::filesystem::path> folders() const override {
    std::vector<std::filesystem::path> folders;
    for (const SplitShare& split : options_.splits) {
      folders.push_back(std::filesystem::path("images") / split.name);
    }
    return folders;
  }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    FrameRecord record;
    record.counts =
        count_instances(frame, [this](const InstanceLabel& label) { return wanted(label); });
    record.chunks.push_back({0, kCocoImages, coco_image(frame, image_name(frame))});
    for (const ExportInstance& instance : frame.instances) {
      if (!wanted(*instance.label)) continue;
      if (kind_ != Kind::kKeypoints) {
        record.chunks.push_back(
            {0, kCocoAnnotations, coco_annotation(frame, instance, mask(instance))});
        continue;
      }
      auto keypoints = keypoints_of(frame, instance);
      if (!keypoints) return forward_error(keypoints);
      record.chunks.push_back(
          {0, kCocoAnnotations,
           coco_annotation(frame, instance, coco_rle(instance.mask), *keypoints)});
    }
    if (dataset_.has_images) {
      record.placed.push_back(image_at("images/" + frame.split + "/" + image_name(frame), frame));
    }
    return record;
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    std::vector<std::string> found;
    std::size_t next = 0;
    const auto image = parse_json(written.chunks.empty() ? "" : written.chunks[next++].text, "");
    if (!image || canonical_json(*image) != coco_image(frame, image_name(frame))) {
      found.emplace_back("the entry of the image is another");
    }
    for (const ExportInstance& instance : frame.instances) {
      if (!wanted(*instance.label)) continue;
      const auto annotation =
          parse_json(next < written.chunks.size() ? written.chunks[next++].text : "", "");
      const std::string difference =
          annotation ? annotation_difference(*annotation, frame, instance) : "there is no entry";
      if (!difference.empty()) found.push_back(instance.label->name + ": " + difference);
    }
    if (next != written.chunks.size()) {
      found.push_back(fmt::format("{} entries too many", written.chunks.size() - next));
    }
    return found;
  }

 private:
  bool wanted(const InstanceLabel& label) const {
    return kind_ != Kind::kKeypoints || !points_of(label).names.empty();
  }
  const ClassKeypoints& points_of(const InstanceLabel& label) const {
    return dataset_.keypoints[static_cast<std::size_t>(label.category) - 1];
  }

  std::string mask(const ExportInstance& instance) const {
    if (kind_ == Kind::kRle) return coco_rle(instance.mask);
    return polygons_text(options_.polygon_detail == PolygonDetail::kExact
                             ? part_polygons(instance.mask, kOnPixelEdges)
                             : simplified_polygons(instance.mask));
  }

  Result<std::string> keypoints_of(const ExportFrame& frame, const ExportInstance& instance) const {
    const auto rows = keypoint_rows(frame.frame, *instance.label, points_of(*instance.label));
    if (!rows) return forward_error(rows);
    const std::array<int, 2> sides = {frame.loaded.labels.width, frame.loaded.labels.height};
    std::string text = "\"keypoints\":[";
    int labelled = 0;
    for (const KeypointRow& row : *rows) {
      const bool known = row.visibility != Visibility::kOutside;
      labelled += known;
      for (std::size_t axis = 0; axis < sides.size(); ++axis) {
        append_canonical(text, known ? pixel_index(row.px[axis], sides[axis]) : 0.0);
        text += ',';
      }
      fmt::format_to(std::back_inserter(text), "{},", static_cast<int>(row.visibility));
    }
    text.back() = ']';
    return text + fmt::format(",\"num_keypoints\":{},", labelled);
  }

  void add_keypoint_names(Json& categories) const {
    for (std::size_t k = 0; k < categories.size(); ++k) {
      const ClassKeypoints& points = dataset_.keypoints[k];
      categories[k]["keypoints"] = points.names;
      Json skeleton = Json::array();
      for (const auto& [from, to] : points.skeleton) skeleton.push_back({from + 1, to + 1});
      categories[k]["skeleton"] = std::move(skeleton);
    }
  }

  std::string annotation_difference(const Json& annotation, const ExportFrame& frame,
                                    const ExportInstance& instance) const {
    std::string difference = coco_difference(annotation, frame, instance);
    if (!difference.empty()) return difference;
    const Json segmentation = annotation.value("segmentation", Json());
    if (kind_ != Kind::kPolygon) {
      if (!coco_rle_is(segmentation, instance.mask)) return "its mask is another";
    } else {
      const auto polygons = polygons_from_json(segmentation);
      if (!polygons) return "its polygons cannot be read";
      const double iou = polygon_iou(*polygons, instance.mask, FillRule::kCoco);
      const double least =
          options_.polygon_detail == PolygonDetail::kExact ? 1.0 : kLeastSimplifiedIou;
      if (iou < least) return fmt::format("its polygons have an IoU of {:.4f} with the mask", iou);
    }
    if (instance.silhouette) {
      const Mask visible(frame.loaded.instance_ids, instance.label->id, instance.label->box);
      if (!coco_rle_is(annotation.value("visible_segmentation", Json()), visible)) {
        return "its visible mask is another";
      }
    }
    if (kind_ != Kind::kKeypoints) return {};
    const auto expected = keypoints_of(frame, instance);
    if (!expected) return expected.error().message;
    const std::string written =
        fmt::format("\"keypoints\":{},\"num_keypoints\":{},",
                    canonical_json(annotation.value("keypoints", Json())),
                    canonical_json(annotation.value("num_keypoints", Json())));
    return written == *expected ? "" : "its keypoints are others";
  }

  const Dataset& dataset_;
  const ExportOptions& options_;
  Kind kind_;
};

std::unique_ptr<ExportFormat> instances(const Dataset& dataset, const ExportOptions& options,
                                        Kind kind) {
  return std::make_unique<CocoInstances>(dataset, options, kind);
}

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_coco(const Dataset& dataset,
                                                const ExportOptions& options) {
  return instances(dataset, options, Kind::kRle);
}

Result<std::unique_ptr<ExportFormat>> make_coco_polygon(const Dataset& dataset,
                                                        const ExportOptions& options) {
  return instances(dataset, options, Kind::kPolygon);
}

Result<std::unique_ptr<ExportFormat>> make_coco_keypoints(const Dataset& dataset,
                                                          const ExportOptions& options) {
  if (Status some = check_has_keypoints(dataset); !some) return forward_error(some);
  return instances(dataset, options, Kind::kKeypoints);
}

}  // namespace seedframe
