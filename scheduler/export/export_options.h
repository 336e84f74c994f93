// What the user can choose about an export.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/error.h"

namespace seedframe {

/// Where the vertices of YOLO's polygons stand.
enum class PolygonVertices {
  kEdges,    ///< 0.02 px inside the pixel edges: exact in loaders that truncate (ultralytics)
  kCentres,  ///< nearest to the pixels' integer coordinates: exact in loaders that round as well,
             ///< if they put no points between, at the price of a box that ends 0.52 px too early
};

enum class PolygonDetail {
  kExact,
  kSimplified,  ///< fewer vertices, at an IoU of 0.99 or more
};

struct SplitShare {
  std::string name;  ///< "train", "val" or "test"
  double share = 0.0;
};

struct ExportOptions {
  std::filesystem::path output;  ///< each format makes its own folder in it
  int min_pixels = 1;            ///< instances with fewer visible pixels are left out and counted
  double min_visible = 0.0;      ///< so are those of which a smaller share is visible
  bool amodal = false;           ///< masks and boxes of whole silhouettes
  std::vector<SplitShare> splits = {{"train", 1.0}};  ///< the first is train
  PolygonVertices polygon_vertices = PolygonVertices::kEdges;
  PolygonDetail polygon_detail = PolygonDetail::kExact;
  int patch_size = 32;  ///< pixels of a side; 0: as they are
  int per_class = 0;    ///< patches of each class, in all splits; 0: all there are
  int min_side = 1;     ///< patches of which a side is shorter are left out
  std::vector<std::string> patch_classes = {};  ///< that patches are made of; none: of all
  /// Classes of which patches are windows onto a part, such as a field. Such a window holds nothing
  /// but its own class and those named before it.
  std::vector<std::string> windows = {};
  int windows_per_frame = 1;  ///< of each of them, where there is room
  int shard_size = 1000;      ///< samples in a tar
  // What follows does not change a byte of the export.
  bool link_images = false;  ///< hard links where the file system allows, else copies
  int workers = 1;           ///< threads
};

/// kInput errors for numbers out of range.
Status check_export_options(const ExportOptions& options);

/// All that decides about the bytes of an export.
Json to_json(const ExportOptions& options);
/// Reads what to_json wrote; what is not in it keeps its default.
Result<ExportOptions> export_options_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
