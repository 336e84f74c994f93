#include "picture/picture_file.h"

#include <fstream>
#include <optional>
#include <string>

#include <zlib.h>

#include "base/files.h"
#include "image_files/image_writer.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSignature = "drawn by Seedframe";
constexpr int kJpegQuality = 90;

std::optional<ImageFormat> format_of(const fs::path& path) {
  const std::string ending = path.extension();
  if (ending == ".png") return ImageFormat::kPng;
  if (ending == ".jpg" || ending == ".jpeg") return ImageFormat::kJpeg;
  return std::nullopt;
}

std::string big_endian(std::uint32_t number, int bytes) {
  std::string text;
  for (int byte = bytes - 1; byte >= 0; --byte) {
    text += static_cast<char>((number >> (8 * static_cast<unsigned>(byte))) & 0xFFU);
  }
  return text;
}

/// A comment of PNG (tEXt, behind the header) or JPEG (COM, behind JFIF's).
std::string sign(std::string bytes, ImageFormat format) {
  constexpr std::size_t kPngHeader = 33;
  if (format == ImageFormat::kPng) {
    const std::string body = std::string("tEXtSoftware") + '\0' + kSignature;
    const auto crc = static_cast<std::uint32_t>(
        ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
    const auto length = static_cast<std::uint32_t>(body.size() - 4);
    return bytes.insert(kPngHeader, big_endian(length, 4) + body + big_endian(crc, 4));
  }
  std::size_t at = 2;
  if (bytes.size() > 6 && bytes[2] == '\xFF' && bytes[3] == '\xE0') {
    at = 4 + 256 * static_cast<std::size_t>(static_cast<unsigned char>(bytes[4])) +
         static_cast<unsigned char>(bytes[5]);
  }
  const std::string comment = kSignature;
  return bytes.insert(
      at, "\xFF\xFE" + big_endian(static_cast<std::uint32_t>(comment.size() + 2), 2) + comment);
}

bool is_signed(const fs::path& path) {
  std::string begin(128, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin.find(kSignature) != std::string::npos;
}

}  // namespace

Status check_picture_file(const fs::path& path, bool overwrite) {
  if (!format_of(path)) {
    return fail(ErrorKind::kInput, "{}: expected a name that ends in .png or .jpg", path.string());
  }
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (!fs::exists(status)) return {};
  if (!fs::is_regular_file(status)) {
    return fail(ErrorKind::kInput, "{} is there, and no file: name another one with -o",
                path.string());
  }
  if (overwrite || is_signed(path)) return {};
  return fail(ErrorKind::kInput,
              "{} is there, and no picture that Seedframe drew: name another file with -o, or give "
              "--overwrite",
              path.string());
}

Status write_picture(const Image<std::uint8_t>& image, const fs::path& path, bool overwrite) {
  if (Status possible = check_picture_file(path, overwrite); !possible) return possible;
  const ImageFormat format = *format_of(path);
  const Result<std::string> bytes =
      encode_image(image, {.format = format, .quality = kJpegQuality});
  if (!bytes) return forward_error(bytes);
  return write_file_atomically(path, sign(*bytes, format));
}

}  // namespace seedframe
