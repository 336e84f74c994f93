// manifest.json: what a committed frame consists of (docs/formats/manifest.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "base/canonical_json.h"
#include "base/error.h"
#include "spec/image_encoding.h"
#include "spec/twin_check.h"

namespace seedframe {

inline constexpr int kManifestVersion = 2;

struct Manifest {
  struct File {
    std::uint64_t bytes = 0;
    std::string sha256;
  };
  std::string frame_id;
  /// By pass; "image" is the picture before it was encoded.
  std::map<std::string, std::string> pixel_hashes;
  std::map<std::string, File> files;  ///< all but the manifest itself
  TwinTally twin = {};
  ImageEncoding image = {};  ///< of the picture; of no meaning where there is none

  /// Whether there is no picture, or one that is encoded so.
  bool picture_is(const ImageEncoding& encoding) const;
  /// The picture's file name, if there is one: "image.png".
  std::string image_file() const;

  /// SHA-256 over the canonical JSON of pixel_hashes: the frame's part of the dataset hash.
  std::string pixel_hash() const;
};

Json to_json(const Manifest& manifest);
/// Reads what to_json wrote; the error (kCorrupt) names `what`.
Result<Manifest> parse_manifest(std::string_view text, const std::string& what);
Result<Manifest> read_manifest(const std::filesystem::path& frame_folder);

enum class VerifyDepth {
  kSizes,     ///< every file is there and has its size
  kContents,  ///< and its SHA-256
};

/// Checks a committed frame; the error (kCorrupt) names the first file that is not as it was
/// written.
Result<Manifest> verify_frame(const std::filesystem::path& frame_folder,
                              const std::string& frame_id, VerifyDepth depth);

}  // namespace seedframe
