#include "mesh_files/ply_header.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace {

std::optional<PlyType> parse_type(std::string_view word) {
  constexpr std::pair<std::string_view, PlyType> kNames[] = {
      {"char", PlyType::kInt8},      {"int8", PlyType::kInt8},       {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},    {"short", PlyType::kInt16},     {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16},  {"uint16", PlyType::kUint16},   {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},    {"uint", PlyType::kUint32},     {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat32},  {"float32", PlyType::kFloat32}, {"double", PlyType::kFloat64},
      {"float64", PlyType::kFloat64}};
  for (const auto& [name, type] : kNames) {
    if (name == word) return type;
  }
  return std::nullopt;
}

std::optional<PlyHeader::Format> parse_format(std::string_view word) {
  if (word == "ascii") return PlyHeader::Format::kText;
  if (word == "binary_little_endian") return PlyHeader::Format::kLittleEndian;
  if (word == "binary_big_endian") return PlyHeader::Format::kBigEndian;
  return std::nullopt;
}

std::optional<PlyProperty> parse_property(std::string_view words) {
  PlyProperty property;
  std::string_view word = take_word(words);
  property.is_list = word == "list";
  if (property.is_list) {
    const auto count_type = parse_type(take_word(words));
    if (!count_type || *count_type == PlyType::kFloat32 || *count_type == PlyType::kFloat64) {
      return std::nullopt;
    }
    property.count_type = *count_type;
    word = take_word(words);
  }
  const auto type = parse_type(word);
  property.name = trimmed(words);
  if (!type || property.name.empty()) return std::nullopt;
  property.type = *type;
  return property;
}

// One line of the header; what is wrong with it, or nothing.
std::string parse_line(std::string_view line, PlyHeader& header, bool& has_format) {
  constexpr std::size_t kMostElements = 64;
  constexpr std::size_t kMostProperties = 256;
  const std::string_view keyword = take_word(line);
  if (keyword == "comment" && take_word(line) == "TextureFile") {
    header.images.emplace_back(trimmed(line));
  }
  if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) return {};
  if (keyword == "format") {
    const auto format = parse_format(take_word(line));
    if (!format) return "expected ascii, binary_little_endian or binary_big_endian";
    header.format = *format;
    has_format = true;
    return {};
  }
  if (keyword == "element") {
    PlyElement element{.name = std::string(take_word(line)), .count = 0, .properties = {}};
    const auto count = parse_number<std::uint64_t>(take_word(line));
    if (!count || header.elements.size() == kMostElements) return "expected 'element NAME COUNT'";
    element.count = *count;
    header.elements.push_back(std::move(element));
    return {};
  }
  if (keyword == "property") {
    auto property = parse_property(line);
    const bool placed =
        !header.elements.empty() && header.elements.back().properties.size() < kMostProperties;
    if (!property || !placed) return "expected 'property TYPE NAME' below an element";
    header.elements.back().properties.push_back(std::move(*property));
    return {};
  }
  return "expected format, element, property, comment or end_header";
}

}  // namespace

std::size_t bytes_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      return 8;
  }
  return 8;
}

int PlyElement::find(const std::vector<std::string_view>& names) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (std::find(names.begin(), names.end(), properties[i].name) != names.end()) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

Result<PlyHeader> take_ply_header(std::string_view& rest, const std::string& file) {
  PlyHeader header;
  header.lines = 1;
  rest = without_byte_order_mark(rest);
  if (trimmed(take_line(rest)) != "ply") {
    return fail(ErrorKind::kInput, "{}:1: expected 'ply' on a line of its own", file);
  }
  bool has_format = false;
  while (!rest.empty()) {
    const std::string_view line = trimmed(take_line(rest));
    ++header.lines;
    if (line == "end_header") {
      if (has_format) return header;
      return fail(ErrorKind::kInput, "{}: the header has no line 'format'", file);
    }
    const std::string wrong = parse_line(line, header, has_format);
    if (wrong.empty()) continue;
    return fail(ErrorKind::kInput, "{}:{}: {}, found '{}'", file, header.lines, wrong,
                line.substr(0, 60));
  }
  return fail(ErrorKind::kInput, "{}: cut short: the header has no line 'end_header'", file);
}

}  // namespace seedframe
