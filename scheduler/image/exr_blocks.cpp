#include "image/exr_blocks.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <vector>

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>

#include "image/exr_compression.h"
#include "image/exr_input.h"

namespace seedframe {
namespace {

constexpr std::size_t size_of(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

/// A channel of the file, in the file's order.
struct StoredChannel {
  Imf::PixelType type;
  const Imf::Slice* to;  ///< null: not wanted
};

template <class T>
T value_at(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // little-endian, as all that this is built for
  return value;
}

float half_at(const char* bytes) {
  half value;
  value.setBits(value_at<std::uint16_t>(bytes));
  return value;
}

template <class Convert>
void copy_values(const char* from, std::size_t bytes_each, std::size_t count, char* to,
                 std::size_t stride, const Convert& convert) {
  for (std::size_t i = 0; i < count; ++i, from += bytes_each, to += stride) {
    const float value = convert(from);
    std::memcpy(to, &value, sizeof value);
  }
}

void copy_line(const char* from, const StoredChannel& channel, int x, int y, std::size_t width) {
  const Imf::Slice& slice = *channel.to;
  assert(slice.type == Imf::FLOAT);
  char* to = slice.base + static_cast<std::ptrdiff_t>(slice.xStride) * x +
             static_cast<std::ptrdiff_t>(slice.yStride) * y;
  switch (channel.type) {
    case Imf::HALF:
      return copy_values(from, 2, width, to, slice.xStride, half_at);
    case Imf::UINT:
      return copy_values(from, 4, width, to, slice.xStride, [](const char* bytes) {
        return static_cast<float>(value_at<std::uint32_t>(bytes));
      });
    default:
      return copy_values(from, 4, width, to, slice.xStride, value_at<float>);
  }
}

}  // namespace

const char* read_exr_blocks(std::string_view bytes, const Imf::Header& header,
                            const Imf::FrameBuffer& buffer) {
  const Imath::Box2i& window = header.dataWindow();
  const auto width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1);
  const auto height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y + 1);
  std::size_t bytes_per_line = 0;
  std::vector<StoredChannel> channels;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    const Imf::Channel& channel = i.channel();
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      return "a channel does not have a value for every pixel";
    }
    bytes_per_line += width * size_of(channel.type);
    channels.push_back({channel.type, buffer.findSlice(i.name())});
  }
  const std::size_t lines = header.compression() == Imf::ZIP_COMPRESSION ? 16 : 1;
  ExrUnpacker unpacker(header.compression());
  // The header is followed by the blocks' places in the file; a block is its first line, its length
  // and what is packed.
  std::size_t entry = exr_header_end(bytes);
  for (std::size_t line = 0; line < height; line += lines, entry += 8) {
    if (entry + 8 > bytes.size()) return "it ends in the table of its blocks";
    const std::uint64_t block = little_endian<std::uint64_t>(bytes, entry);
    if (block > bytes.size() || bytes.size() - block < 8) return "it ends before a block of lines";
    const std::size_t length = little_endian<std::uint32_t>(bytes, block + 4);
    if (length > bytes.size() - block - 8) return "it ends in a block of lines";
    const int first_y = window.min.y + static_cast<int>(line);
    if (little_endian<std::uint32_t>(bytes, block) != static_cast<std::uint32_t>(first_y)) {
      return "a block of lines is not that of its place";
    }
    const std::size_t in_block = std::min(lines, height - line);
    const char* from = unpacker.unpack(bytes.substr(block + 8, length), bytes_per_line * in_block);
    if (from == nullptr) return "a block of lines does not hold the values of its channels";
    for (std::size_t i = 0; i < in_block; ++i) {
      for (const StoredChannel& channel : channels) {
        if (channel.to != nullptr) {
          copy_line(from, channel, window.min.x, first_y + static_cast<int>(i), width);
        }
        from += width * size_of(channel.type);
      }
    }
  }
  return nullptr;
}

}  // namespace seedframe
