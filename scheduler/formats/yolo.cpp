#include "formats/yolo.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>

#include "annotate/mask.h"
#include "annotate/polygon.h"
#include "annotate/polygon_fill.h"
#include "annotate/smallest_rectangle.h"
#include "formats/keypoint_rows.h"

namespace seedframe {
namespace {

enum class Task { kDetect, kSegment, kObb, kPose };

constexpr int kLargestRefusedSide = 9;
constexpr double kWrittenError = 1e-8;  // of a coordinate, by its decimals

/// Eight decimals are 0.0001 px of an image of 10000 px, and what float32 can hold.
void append_coordinate(std::string& row, double pixels, int side) {
  fmt::format_to(std::back_inserter(row), " {:.8f}", std::clamp(pixels / side, 0.0, 1.0));
}

void append_box(std::string& row, const PixelRect& box, const FrameLabels& frame) {
  append_coordinate(row, box.x + box.width / 2.0, frame.width);
  append_coordinate(row, box.y + box.height / 2.0, frame.height);
  append_coordinate(row, box.width, frame.width);
  append_coordinate(row, box.height, frame.height);
}

Status check_sides(const ExportFrame& frame) {
  const FrameLabels& labels = frame.loaded.labels;
  if (std::min(labels.width, labels.height) > kLargestRefusedSide) return {};
  return fail(ErrorKind::kInput,
              "frame {}: YOLO loaders refuse images with a side of {} pixels or less, this one is "
              "{}x{}: render larger images or export to another format",
              frame.frame.index, kLargestRefusedSide, labels.width, labels.height);
}

std::string label_path(const ExportFrame& frame) {
  return "labels/" + frame.split + "/" + frame.stem + ".txt";
}

/// Numbers of a row behind its class; none if a word of it is not a number.
std::optional<std::vector<double>> numbers_of(std::string_view row, int category) {
  std::vector<double> numbers;
  bool has_class = false;
  while (!row.empty()) {
    const std::size_t space = std::min(row.find(' '), row.size());
    const std::string_view word = row.substr(0, space);
    row.remove_prefix(std::min(space + 1, row.size()));
    double number = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    if (has_class) {
      numbers.push_back(number);
    } else if (number != category) {
      return std::nullopt;
    }
    has_class = true;
  }
  return numbers;
}

/// What loaders compare of a row to find repetitions: all of it, or of a row of points its class
/// and the box around them.
std::vector<float> compared_numbers(std::string_view row, bool points) {
  const int category = std::atoi(std::string(row.substr(0, row.find(' '))).c_str());
  const std::vector<double> numbers = numbers_of(row, category).value_or(std::vector<double>());
  std::vector<float> compared = {static_cast<float>(category)};
  if (!points) {
    compared.insert(compared.end(), numbers.begin(), numbers.end());
    return compared;
  }
  for (const std::size_t axis : {0, 1}) {
    auto [low, high] = std::pair(1.0F, 0.0F);
    for (std::size_t i = axis; i < numbers.size(); i += 2) {
      low = std::min(low, static_cast<float>(numbers[i]));
      high = std::max(high, static_cast<float>(numbers[i]));
    }
    compared.insert(compared.end(), {low, high});
  }
  return compared;
}

class Yolo : public ExportFormat {
 public:
  Yolo(const Dataset& dataset, const ExportOptions& options, Task task)
      : dataset_(dataset), options_(options), task_(task) {
    for (const ClassKeypoints& keypoints : dataset.keypoints) {
      points_ = std::max(points_, keypoints.names.size());
    }
  }

  FrameParts needs() const override { return {.image_file = dataset_.has_images}; }

  std::vector<std::filesystem::path> folders() const override {
    std::vector<std::filesystem::path> folders;
    for (const SplitShare& split : options_.splits) {
      folders.push_back(std::filesystem::path("images") / split.name);
      folders.push_back(std::filesystem::path("labels") / split.name);
    }
    return folders;
  }

  Result<FrameRecord> encode(const ExportFrame& frame) const override {
    if (Status large = check_sides(frame); !large) return forward_error(large);
    FrameRecord record;
    record.counts = count_instances(frame);
    std::set<std::vector<float>> seen;
    std::string rows;  // stays empty for a background image, whose label file must exist
    for (const ExportInstance& instance : frame.instances) {
      auto row = row_of(frame, instance, record.counts);
      if (!row) return forward_error(row);
      const bool points = task_ == Task::kSegment || task_ == Task::kObb;
      at(record.counts, Count::kDuplicateRows) +=
          !seen.insert(compared_numbers(*row, points)).second;
      rows += *row;
      rows += '\n';
    }
    record.files.push_back({label_path(frame), std::move(rows)});
    if (dataset_.has_images) {
      record.placed.push_back(image_at("images/" + frame.split + "/" + image_name(frame), frame));
    }
    return record;
  }

  Result<CommonPart> common_part(const ExportSummary& summary) const override {
    CommonPart common;
    for (const SplitSummary& split : summary.splits) {
      const std::int64_t merged = at(split.counts, Count::kDuplicateRows);
      if (merged == 0) continue;
      common.warnings.push_back(
          fmt::format("{}: {} instances have the class and the {} of another instance of their "
                      "image; loaders merge such rows",
                      split.split, merged, task_ == Task::kPose ? "box and keypoints" : "box"));
    }
    common.files["data.yaml"] = data_yaml(summary, Reader::kAny);
    common.files["data_with_nc.yaml"] = data_yaml(summary, Reader::kCountsClasses);
    return common;
  }

  /// What ultralytics and YOLOv5 keep beside the files that they have read.
  bool is_left_by_trainers(const std::string& path) const override {
    return (path.starts_with("labels/") && path.ends_with(".cache")) ||
           (path.starts_with("images/") && path.ends_with(".npy"));
  }

  std::vector<std::string> differences(const ExportFrame& frame,
                                       const WrittenFrame& written) const override {
    const std::string path = label_path(frame);
    if (written.files.count(path) == 0) return {path + " is missing"};
    std::string_view text = written.file(path);
    std::vector<std::string> found;
    for (const ExportInstance& instance : frame.instances) {
      const std::size_t end = text.find('\n');
      if (end == std::string_view::npos) return {path + " has too few rows"};
      const auto numbers = numbers_of(text.substr(0, end), instance.label->category - 1);
      text.remove_prefix(end + 1);
      const std::string difference =
          numbers ? row_difference(*numbers, frame, instance) : "its row is not one of its class";
      if (!difference.empty()) found.push_back(instance.label->name + ": " + difference);
    }
    if (!text.empty()) found.push_back(path + " has rows too many");
    return found;
  }

 private:
  Result<std::string> row_of(const ExportFrame& frame, const ExportInstance& instance,
                             Counts& counts) const {
    const FrameLabels& labels = frame.loaded.labels;
    std::string row = std::to_string(instance.label->category - 1);
    switch (task_) {
      case Task::kDetect:
        append_box(row, instance.box(), labels);
        break;
      case Task::kSegment: {
        const WholePolygon whole = polygon(instance);
        at(counts, Count::kLeftOutParts) += whole.left_out_px > 0;
        for (const Vertex& vertex : whole.polygon) {
          append_coordinate(row, static_cast<double>(vertex.x) / kVerticesPerPixel, labels.width);
          append_coordinate(row, static_cast<double>(vertex.y) / kVerticesPerPixel, labels.height);
        }
        break;
      }
      case Task::kObb: {
        const OrientedBox box = smallest_rectangle(instance.mask);
        at(counts, Count::kOtherBoxes) += !box.smallest;
        for (const auto& [x, y] : box.corners) {
          append_coordinate(row, x, labels.width);
          append_coordinate(row, y, labels.height);
        }
        break;
      }
      case Task::kPose:
        append_box(row, instance.box(), labels);
        if (Status added = append_keypoints(row, frame, instance); !added) {
          return forward_error(added);
        }
        break;
    }
    return row;
  }

  WholePolygon polygon(const ExportInstance& instance) const {
    return whole_polygon(instance.mask, options_.polygon_vertices == PolygonVertices::kEdges
                                            ? kInsidePixelEdges
                                            : kNearestToPixels);
  }

  Status append_keypoints(std::string& row, const ExportFrame& frame,
                          const ExportInstance& instance) const {
    const FrameLabels& labels = frame.loaded.labels;
    auto rows =
        keypoint_rows(frame.frame, *instance.label,
                      dataset_.keypoints[static_cast<std::size_t>(instance.label->category) - 1]);
    if (!rows) return forward_error(rows);
    rows->resize(points_);
    for (const KeypointRow& point : *rows) {
      if (point.visibility == Visibility::kOutside) {
        row += " 0 0 0";
        continue;
      }
      append_coordinate(row, point.px[0], labels.width);
      append_coordinate(row, point.px[1], labels.height);
      fmt::format_to(std::back_inserter(row), " {}", static_cast<int>(point.visibility));
    }
    return {};
  }

  /// CVAT takes every key that it does not know for a split, among them `nc` and `kpt_names`;
  /// YOLOv6 and YOLOv7 ask for `nc`.
  enum class Reader { kAny, kCountsClasses };

  /// Paths are relative to the yaml's own folder, as loaders take them when `path` is left out.
  std::string data_yaml(const ExportSummary& summary, Reader reader) const {
    std::string yaml = "train: images/train\n";
    // Loaders require `val`. Without validation images it names the training images.
    std::string val = "train";
    for (const SplitSummary& split : summary.splits) {
      if (split.split == "val" && split.images > 0) val = "val";
    }
    yaml += fmt::format("val: images/{}\n", val);
    for (const SplitSummary& split : summary.splits) {
      if (split.split == "test") yaml += "test: images/test\n";
    }
    // A JSON string is a YAML string, whatever it holds ("no" would be a boolean without quotes).
    if (reader == Reader::kCountsClasses) {
      yaml += fmt::format("nc: {}\nnames: {}\n", dataset_.categories.size(),
                          Json(dataset_.categories).dump());
    } else {
      yaml += "names:\n";
      for (std::size_t i = 0; i < dataset_.categories.size(); ++i) {
        yaml += fmt::format("  {}: {}\n", i, Json(dataset_.categories[i]).dump());
      }
    }
    if (task_ != Task::kPose) return yaml;
    yaml += fmt::format("kpt_shape: [{}, 3]\n", points_);
    const std::vector<int> flipped = flip_indices();
    if (!flipped.empty()) yaml += fmt::format("flip_idx: {}\n", Json(flipped).dump());
    if (reader == Reader::kAny) return yaml;
    yaml += "kpt_names:\n";
    for (std::size_t i = 0; i < dataset_.categories.size(); ++i) {
      std::vector<std::string> names = dataset_.keypoints[i].names;
      names.resize(points_, "");
      yaml += fmt::format("  {}: {}\n", i, Json(names).dump());
    }
    return yaml;
  }

  /// Which point each becomes in a mirrored image: the same for every class that has points, or
  /// none, and then loaders must not mirror. A class none of whose points are mirrored has no
  /// mirror image that is one of its own.
  std::vector<int> flip_indices() const {
    std::vector<int> common;
    for (const ClassKeypoints& keypoints : dataset_.keypoints) {
      if (keypoints.names.empty()) continue;
      if (keypoints.mirrored.empty()) return {};
      std::vector<int> flipped(points_);
      for (std::size_t i = 0; i < points_; ++i) flipped[i] = static_cast<int>(i);
      for (const auto& [left, right] : keypoints.mirrored) {
        std::swap(flipped[static_cast<std::size_t>(left)],
                  flipped[static_cast<std::size_t>(right)]);
      }
      if (!common.empty() && flipped != common) return {};
      common = std::move(flipped);
    }
    return common;
  }

  std::string row_difference(const std::vector<double>& numbers, const ExportFrame& frame,
                             const ExportInstance& instance) const {
    const FrameLabels& labels = frame.loaded.labels;
    if (task_ == Task::kSegment) return segment_difference(numbers, labels, instance);
    Counts ignored{};
    const auto expected = row_of(frame, instance, ignored);
    if (!expected) return expected.error().message;
    const auto right = numbers_of(*expected, instance.label->category - 1);
    const bool same =
        right && right->size() == numbers.size() &&
        std::equal(numbers.begin(), numbers.end(), right->begin(),
                   [](double a, double b) { return std::abs(a - b) <= kWrittenError; });
    return same ? "" : "its numbers are others";
  }

  std::string segment_difference(const std::vector<double>& numbers, const FrameLabels& labels,
                                 const ExportInstance& instance) const {
    if (numbers.size() < 6 || numbers.size() % 2 != 0) return "its polygon cannot be read";
    Polygon decoded;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
      decoded.push_back(
          {static_cast<std::int32_t>(std::lround(numbers[i] * labels.width * kVerticesPerPixel)),
           static_cast<std::int32_t>(
               std::lround(numbers[i + 1] * labels.height * kVerticesPerPixel))});
    }
    // Placed at 0.48 px, a polygon ends before the centres of its last pixels.
    if (options_.polygon_vertices == PolygonVertices::kCentres) {
      return decoded == polygon(instance).polygon ? "" : "its polygon is another";
    }
    const double iou = polygon_iou({decoded}, instance.mask, FillRule::kCentres);
    const auto area = static_cast<double>(instance.area_px);
    const double whole = (area - static_cast<double>(polygon(instance).left_out_px)) / area;
    return iou == whole ? "" : fmt::format("its polygon has an IoU of {:.4f} with the mask", iou);
  }

  const Dataset& dataset_;
  const ExportOptions& options_;
  Task task_;
  std::size_t points_ = 0;  ///< keypoints of the class that has most
};

}  // namespace

Result<std::unique_ptr<ExportFormat>> make_yolo_detect(const Dataset& dataset,
                                                       const ExportOptions& options) {
  return std::make_unique<Yolo>(dataset, options, Task::kDetect);
}

Result<std::unique_ptr<ExportFormat>> make_yolo_segment(const Dataset& dataset,
                                                        const ExportOptions& options) {
  return std::make_unique<Yolo>(dataset, options, Task::kSegment);
}

Result<std::unique_ptr<ExportFormat>> make_yolo_obb(const Dataset& dataset,
                                                    const ExportOptions& options) {
  return std::make_unique<Yolo>(dataset, options, Task::kObb);
}

Result<std::unique_ptr<ExportFormat>> make_yolo_pose(const Dataset& dataset,
                                                     const ExportOptions& options) {
  if (Status some = check_has_keypoints(dataset); !some) return forward_error(some);
  return std::make_unique<Yolo>(dataset, options, Task::kPose);
}

}  // namespace seedframe
