// Numbers of binary files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string_view>
#include <type_traits>

namespace seedframe {

/// The T at the front of `bytes`, which must be long enough.
template <class T>
T value_from(std::string_view bytes, bool big_endian = false) {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(std::endian::native == std::endian::little, "written for little-endian machines");
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), bytes.data(), sizeof(T));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// Takes a T off the front of `bytes`; nothing if they are too few.
template <class T>
std::optional<T> take_value(std::string_view& bytes, bool big_endian = false) {
  if (bytes.size() < sizeof(T)) return std::nullopt;
  const T value = value_from<T>(bytes, big_endian);
  bytes.remove_prefix(sizeof(T));
  return value;
}

}  // namespace seedframe
