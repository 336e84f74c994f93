#include "image/exr_compression.h"

#include <cstring>

#include <libdeflate.h>

namespace seedframe {
namespace {

/// Of the run lengths of OpenEXR: 256 - n and n bytes, or n < 128 and a byte that stands n + 1
/// times. Whether they fill `to`.
bool unpack_runs(std::string_view packed, std::vector<char>& to) {
  std::size_t at = 0;
  while (!packed.empty()) {
    const std::size_t code = static_cast<unsigned char>(packed.front());
    const bool alike = code < 128;
    const std::size_t taken = alike ? 1 : 256 - code;
    const std::size_t made = alike ? code + 1 : taken;
    if (packed.size() - 1 < taken || to.size() - at < made) return false;
    if (alike) {
      std::memset(to.data() + at, packed[1], made);
    } else {
      std::memcpy(to.data() + at, packed.data() + 1, made);
    }
    packed.remove_prefix(1 + taken);
    at += made;
  }
  return at == to.size();
}

/// What is packed are differences between bytes, 128 more than they are.
void undo_differences(std::vector<char>& bytes) {
  unsigned last = 128;
  for (char& byte : bytes) {
    last += static_cast<unsigned char>(byte) - 128U;
    byte = static_cast<char>(last);
  }
}

/// The first half of the bytes are those at even places.
void interleave(const std::vector<char>& halves, std::vector<char>& to) {
  const char* even = halves.data();
  const char* odd = even + (halves.size() + 1) / 2;
  const std::size_t pairs = halves.size() / 2;
  char* out = to.data();
  constexpr std::size_t kAtOnce = 16;  // a loop of constant length, which becomes vectors
  std::size_t i = 0;
  for (; i + kAtOnce <= pairs; i += kAtOnce) {
    for (std::size_t j = 0; j < kAtOnce; ++j) {
      out[2 * (i + j)] = even[i + j];
      out[2 * (i + j) + 1] = odd[i + j];
    }
  }
  for (; i < pairs; ++i) {
    out[2 * i] = even[i];
    out[2 * i + 1] = odd[i];
  }
  if (halves.size() % 2 == 1) out[2 * pairs] = even[pairs];
}

}  // namespace

ExrUnpacker::ExrUnpacker(Imf::Compression compression)
    : compression_(compression), inflater_(libdeflate_alloc_decompressor()) {}

ExrUnpacker::~ExrUnpacker() { libdeflate_free_decompressor(inflater_); }

const char* ExrUnpacker::unpack(std::string_view packed, std::size_t expected) {
  if (packed.size() == expected) return packed.data();  // would not have become smaller
  if (packed.size() > expected) return nullptr;
  halves_.resize(expected);
  bytes_.resize(expected);
  switch (compression_) {
    case Imf::RLE_COMPRESSION:
      if (!unpack_runs(packed, halves_)) return nullptr;
      break;
    case Imf::ZIPS_COMPRESSION:
    case Imf::ZIP_COMPRESSION:
      if (!inflate(packed)) return nullptr;
      break;
    default:
      return nullptr;
  }
  undo_differences(halves_);
  interleave(halves_, bytes_);
  return bytes_.data();
}

bool ExrUnpacker::inflate(std::string_view packed) {
  if (inflater_ == nullptr) return false;
  std::size_t unpacked = 0;
  return libdeflate_zlib_decompress(inflater_, packed.data(), packed.size(), halves_.data(),
                                    halves_.size(), &unpacked) == LIBDEFLATE_SUCCESS &&
         unpacked == halves_.size();
}

}  // namespace seedframe
