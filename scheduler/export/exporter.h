// What every export format has in common: options, the summary, and the list of formats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "export/dataset.h"

namespace seedframe {

/// Where the vertices of YOLO's polygons stand.
enum class PolygonVertices {
  kEdges,    ///< 0.02 px inside the pixel edges: exact in loaders that truncate (ultralytics)
  kCentres,  ///< nearest to the pixels' integer coordinates: exact in loaders that round as well,
             ///< at the price of a box that ends 0.52 px too early
};

struct ExportOptions {
  std::filesystem::path output;  ///< the format makes its own folder in it
  int min_pixels = 1;            ///< instances with fewer visible pixels are left out and counted
  bool link_images = true;       ///< hard links where the file system allows, else copies
  double val_share = 0.0;        ///< expected share of the scenes that go to val, in [0, 1)
  std::uint64_t seed = 0;        ///< of the split
  PolygonVertices polygon_vertices = PolygonVertices::kEdges;
};

struct SplitSummary {
  std::string split;  ///< "train" or "val"
  std::int64_t images = 0;
  std::int64_t annotations = 0;
  std::int64_t background_images = 0;  ///< images without an annotation
  std::int64_t skipped_small = 0;      ///< visible instances below min_pixels
  std::int64_t duplicate_rows = 0;  ///< YOLO: rows that loaders merge with another of their image
};

struct ExportSummary {
  std::filesystem::path folder;
  std::int64_t frames = 0;
  std::vector<SplitSummary> splits;  ///< train, and val if val_share is above 0
  std::vector<std::string> warnings;
};

struct ExportFormat {
  const char* name;
  const char* description;
  Result<ExportSummary> (*run)(const Dataset&, const ExportOptions&);
};

const std::vector<ExportFormat>& export_formats();

/// A kInput error with "did you mean" for an unknown name.
Result<const ExportFormat*> find_export_format(std::string_view name);

}  // namespace seedframe
