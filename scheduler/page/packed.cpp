#include "page/packed.h"

#include <bit>
#include <cassert>

#include <zlib.h>

namespace seedframe {

static_assert(std::endian::native == std::endian::little, "columns are little-endian");

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::size_t kGroup = 3;
  std::string text;
  text.reserve((bytes.size() + kGroup - 1) / kGroup * 4);
  for (std::size_t i = 0; i < bytes.size(); i += kGroup) {
    const std::size_t there = std::min(kGroup, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < kGroup; ++k) {
      group = group << 8U | (k < there ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= there ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

std::string packed(std::string_view bytes) {
  std::string deflated(::compressBound(bytes.size()), '\0');
  uLongf size = deflated.size();
  [[maybe_unused]] const int done =
      ::compress2(reinterpret_cast<Bytef*>(deflated.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 7);
  assert(done == Z_OK);  // it has room for the worst case
  deflated.resize(size);
  return base64(deflated);
}

Json packed_column(const char* type, std::string_view bytes, std::size_t count) {
  return {{"type", type}, {"count", count}, {"data", packed(bytes)}};
}

}  // namespace seedframe
