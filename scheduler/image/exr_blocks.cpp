#include "image/exr_blocks.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <libdeflate.h>

#include "image/exr_input.h"

namespace seedframe {
namespace {

/// Of the run lengths of OpenEXR: 256 - n and n bytes, or n < 128 and a byte that stands n + 1
/// times.
bool unpacks_by_rle(std::string_view packed, std::size_t expected) {
  std::size_t unpacked = 0;
  while (!packed.empty()) {
    const std::size_t code = static_cast<unsigned char>(packed.front());
    const bool alike = code < 128;
    const std::size_t taken = alike ? 1 : 256 - code;
    if (packed.size() - 1 < taken) return false;
    packed.remove_prefix(1 + taken);
    unpacked += alike ? code + 1 : taken;
  }
  return unpacked == expected;
}

/// Unpacks blocks of one file, one after the other.
class BlockCheck {
 public:
  BlockCheck() : inflater_(libdeflate_alloc_decompressor()) {}
  ~BlockCheck() { libdeflate_free_decompressor(inflater_); }
  BlockCheck(const BlockCheck&) = delete;
  BlockCheck& operator=(const BlockCheck&) = delete;

  bool is_whole(std::string_view packed, std::size_t expected, Imf::Compression compression) {
    if (packed.size() == expected) return true;  // what would not become smaller is stored as it is
    if (packed.size() > expected) return false;
    switch (compression) {
      case Imf::RLE_COMPRESSION:
        return unpacks_by_rle(packed, expected);
      case Imf::ZIPS_COMPRESSION:
      case Imf::ZIP_COMPRESSION:
        return unpacks_by_zip(packed, expected);
      default:
        return false;
    }
  }

 private:
  bool unpacks_by_zip(std::string_view packed, std::size_t expected) {
    if (inflater_ == nullptr) return false;
    scratch_.resize(expected);
    std::size_t unpacked = 0;
    return libdeflate_zlib_decompress(inflater_, packed.data(), packed.size(), scratch_.data(),
                                      expected, &unpacked) == LIBDEFLATE_SUCCESS &&
           unpacked == expected;
  }

  libdeflate_decompressor* inflater_;
  std::vector<unsigned char> scratch_;
};

}  // namespace

const char* exr_block_fault(std::string_view bytes, const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  const auto width = static_cast<std::size_t>(std::int64_t{window.max.x} - window.min.x + 1);
  const auto height = static_cast<std::size_t>(std::int64_t{window.max.y} - window.min.y + 1);
  std::size_t bytes_per_line = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    const Imf::Channel& channel = i.channel();
    if (channel.xSampling != 1 || channel.ySampling != 1) {
      return "a channel does not have a value for every pixel";
    }
    bytes_per_line += width * (channel.type == Imf::HALF ? 2 : 4);
  }
  const std::size_t lines = header.compression() == Imf::ZIP_COMPRESSION ? 16 : 1;
  BlockCheck check;
  // The header is followed by the blocks' places in the file; a block is its first line, its length
  // and what is packed.
  std::size_t entry = exr_header_end(bytes);
  for (std::size_t line = 0; line < height; line += lines, entry += 8) {
    if (entry + 8 > bytes.size()) return "it ends in the table of its blocks";
    const std::uint64_t block = little_endian<std::uint64_t>(bytes, entry);
    if (block > bytes.size() || bytes.size() - block < 8) return "it ends before a block of lines";
    const std::size_t length = little_endian<std::uint32_t>(bytes, block + 4);
    if (length > bytes.size() - block - 8) return "it ends in a block of lines";
    const std::size_t expected = bytes_per_line * std::min(lines, height - line);
    if (!check.is_whole(bytes.substr(block + 8, length), expected, header.compression())) {
      return "a block of lines does not hold the values of its channels";
    }
  }
  return nullptr;
}

}  // namespace seedframe
