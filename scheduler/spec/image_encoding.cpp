#include "spec/image_encoding.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace seedframe {
namespace {

struct FormatNames {
  const char* name;
  const char* ending;
};
constexpr std::array<FormatNames, 4> kFormats = {
    {{"png", ".png"}, {"jpeg", ".jpg"}, {"webp", ".webp"}, {"tiff", ".tif"}}};
constexpr std::array<const char*, 3> kTiffCompressions = {"none", "lzw", "zip"};

}  // namespace

const char* name_of(ImageFormat format) { return kFormats[static_cast<std::size_t>(format)].name; }

std::optional<ImageFormat> image_format_of(const std::string& name) {
  const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const FormatNames& each) { return each.name == name; });
  if (found == kFormats.end()) return std::nullopt;
  return static_cast<ImageFormat>(found - kFormats.begin());
}

const char* name_of(TiffCompression compression) {
  return kTiffCompressions[static_cast<std::size_t>(compression)];
}

std::optional<TiffCompression> tiff_compression_of(const std::string& name) {
  const auto found = std::find(kTiffCompressions.begin(), kTiffCompressions.end(), name);
  if (found == kTiffCompressions.end()) return std::nullopt;
  return static_cast<TiffCompression>(found - kTiffCompressions.begin());
}

const char* ending_of(ImageFormat format) {
  return kFormats[static_cast<std::size_t>(format)].ending;
}

bool is_lossy(const ImageEncoding& encoding) {
  return encoding.format == ImageFormat::kJpeg || encoding.format == ImageFormat::kWebp;
}

std::string describe(const ImageEncoding& encoding) {
  std::string text = name_of(encoding.format);
  if (is_lossy(encoding)) return text + fmt::format(", quality {}", encoding.quality);
  if (encoding.format == ImageFormat::kTiff) {
    return text + fmt::format(", compression {}", name_of(encoding.tiff));
  }
  return encoding.compression ? text + fmt::format(", compression {}", *encoding.compression)
                              : text;
}

Json to_json(const ImageEncoding& encoding) {
  Json json = {{"format", name_of(encoding.format)}};
  if (is_lossy(encoding)) json["quality"] = encoding.quality;
  if (encoding.compression) json["compression"] = *encoding.compression;
  if (encoding.format == ImageFormat::kTiff) json["compression"] = name_of(encoding.tiff);
  return json;
}

Result<ImageEncoding> image_encoding_from_json(const Json& json, const std::string& what) {
  ImageEncoding encoding;
  try {
    const auto format = image_format_of(json.at("format").get<std::string>());
    if (!format) {
      return fail(ErrorKind::kCorrupt, "{}: '{}' is no format of images that this program knows",
                  what, json.at("format").get<std::string>());
    }
    encoding.format = *format;
    if (is_lossy(encoding)) encoding.quality = integer_of<int>(json.at("quality"));
    if (*format == ImageFormat::kPng && json.contains("compression")) {
      encoding.compression = integer_of<int>(json.at("compression"));
    }
    if (*format == ImageFormat::kTiff) {
      const auto tiff = tiff_compression_of(json.at("compression").get<std::string>());
      if (!tiff) return fail(ErrorKind::kCorrupt, "{}: an unknown compression of TIFF", what);
      encoding.tiff = *tiff;
    }
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: its image: {}", what, error.what());
  }
  return encoding;
}

}  // namespace seedframe
