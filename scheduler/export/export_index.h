// seedframe.json and seedframe.index: what an export was made from (docs/formats/export.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "export/dataset.h"
#include "export/export_options.h"
#include "export/frame_record.h"

namespace seedframe {

inline constexpr const char* kMarkerFile = "seedframe.json";
inline constexpr const char* kIndexFile = "seedframe.index";

struct ExportMarker {
  std::string format;
  std::string campaign;
  std::string dataset;  ///< hash of what a format knows of all frames; see dataset_hash
  std::int64_t frames = 0;
  ExportOptions options;
};

/// Of classes, keypoints, assets and the seed: what changes the part of a frame that has not
/// changed.
std::string dataset_hash(const Dataset& dataset);

std::string marker_text(const ExportMarker& marker);
/// kCorrupt errors name the file: not a marker, or of a newer version.
Result<ExportMarker> read_marker(const std::filesystem::path& export_folder);

/// Hash of a file or a chunk as the index has it: 32 hex digits.
std::string content_hash(std::string_view bytes);
/// The same, of a file whose SHA-256 is known.
std::string content_hash_of_sha256(const std::string& sha256);

struct IndexEntry {
  struct File {
    std::string path;
    std::string hash;
  };
  struct Piece {
    std::string document;
    int section = 0;
    std::uint64_t bytes = 0;
    std::string hash;
  };
  std::int64_t frame = 0;
  std::string key;
  int split = 0;
  Counts counts{};
  std::vector<File> files;
  std::vector<Piece> pieces;
};

/// One line, with its end.
std::string index_line(const IndexEntry& entry);
Result<IndexEntry> parse_index_line(const std::string& line, const std::string& what);

}  // namespace seedframe
