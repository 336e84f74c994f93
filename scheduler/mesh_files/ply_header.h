// What a PLY file says of itself before its data.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace seedframe {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::size_t bytes_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  ///< of a list: of its values
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Its place in `properties`; -1 if there is none of the names.
  int find(const std::vector<std::string_view>& names) const;
};

struct PlyHeader {
  enum class Format { kText, kLittleEndian, kBigEndian };
  Format format = Format::kText;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;            ///< of the header
  std::vector<std::string> images;  ///< named by comments "TextureFile NAME"
};

/// Takes the header off the front of `rest`. Errors (kInput) name the file and the line.
Result<PlyHeader> take_ply_header(std::string_view& rest, const std::string& file);

}  // namespace seedframe
