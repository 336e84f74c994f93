#include "export/yolo.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "annotate/mask.h"
#include "annotate/polygon.h"
#include "export/frame_export.h"

namespace seedframe {
namespace {

constexpr int kLargestRefusedSide = 9;

/// Eight decimals are 0.0001 px of an image of 10000 px, and what float32 can hold.
void append_coordinate(std::string& row, double pixels, int side) {
  fmt::format_to(std::back_inserter(row), " {:.8f}", std::clamp(pixels / side, 0.0, 1.0));
}

std::string box_row(const InstanceLabel& label, const FrameLabels& frame) {
  const PixelBox& box = label.box;
  std::string row = std::to_string(label.category - 1);
  append_coordinate(row, box.x + box.width / 2.0, frame.width);
  append_coordinate(row, box.y + box.height / 2.0, frame.height);
  append_coordinate(row, box.width, frame.width);
  append_coordinate(row, box.height, frame.height);
  return row;
}

std::string polygon_row(const InstanceLabel& label, const LoadedFrame& frame,
                        PolygonVertices vertices) {
  const Mask mask(frame.instance_ids, label.id, label.box);
  const VertexPlacement& placement =
      vertices == PolygonVertices::kEdges ? kInsidePixelEdges : kNearestToPixels;
  std::string row = std::to_string(label.category - 1);
  for (const Vertex& vertex : whole_polygon(mask, placement)) {
    append_coordinate(row, static_cast<double>(vertex.x) / kVerticesPerPixel, frame.labels.width);
    append_coordinate(row, static_cast<double>(vertex.y) / kVerticesPerPixel, frame.labels.height);
  }
  return row;
}

/// Rows that loaders take for a repetition of an earlier one: the same class and the same box.
std::int64_t count_duplicates(const ExportFrame& frame) {
  std::set<std::tuple<int, int, int, int, int>> seen;
  std::int64_t duplicates = 0;
  for (const InstanceLabel* label : frame.instances) {
    const PixelBox& box = label->box;
    const bool added = seen.emplace(label->category, box.x, box.y, box.width, box.height).second;
    duplicates += !added;
  }
  return duplicates;
}

Status check_sides(const ExportFrame& frame) {
  const FrameLabels& labels = frame.loaded.labels;
  if (std::min(labels.width, labels.height) > kLargestRefusedSide) return {};
  return fail(ErrorKind::kInput,
              "frame {}: YOLO loaders refuse images with a side of {} pixels or less, this one is "
              "{}x{}: render larger images or export to another format",
              frame.frame.index, kLargestRefusedSide, labels.width, labels.height);
}

/// Paths are relative to the yaml's own folder, as loaders take them when `path` is left out.
std::string data_yaml(const Dataset& dataset, const ExportSummary& summary) {
  // Loaders require `val`. Without validation images it names the training images.
  const SplitSummary& last = summary.splits.back();
  std::string yaml = "train: images/train\n";
  yaml += fmt::format("val: images/{}\n", last.images > 0 ? last.split : "train");
  yaml += fmt::format("nc: {}\nnames:\n", dataset.categories.size());
  for (std::size_t i = 0; i < dataset.categories.size(); ++i) {
    // A JSON string is a YAML string, whatever it holds ("no" would be a boolean without quotes).
    yaml += fmt::format("  {}: {}\n", i, Json(dataset.categories[i]).dump());
  }
  return yaml;
}

void warn_of_duplicates(ExportSummary& summary) {
  for (const SplitSummary& split : summary.splits) {
    if (split.duplicate_rows == 0) continue;
    summary.warnings.push_back(
        fmt::format("{}: {} instances have the class and the box of another instance of their "
                    "image; loaders merge such rows",
                    split.split, split.duplicate_rows));
  }
}

}  // namespace

Result<ExportSummary> export_yolo(const Dataset& dataset, const ExportOptions& options,
                                  YoloTask task) {
  if (Status valid = check_export(dataset, options); !valid) return forward_error(valid);
  const std::string format = task == YoloTask::kDetect ? "yolo-detect" : "yolo-segment";
  auto folder = ExportFolder::create(options.output, format);
  if (!folder) return forward_error(folder);
  const std::filesystem::path labels = "labels";
  for (const Split split : splits_of(options)) {
    const Status made = folder->make_folder(labels / split_name(split));
    if (!made) return forward_error(made);
  }
  auto summary = export_frames(
      dataset, options, *folder, [&](const ExportFrame& frame, SplitSummary& counts) -> Status {
        if (Status large = check_sides(frame); !large) return large;
        counts.duplicate_rows += count_duplicates(frame);
        std::string rows;  // stays empty for a background image, whose label file must exist
        for (const InstanceLabel* label : frame.instances) {
          rows += task == YoloTask::kDetect
                      ? box_row(*label, frame.loaded.labels)
                      : polygon_row(*label, frame.loaded, options.polygon_vertices);
          rows += '\n';
        }
        return folder->write(labels / counts.split / (frame.stem + ".txt"), rows);
      });
  if (!summary) return summary;
  warn_of_duplicates(*summary);
  const Status described = folder->write("data.yaml", data_yaml(dataset, *summary));
  if (!described) return forward_error(described);
  const Status committed = folder->commit(export_marker(dataset, options, format));
  if (!committed) return forward_error(committed);
  return summary;
}

}  // namespace seedframe
