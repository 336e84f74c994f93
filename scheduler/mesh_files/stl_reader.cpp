// Our own reader, because CGAL's takes a binary file's triangle count on trust and reads what is
// left of a file that was cut short.
#include "mesh_files/stl_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "base/files.h"
#include "mesh_files/byte_reader.h"
#include "mesh_files/mesh_builder.h"
#include "mesh_files/position_welder.h"
#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace {

constexpr std::size_t kBinaryHeaderBytes = 84;  // 80 of text and the number of triangles
constexpr std::size_t kTriangleBytes = 50;

Result<FileMesh> read_binary(std::string_view bytes, const std::string& file) {
  MeshBuilder builder(file);
  const auto count = value_from<std::uint32_t>(bytes.substr(80));
  const std::size_t expected = kBinaryHeaderBytes + kTriangleBytes * std::size_t{count};
  if (bytes.size() != expected) {
    return builder.fail_at("",
                           "a binary STL of {} triangles takes {} bytes, but there are {}: the "
                           "file is cut short or damaged",
                           count, expected, bytes.size());
  }
  PositionWelder welder(builder);
  for (std::size_t t = 0; t < count; ++t) {
    // A normal of three floats comes before the corners.
    std::string_view rest = bytes.substr(kBinaryHeaderBytes + t * kTriangleBytes + 12, 36);
    std::array<PolygonCorner, 3> triangle;
    for (PolygonCorner& corner : triangle) {
      std::array<double, 3> position{};
      for (double& value : position) {
        const float stored = *take_value<float>(rest);
        builder.stored_as(stored);
        value = stored;
      }
      corner.position = welder.index_of(position);
    }
    if (bytes[kBinaryHeaderBytes + t * kTriangleBytes + 49] < 0) {
      builder.not_kept("colours of triangles");
    }
    if (Status status = builder.add_polygon(triangle, fmt::format("triangle {}", t)); !status) {
      return forward_error(status);
    }
  }
  return builder.finish("one triangle or more");
}

std::optional<std::array<double, 3>> parse_vertex(std::string_view words) {
  std::array<double, 3> position{};
  for (double& value : position) {
    const auto number = parse_number<double>(take_word(words));
    if (!number || !std::isfinite(static_cast<float>(*number))) return std::nullopt;
    value = *number;
  }
  if (!trimmed(words).empty()) return std::nullopt;
  return position;
}

class TextParser {
 public:
  explicit TextParser(const std::string& file) : builder_(file), welder_(builder_) {}

  Result<FileMesh> parse(std::string_view text) {
    while (!text.empty()) {
      ++line_number_;
      if (Status status = parse_line(trimmed(take_line(text))); !status) {
        return forward_error(status);
      }
    }
    if (!ended_) {
      return builder_.fail_at(std::to_string(line_number_),
                              "expected 'endsolid' at the end: the file is cut short");
    }
    return builder_.finish("lines like 'vertex 0 0 0' between 'outer loop' and 'endloop'");
  }

 private:
  Status parse_line(std::string_view line) {
    std::string_view words = line;
    const std::string_view keyword = take_word(words);
    const auto is = [keyword](std::string_view word) { return equals_in_any_case(keyword, word); };
    if (is("vertex")) return parse_corner(words);
    if (is("endloop")) return end_loop();
    if (is("solid")) ended_ = false;
    if (is("endsolid")) ended_ = true;
    const bool known = keyword.empty() || is("solid") || is("endsolid") || is("facet") ||
                       is("outer") || is("endfacet");
    if (known) return {};
    return builder_.fail_at(std::to_string(line_number_),
                            "expected 'facet', 'vertex' or another word of STL, found '{}'",
                            line.substr(0, 40));
  }

  Status parse_corner(std::string_view words) {
    const auto position = parse_vertex(words);
    if (!position) {
      return builder_.fail_at(std::to_string(line_number_),
                              "expected three finite numbers, found '{}'", words.substr(0, 80));
    }
    corners_.push_back({.position = welder_.index_of(*position)});
    return {};
  }

  Status end_loop() {
    Status added = builder_.add_polygon(corners_, std::to_string(line_number_));
    corners_.clear();
    return added;
  }

  MeshBuilder builder_;
  PositionWelder welder_;
  std::vector<PolygonCorner> corners_;
  std::size_t line_number_ = 0;
  bool ended_ = false;
};

bool has_binary_length(std::string_view bytes) {
  if (bytes.size() < kBinaryHeaderBytes) return false;
  const auto count = value_from<std::uint32_t>(bytes.substr(80));
  return bytes.size() == kBinaryHeaderBytes + kTriangleBytes * std::size_t{count};
}

// Binary files, too, may begin with "solid": what decides is whether the length fits the count.
bool is_text(std::string_view bytes) {
  if (has_binary_length(bytes)) return false;
  std::string_view start = without_byte_order_mark(bytes.substr(0, 1024));
  if (start.find('\0') != std::string_view::npos) return false;
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n\v\f"), start.size()));
  return equals_in_any_case(start.substr(0, 5), "solid");
}

}  // namespace

Result<FileMesh> read_stl(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return forward_error(bytes);
  const std::string file = path.string();
  if (!has_binary_length(*bytes) && is_utf16(*bytes)) return fail_as_utf16(file);
  if (is_text(*bytes)) return TextParser(file).parse(without_byte_order_mark(*bytes));
  if (bytes->size() < kBinaryHeaderBytes) {
    return fail(ErrorKind::kInput,
                "{}: {} bytes are not an STL file: expected 'solid' or a header of {} bytes", file,
                bytes->size(), kBinaryHeaderBytes);
  }
  return read_binary(*bytes, file);
}

}  // namespace seedframe
