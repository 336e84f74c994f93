#include "image/exr_input.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <OpenEXR/ImfChannelList.h>

namespace seedframe {
namespace {

/// OpenEXR reads these types without a look at the stated length: with another one it would take
/// the middle of a value for the next attribute, and its bytes for a length.
constexpr std::pair<std::string_view, std::size_t> kLengths[] = {
    {"box2f", 16},      {"box2i", 16},   {"chromaticities", 32},
    {"compression", 1}, {"double", 8},   {"envmap", 1},
    {"float", 4},       {"int", 4},      {"keycode", 28},
    {"lineOrder", 1},   {"m33d", 72},    {"m33f", 36},
    {"m44d", 128},      {"m44f", 64},    {"rational", 8},
    {"v2d", 16},        {"timecode", 8}, {"v2f", 8},
    {"v2i", 8},         {"v3d", 24},     {"v3f", 12},
    {"tiledesc", 9},    {"v3i", 12},     {"deepImageState", 1},
};

/// Types with counts inside, which no frame has: each would need a reader of its own.
constexpr std::string_view kRefused[] = {"floatvector", "idmanifest", "preview", "stringvector"};

/// Channels of a name, its end and 16 bytes each; an empty name ends them.
bool is_channel_list(std::string_view value) {
  constexpr std::size_t kDescription = 16;
  while (!value.empty() && value.front() != '\0') {
    const std::size_t end = value.find('\0');
    if (end == std::string_view::npos || value.size() - end - 1 < kDescription) return false;
    value.remove_prefix(end + 1 + kDescription);
  }
  return value.size() == 1;
}

const char* attribute_fault(std::string_view type, std::string_view value) {
  if (type == "chlist") return is_channel_list(value) ? nullptr : "its list of channels is damaged";
  if (std::find(std::begin(kRefused), std::end(kRefused), type) != std::end(kRefused)) {
    return "it has an attribute of a type that no frame has";
  }
  for (const auto& [known, length] : kLengths) {
    if (type == known && value.size() != length)
      return "an attribute does not have the length of its type";
  }
  return nullptr;
}

/// Returns what is wrong, or null and where the header ends.
const char* walk_header(std::string_view bytes, std::size_t& end) {
  constexpr std::uint32_t kMagic = 20000630;
  constexpr std::uint32_t kTiled = 0x200, kDeep = 0x800, kMultiPart = 0x1000;
  if (bytes.empty()) return "the file is empty";
  if (bytes.size() < 8) return "the file ends inside its header";
  if (little_endian<std::uint32_t>(bytes, 0) != kMagic) return "this is no OpenEXR file";
  if ((little_endian<std::uint32_t>(bytes, 4) & (kTiled | kDeep | kMultiPart)) != 0) {
    return "expected one part of scan lines, found tiles, deep pixels or several parts";
  }
  // Name, type, length and value of each attribute; an empty name ends them.
  std::size_t at = 8;
  while (at < bytes.size() && bytes[at] != '\0') {
    const std::size_t name_end = bytes.find('\0', at);
    if (name_end == std::string_view::npos) return "the file ends inside its header";
    const std::size_t type_end = bytes.find('\0', name_end + 1);
    if (type_end == std::string_view::npos || bytes.size() - type_end < 5) {
      return "the file ends inside its header";
    }
    const std::size_t value = type_end + 5;
    const std::size_t length = little_endian<std::uint32_t>(bytes, type_end + 1);
    if (length > bytes.size() - value) return "an attribute is longer than the file";
    const std::string_view type = bytes.substr(name_end + 1, type_end - name_end - 1);
    if (const char* fault = attribute_fault(type, bytes.substr(value, length))) return fault;
    at = value + length;
  }
  end = at + 1;
  return at < bytes.size() ? nullptr : "the file ends inside its header";
}

}  // namespace

bool ExrMemoryInput::read(char to[], int count) {
  const auto size = static_cast<std::size_t>(count);
  if (count < 0 || position_ > bytes_.size() || size > bytes_.size() - position_) {
    throw std::runtime_error("the file ends too early");
  }
  std::memcpy(to, bytes_.data() + position_, size);
  position_ += size;
  return position_ < bytes_.size();
}

const char* exr_header_fault(std::string_view bytes) {
  std::size_t end = 0;
  return walk_header(bytes, end);
}

std::size_t exr_header_end(std::string_view bytes) {
  std::size_t end = 0;
  walk_header(bytes, end);
  return end;
}

const char* exr_size_fault(const Imf::Header& header, std::size_t file_bytes) {
  // Deflate's best is 1032 : 1 (zlib, "Maximum Compression Factor"); run lengths stay below it.
  constexpr double kBestCompression = 1100.0;
  const Imath::Box2i& window = header.dataWindow();
  // As doubles: the product of two sides and the channels does not fit any integer.
  const double width = static_cast<double>(window.max.x) - window.min.x + 1.0;
  const double height = static_cast<double>(window.max.y) - window.min.y + 1.0;
  double bytes_per_pixel = 0.0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    bytes_per_pixel += i.channel().type == Imf::HALF ? 2.0 : 4.0;
  }
  const double most = kBestCompression * static_cast<double>(file_bytes);
  return width * height * bytes_per_pixel <= most ? nullptr
                                                  : "it claims more pixels than it could hold";
}

}  // namespace seedframe
