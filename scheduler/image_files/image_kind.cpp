#include "image_files/image_kind.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace seedframe {
namespace {

struct Ending {
  const char* text;
  ImageKind kind;
};

constexpr std::array<Ending, 10> kEndings = {{{".png", ImageKind::kPng},
                                              {".jpg", ImageKind::kJpeg},
                                              {".jpeg", ImageKind::kJpeg},
                                              {".tif", ImageKind::kTiff},
                                              {".tiff", ImageKind::kTiff},
                                              {".exr", ImageKind::kExr},
                                              {".hdr", ImageKind::kHdr},
                                              {".webp", ImageKind::kWebp},
                                              {".tga", ImageKind::kTga},
                                              {".bmp", ImageKind::kBmp}}};

constexpr std::array<ImageKind, 7> kWithSignature = {
    ImageKind::kPng, ImageKind::kJpeg, ImageKind::kTiff, ImageKind::kExr,
    ImageKind::kHdr, ImageKind::kWebp, ImageKind::kBmp};

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

std::optional<ImageKind> image_kind_of(const std::filesystem::path& file) {
  const std::string ending = lower_case(file.extension().string());
  for (const Ending& known : kEndings) {
    if (ending == known.text) return known.kind;
  }
  return std::nullopt;
}

const char* name_of(ImageKind kind) {
  switch (kind) {
    case ImageKind::kPng:
      return "PNG";
    case ImageKind::kJpeg:
      return "JPEG";
    case ImageKind::kTiff:
      return "TIFF";
    case ImageKind::kExr:
      return "OpenEXR file";
    case ImageKind::kHdr:
      return "Radiance file";
    case ImageKind::kWebp:
      return "WebP";
    case ImageKind::kTga:
      return "TGA";
    case ImageKind::kBmp:
      return "BMP";
  }
  return "";
}

std::string image_endings() {
  std::string text;
  for (const Ending& known : kEndings) text += (text.empty() ? "" : ", ") + std::string(known.text);
  return text;
}

bool begins_like(std::string_view bytes, ImageKind kind) {
  using namespace std::string_view_literals;
  switch (kind) {
    case ImageKind::kPng:
      return bytes.starts_with("\x89PNG\r\n\x1a\n"sv);
    case ImageKind::kJpeg:
      return bytes.starts_with("\xff\xd8\xff"sv);
    case ImageKind::kTiff:
      return bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv) ||
             bytes.starts_with("II+\0"sv) || bytes.starts_with("MM\0+"sv);
    case ImageKind::kExr:
      return bytes.starts_with("\x76\x2f\x31\x01"sv);
    case ImageKind::kHdr:
      return bytes.starts_with("#?RADIANCE"sv) || bytes.starts_with("#?RGBE"sv);
    case ImageKind::kWebp:
      return bytes.starts_with("RIFF"sv) && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP"sv;
    case ImageKind::kBmp:
      return bytes.starts_with("BM"sv);
    case ImageKind::kTga:
      return true;
  }
  return false;
}

std::string what_bytes_look_like(std::string_view bytes) {
  if (bytes.empty()) return "empty";
  if (bytes.starts_with("version https://git-lfs.")) {
    return "a Git LFS pointer: 'git lfs pull' fetches the file itself";
  }
  for (const ImageKind kind : kWithSignature) {
    if (begins_like(bytes, kind)) return std::string("a ") + name_of(kind);
  }
  const std::size_t text = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  const std::string start =
      text == std::string_view::npos ? "" : lower_case(std::string(bytes.substr(text, 14)));
  if (start.starts_with("<!doctype html") || start.starts_with("<html") ||
      start.starts_with("<head")) {
    return "an HTML page: the download went wrong";
  }
  const std::string_view first = bytes.substr(0, 4096);
  if (std::all_of(first.begin(), first.end(), [](char c) { return c == 0; })) {
    return "full of zeros";
  }
  return "";
}

}  // namespace seedframe
