// What a format has to say about one frame.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace seedframe {

/// What the summary of an export adds up.
enum class Count {
  kAnnotations,
  kTooSmall,       ///< instances left out: fewer than min_pixels
  kTooHidden,      ///< instances left out: less than min_visible
  kDuplicateRows,  ///< YOLO: rows that loaders merge with another of their image
  kLeftOutParts,   ///< YOLO: instances whose polygon is without some of their fragments
  kOtherBoxes,     ///< YOLO: instances whose smallest rectangle leaves the image
  kCount
};
using Counts = std::array<std::int64_t, static_cast<std::size_t>(Count::kCount)>;

inline std::int64_t& at(Counts& counts, Count which) {
  return counts[static_cast<std::size_t>(which)];
}
inline std::int64_t at(const Counts& counts, Count which) {
  return counts[static_cast<std::size_t>(which)];
}

/// A file that belongs to the frame alone. Paths are relative to the export's folder.
struct FrameFile {
  std::filesystem::path path;
  std::string bytes;
};

/// The same, for a file that is placed there as it is.
struct PlacedFile {
  std::filesystem::path path;
  std::filesystem::path source;
  std::string sha256;  ///< of the source
};

/// An entry of a document that frames share.
struct Chunk {
  int document = 0;  ///< index into ExportFormat::documents()
  int section = 0;
  std::string text;
};

struct FrameRecord {
  std::vector<FrameFile> files;
  std::vector<PlacedFile> placed;
  std::vector<Chunk> chunks;
  Counts counts{};
};

}  // namespace seedframe
