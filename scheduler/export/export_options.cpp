#include "export/export_options.h"

#include <cmath>

namespace seedframe {

Status check_export_options(const ExportOptions& options) {
  if (options.min_pixels < 1) {
    return fail(ErrorKind::kInput, "--min-pixels must be 1 or more, found {}", options.min_pixels);
  }
  if (!(options.min_visible >= 0.0 && options.min_visible <= 1.0)) {
    return fail(ErrorKind::kInput, "--min-visible must be a share of 0 to 1, found {}",
                options.min_visible);
  }
  constexpr int kLargestPatch = 4096;
  if (options.patch_size < 0 || options.patch_size > kLargestPatch) {
    return fail(ErrorKind::kInput, "--patch-size must be 0 to {} pixels, found {}", kLargestPatch,
                options.patch_size);
  }
  if (options.per_class < 0) {
    return fail(ErrorKind::kInput, "--per-class must be 1 or more patches, found {}",
                options.per_class);
  }
  if (options.min_side < 1 || options.min_side > kLargestPatch) {
    return fail(ErrorKind::kInput, "--min-side must be 1 to {} pixels, found {}", kLargestPatch,
                options.min_side);
  }
  constexpr int kMostWindows = 100;
  if (options.windows_per_frame < 1 || options.windows_per_frame > kMostWindows) {
    return fail(ErrorKind::kInput, "--windows-per-frame must be 1 to {}, found {}", kMostWindows,
                options.windows_per_frame);
  }
  constexpr int kLargestShard = 1'000'000;
  if (options.shard_size < 1 || options.shard_size > kLargestShard) {
    return fail(ErrorKind::kInput, "--shard-size must be 1 to {} samples, found {}", kLargestShard,
                options.shard_size);
  }
  double sum = 0.0;
  for (const SplitShare& split : options.splits) {
    if (!(split.share >= 0.0 && split.share <= 1.0)) {
      return fail(ErrorKind::kInput, "--split: the share of {} must lie in 0 to 1, found {}",
                  split.name, split.share);
    }
    sum += split.share;
  }
  constexpr double kRounding = 1e-9;
  if (options.splits.empty() || options.splits.front().name != "train" ||
      options.splits.front().share <= 0.0 || std::abs(sum - 1.0) > kRounding) {
    return fail(ErrorKind::kInput,
                "--split: the shares must add up to 1, and train must have some of it");
  }
  return {};
}

Json to_json(const ExportOptions& options) {
  Json splits = Json::array();
  for (const SplitShare& split : options.splits) splits.push_back({split.name, split.share});
  return {{"min_pixels", options.min_pixels},
          {"min_visible", options.min_visible},
          {"amodal", options.amodal},
          {"splits", std::move(splits)},
          {"polygon_vertices",
           options.polygon_vertices == PolygonVertices::kEdges ? "edges" : "centres"},
          {"polygon", options.polygon_detail == PolygonDetail::kExact ? "exact" : "simplified"},
          {"patch_size", options.patch_size},
          {"per_class", options.per_class},
          {"min_side", options.min_side},
          {"patch_classes", options.patch_classes},
          {"windows", options.windows},
          {"windows_per_frame", options.windows_per_frame},
          {"shard_size", options.shard_size}};
}

Result<ExportOptions> export_options_from_json(const Json& json, const std::string& what) {
  ExportOptions options;
  try {
    json.at("min_pixels").get_to(options.min_pixels);
    json.at("min_visible").get_to(options.min_visible);
    json.at("amodal").get_to(options.amodal);
    options.splits.clear();
    for (const Json& split : json.at("splits")) {
      options.splits.push_back({split.at(0).get<std::string>(), split.at(1).get<double>()});
    }
    if (json.at("polygon_vertices").get<std::string>() == "centres") {
      options.polygon_vertices = PolygonVertices::kCentres;
    }
    if (json.at("polygon").get<std::string>() == "simplified") {
      options.polygon_detail = PolygonDetail::kSimplified;
    }
    json.at("patch_size").get_to(options.patch_size);
    json.at("per_class").get_to(options.per_class);
    json.at("min_side").get_to(options.min_side);
    json.at("patch_classes").get_to(options.patch_classes);
    json.at("windows").get_to(options.windows);
    json.at("windows_per_frame").get_to(options.windows_per_frame);
    json.at("shard_size").get_to(options.shard_size);
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: options: {}", what, error.what());
  }
  if (Status possible = check_export_options(options); !possible) {
    return fail(ErrorKind::kCorrupt, "{}: {}", what, possible.error().message);
  }
  return options;
}

}  // namespace seedframe
