// Numbers and bytes as text that a page can hold: zlib (RFC 1950), then base64 (RFC 4648).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/canonical_json.h"

namespace seedframe {

std::string base64(std::string_view bytes);

/// The same bytes give the same text, with the same zlib.
std::string packed(std::string_view bytes);

/// {"type": "uint16", "count": 12, "data": "eJx…"}: little-endian, `type` as JavaScript's typed
/// arrays are called.
Json packed_column(const char* type, std::string_view bytes, std::size_t count);

template <class T>
Json column_of(const std::vector<T>& values) {
  static_assert(std::is_same_v<T, std::uint8_t> || std::is_same_v<T, std::uint16_t> ||
                std::is_same_v<T, std::uint32_t> || std::is_same_v<T, std::int32_t> ||
                std::is_same_v<T, float>);
  const char* type = "float32";
  if constexpr (std::is_same_v<T, std::uint8_t>) type = "uint8";
  if constexpr (std::is_same_v<T, std::uint16_t>) type = "uint16";
  if constexpr (std::is_same_v<T, std::uint32_t>) type = "uint32";
  if constexpr (std::is_same_v<T, std::int32_t>) type = "int32";
  return packed_column(type,
                       {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)},
                       values.size());
}

}  // namespace seedframe
