#include "assets/image_check.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"
#include "image_files/image_reader.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Of the rules below: raised when they become stricter, so that what is remembered is forgotten.
constexpr int kRulesVersion = 1;

bool has(const ImageHeader& header, const char* channel) {
  return std::find(header.channels.begin(), header.channels.end(), channel) !=
         header.channels.end();
}

/// Of kinds whose channels have names, which are the EXR files.
Status check_exr_channels(const ImageHeader& header, ImageUse use, const std::string& what) {
  const auto in_layer = [](const std::string& name) { return name.find('.') != std::string::npos; };
  const auto layered = std::find_if(header.channels.begin(), header.channels.end(), in_layer);
  if (layered != header.channels.end()) {
    return fail(ErrorKind::kInput,
                "{} has its channels in layers, as {}: save red, green and blue alone, as R, G and "
                "B",
                what, *layered);
  }
  if (has(header, "R") && has(header, "G") && has(header, "B")) return {};
  const bool is_gray = has(header, "Y") && header.channels.size() == 1;
  if (is_gray && use != ImageUse::kEnvironment) return {};
  return fail(ErrorKind::kInput, "{} has {}, where R, G and B are needed: save it as RGB", what,
              is_gray ? "luminance alone (Y)" : "other channels");
}

Status check_channels(const ImageHeader& header, ImageKind kind, ImageUse use,
                      const std::string& what) {
  if (kind == ImageKind::kExr) return check_exr_channels(header, use, what);
  const std::size_t most = kind == ImageKind::kJpeg ? 3 : 4;
  if (header.channels.size() <= most) return {};
  return fail(ErrorKind::kInput, "{} has {} channels (CMYK?): save it as RGB", what,
              header.channels.size());
}

Status check_header(const ImageHeader& header, ImageKind kind, ImageUse use,
                    const std::string& what) {
  if (header.has_more_images) {
    return fail(ErrorKind::kInput, "{} holds several images: save the one that is meant", what);
  }
  const bool says_linear = kind == ImageKind::kExr || kind == ImageKind::kHdr;
  if (use == ImageUse::kEnvironment && !says_linear) {
    return fail(ErrorKind::kInput, "{}: an environment map is an .exr or .hdr file", what);
  }
  if (header.is_float() && !says_linear) {
    return fail(ErrorKind::kInput, "{} holds floats: save it as EXR, or with 8 or 16 bits", what);
  }
  return check_channels(header, kind, use, what);
}

Status check_values(int first_row, const Image<float>& rows, ImageUse use,
                    const std::string& what) {
  const bool may_be_negative = use == ImageUse::kData;
  for (std::size_t i = 0; i < rows.values.size(); ++i) {
    const float value = rows.values[i];
    if (std::isfinite(value) && (value >= 0.0F || may_be_negative)) continue;
    const std::size_t pixel = i / static_cast<std::size_t>(rows.channels);
    const auto width = static_cast<std::size_t>(rows.width);
    return fail(ErrorKind::kInput, "{} has a value that is {} in column {} of row {}", what,
                std::isfinite(value) ? "negative"
                : std::isnan(value)  ? "no number (NaN)"
                                     : "infinite",
                pixel % width, static_cast<std::size_t>(first_row) + pixel / width);
  }
  return {};
}

}  // namespace

const char* name_of(ImageUse use) {
  switch (use) {
    case ImageUse::kEnvironment:
      return "environment map";
    case ImageUse::kColor:
      return "colour texture";
    case ImageUse::kData:
      return "texture";
  }
  return "";
}

Status check_image(std::string_view bytes, ImageKind kind, ImageUse use, const std::string& what) {
  ImageVisit visit;
  visit.header = [&](const ImageHeader& header) { return check_header(header, kind, use, what); };
  visit.rows_float = [&](int first_row, const Image<float>& rows) {
    return check_values(first_row, rows, use, what);
  };
  const Result<ImageHeader> header = visit_image(bytes, kind, what, visit);
  return header ? Status() : forward_error(header);
}

fs::path CheckedImages::entry(const std::string& sha256, ImageKind kind, ImageUse use) const {
  const std::string folder = fmt::format("images_{}", kRulesVersion);
  const std::string name =
      fmt::format("{}_{}_{}", sha256, static_cast<int>(kind), static_cast<int>(use));
  return cache_ / folder / sha256.substr(0, 2) / name;
}

bool CheckedImages::is_known_good(const std::string& sha256, ImageKind kind, ImageUse use) const {
  std::error_code error;
  return !cache_.empty() && fs::is_regular_file(entry(sha256, kind, use), error);
}

void CheckedImages::remember_good(const std::string& sha256, ImageKind kind, ImageUse use) const {
  if (cache_.empty()) return;
  const fs::path path = entry(sha256, kind, use);
  // That it is there is all that it says, so an empty file cannot be cut.
  if (make_folders(path.parent_path())) (void)write_file_unsynced(path, "");
}

}  // namespace seedframe
