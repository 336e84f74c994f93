#include "export/frame_export.h"

#include <algorithm>

#include "base/campaign_files.h"

namespace seedframe {
namespace {

Status check_frames(const Dataset& dataset, const ExportOptions& options) {
  if (dataset.frames.empty()) {
    return fail(ErrorKind::kInput,
                "campaign '{}' has no complete frame to export: run 'seedframe resume' first",
                dataset.name);
  }
  std::int64_t last = -1;
  bool trains = false;
  for (const DatasetFrame& frame : dataset.frames) {
    if (frame.index <= last) {
      return fail(ErrorKind::kCorrupt, "frame {} follows frame {}: each index must be larger",
                  frame.index, last);
    }
    last = frame.index;
    trains = trains || split_of_scene(frame.scene, options) == Split::kTrain;
  }
  if (!trains) {
    return fail(ErrorKind::kInput,
                "with a validation share of {} and seed {} no scene is left to train on: choose a "
                "smaller share, another seed, or render more scenes",
                options.val_share, options.seed);
  }
  return {};
}

Status check_categories(const Dataset& dataset) {
  if (dataset.categories.empty()) {
    return fail(ErrorKind::kInput, "campaign '{}' has no categories: there is nothing to annotate",
                dataset.name);
  }
  for (const std::string& category : dataset.categories) {
    try {
      static_cast<void>(Json(category).dump());
    } catch (const Json::exception&) {
      return fail(ErrorKind::kInput, "a category's name is not valid UTF-8; rename it");
    }
  }
  return {};
}

ExportFrame select_instances(const DatasetFrame& frame, const LoadedFrame& loaded,
                             const ExportOptions& options, SplitSummary& summary) {
  ExportFrame selected{.frame = frame,
                       .loaded = loaded,
                       .split = split_of_scene(frame.scene, options),
                       .stem = frame_stem(frame.index),
                       .instances = {}};
  for (const InstanceLabel& label : loaded.labels.instances) {
    if (label.category == 0 || label.area_px == 0) continue;
    if (label.area_px < options.min_pixels) {
      ++summary.skipped_small;
    } else {
      selected.instances.push_back(&label);
    }
  }
  return selected;
}

}  // namespace

Status check_export(const Dataset& dataset, const ExportOptions& options) {
  if (!(options.val_share >= 0.0 && options.val_share < 1.0)) {
    return fail(ErrorKind::kInput, "the validation share must lie in [0, 1), found {}",
                options.val_share);
  }
  if (options.min_pixels < 1) {
    return fail(ErrorKind::kInput, "the least number of pixels must be 1 or more, found {}",
                options.min_pixels);
  }
  if (Status named = check_categories(dataset); !named) return named;
  return check_frames(dataset, options);
}

std::vector<Split> splits_of(const ExportOptions& options) {
  if (options.val_share == 0.0) return {Split::kTrain};
  return {Split::kTrain, Split::kVal};
}

Result<ExportSummary> export_frames(const Dataset& dataset, const ExportOptions& options,
                                    ExportFolder& folder, const WriteFrame& write_frame) {
  ExportSummary summary{.folder = folder.destination(), .splits = {}, .warnings = {}};
  for (const Split split : splits_of(options)) {
    summary.splits.push_back({.split = split_name(split)});
    const auto images = std::filesystem::path("images") / split_name(split);
    if (Status made = folder.make_folder(images); !made) return forward_error(made);
  }
  for (const DatasetFrame& frame : dataset.frames) {
    const auto loaded = load_frame(dataset, frame);
    if (!loaded) return forward_error(loaded);
    const auto split = static_cast<std::size_t>(split_of_scene(frame.scene, options));
    SplitSummary& counts = summary.splits[split];
    const ExportFrame selected = select_instances(frame, *loaded, options, counts);
    const auto image = std::filesystem::path("images") / counts.split / (selected.stem + ".png");
    const Status placed = dataset.has_images ? folder.place(frame.folder / frame_files::kImage,
                                                            image, options.link_images)
                                             : Status();
    if (!placed) {
      return fail(placed.error().kind, "frame {}: {}", frame.index, placed.error().message);
    }
    if (Status written = write_frame(selected, counts); !written) return forward_error(written);
    ++summary.frames;
    ++counts.images;
    counts.annotations += static_cast<std::int64_t>(selected.instances.size());
    counts.background_images += selected.instances.empty();
  }
  if (!dataset.has_images) {
    summary.warnings.emplace_back(
        "the campaign has labels only (labels: geometry): no images were written");
  }
  if (summary.splits.back().images == 0) {
    summary.warnings.push_back(
        fmt::format("no scene fell into val (share {}, seed {})", options.val_share, options.seed));
  }
  return summary;
}

std::string export_marker(const Dataset& dataset, const ExportOptions& options,
                          const std::string& format) {
  return readable_json({{"version", 1},
                        {"format", format},
                        {"campaign", dataset.name},
                        {"frames", dataset.frames.size()},
                        {"min_pixels", options.min_pixels},
                        {"val_share", options.val_share},
                        {"split_seed", options.seed}});
}

}  // namespace seedframe
