// Two frames on disk, by their hashes first and then pixel by pixel.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "audit/grade.h"
#include "base/error.h"
#include "frames/manifest.h"

namespace seedframe {

struct FrameDifference {
  Grade grade = Grade::kIdentical;
  /// Of the passes whose hashes differ: "combined", "index", "depth", "normal", "image" (8 bits).
  std::map<std::string, ImageDifference> passes;
  bool labels_json = false;  ///< labels.json differs
  std::string unlike;        ///< why passes cannot be compared: another size, a pass that one lacks
};

/// The manifests are those of the folders. kCorrupt: a file is not what its manifest says.
Result<FrameDifference> difference_of_frames(const std::filesystem::path& expected,
                                             const Manifest& expected_manifest,
                                             const std::filesystem::path& found,
                                             const Manifest& found_manifest,
                                             const Tolerance& tolerance);

/// "combined 1,234 of 76,800 pixels, at most 0.0049 and 2 units in the last place, RMS 0.0002,
/// PSNR 74.0 dB; …"
std::string describe(const FrameDifference& difference);
Json to_json(const FrameDifference& difference);

/// heat_map of the pictures of two frames; kInput if there are none, or of another size.
Result<Image<std::uint8_t>> heat_map_of_frames(const std::filesystem::path& expected,
                                               const std::filesystem::path& found);

}  // namespace seedframe
