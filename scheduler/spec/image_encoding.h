// How the file of a frame's picture is written. It is no part of the frame spec: the pixels that
// are encoded, and their hash, are the same whatever file they go into.
#pragma once

#include <optional>
#include <string>

#include "base/canonical_json.h"
#include "base/error.h"

namespace seedframe {

enum class ImageFormat { kPng, kJpeg, kWebp, kTiff };
enum class TiffCompression { kNone, kLzw, kZip };

/// What is of no meaning to the format keeps its default.
struct ImageEncoding {
  ImageFormat format = ImageFormat::kPng;
  int quality = 95;  ///< of JPEG and WebP, 1 … 100
  /// Of PNG: the level of zlib, 0 … 9; none: fast (docs/formats/images.md).
  std::optional<int> compression = std::nullopt;
  TiffCompression tiff = TiffCompression::kZip;

  bool operator==(const ImageEncoding&) const = default;
};

/// "png", "jpeg", "webp", "tiff".
const char* name_of(ImageFormat format);
std::optional<ImageFormat> image_format_of(const std::string& name);
/// "none", "lzw", "zip".
const char* name_of(TiffCompression compression);
std::optional<TiffCompression> tiff_compression_of(const std::string& name);

/// Of its files: ".png", ".jpg", ".webp", ".tif".
const char* ending_of(ImageFormat format);

/// Whether pixels may come back as others.
bool is_lossy(const ImageEncoding& encoding);
/// "jpeg, quality 95".
std::string describe(const ImageEncoding& encoding);

/// The format, and what decides about its bytes: {"format": "jpeg", "quality": 95}.
Json to_json(const ImageEncoding& encoding);
/// Reads what to_json wrote; the error (kCorrupt) names `what`.
Result<ImageEncoding> image_encoding_from_json(const Json& json, const std::string& what);

}  // namespace seedframe
