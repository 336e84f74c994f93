// Our own reader, because CGAL's reserves what the header claims and drops UVs.
#include "mesh_files/off_reader.h"

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "base/files.h"
#include "mesh_files/mesh_builder.h"
#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace {

class OffParser {
 public:
  OffParser(const std::string& file, std::string_view text) : builder_(file), rest_(text) {}

  Result<FileMesh> parse() {
    for (const auto part :
         {&OffParser::parse_header, &OffParser::parse_vertices, &OffParser::parse_faces}) {
      if (Status status = (this->*part)(); !status) return forward_error(status);
    }
    return builder_.finish("lines like '3 0 1 2' behind the vertices");
  }

 private:
  template <class... Args>
  tl::unexpected<Error> fail_here(fmt::format_string<Args...> format, Args&&... args) const {
    return builder_.fail_at(std::to_string(line_number_), "{}",
                            fmt::format(format, std::forward<Args>(args)...));
  }

  // The next line with something on it besides a comment; false at the end of the file.
  bool next_line() {
    while (!rest_.empty()) {
      const std::string_view line = take_line(rest_);
      ++line_number_;
      line_ = trimmed(line.substr(0, line.find('#')));
      if (!line_.empty()) return true;
    }
    return false;
  }

  Status parse_header() {
    if (!next_line()) return fail_here("the file is empty: expected 'OFF'");
    std::string_view kind = take_word(line_);
    has_uvs_ = kind.starts_with("ST");
    if (has_uvs_) kind.remove_prefix(2);
    while (kind.starts_with('C') || kind.starts_with('N')) {
      builder_.not_kept(kind.starts_with('C') ? "vertex colours" : kNormals);
      kind.remove_prefix(1);
    }
    if (kind != "OFF" || trimmed(line_).starts_with("BINARY")) {
      return fail_here("expected 'OFF', 'COFF', 'NOFF' or 'STOFF' as text, found '{}'",
                       kind.substr(0, 40));
    }
    // The numbers may stand beside the word.
    if (trimmed(line_).empty() && !next_line())
      return fail_here("the numbers of vertices and faces are missing");
    const auto vertices = parse_number<std::uint32_t>(take_word(line_));
    const auto faces = parse_number<std::uint32_t>(take_word(line_));
    if (!vertices || !faces) return fail_here("expected the numbers of vertices and faces");
    vertex_count_ = *vertices;
    face_count_ = *faces;
    return {};
  }

  Status parse_vertices() {
    for (std::uint32_t i = 0; i < vertex_count_; ++i) {
      if (!next_line()) {
        return fail_here("cut short: {} vertices promised, {} found", vertex_count_, i);
      }
      numbers_.clear();
      while (!trimmed(line_).empty()) {
        const std::string_view word = take_word(line_);
        const auto number = parse_number<double>(word);
        const bool is_coordinate = numbers_.size() < 3;  // colours, normals and UVs follow
        if (is_coordinate && (!number || !std::isfinite(static_cast<float>(*number)))) {
          return fail_here("expected a finite number, found '{}'", word.substr(0, 40));
        }
        numbers_.push_back(number.value_or(std::numeric_limits<double>::quiet_NaN()));
      }
      const std::size_t least = has_uvs_ ? 5 : 3;
      if (numbers_.size() < least) {
        return fail_here("expected at least {} numbers, found {}", least, numbers_.size());
      }
      builder_.add_position({numbers_[0], numbers_[1], numbers_[2]});
      if (!has_uvs_) continue;
      builder_.add_uv({numbers_[numbers_.size() - 2], numbers_.back()},
                      fmt::format("line {}", line_number_));
    }
    return {};
  }

  Status parse_faces() {
    std::vector<PolygonCorner> corners;
    for (std::uint32_t i = 0; i < face_count_; ++i) {
      if (!next_line()) return fail_here("cut short: {} faces promised, {} found", face_count_, i);
      const auto count = parse_number<std::uint32_t>(take_word(line_));
      if (!count) return fail_here("expected a face's number of corners");
      corners.clear();
      for (std::uint32_t corner = 0; corner < *count; ++corner) {
        const std::string_view word = take_word(line_);
        const auto index = parse_number<std::uint32_t>(word);
        if (!index || *index >= vertex_count_) {
          return fail_here("expected the number of a vertex, 0 to {}, found '{}'",
                           static_cast<std::int64_t>(vertex_count_) - 1, word.substr(0, 40));
        }
        corners.push_back({.position = *index, .uv = has_uvs_ ? *index : PolygonCorner::kNone});
      }
      Status added = builder_.add_polygon(corners, std::to_string(line_number_));
      if (!added) return added;
    }
    return {};
  }

  MeshBuilder builder_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t line_number_ = 0;
  bool has_uvs_ = false;
  std::uint32_t vertex_count_ = 0;
  std::uint32_t face_count_ = 0;
  std::vector<double> numbers_;
};

}  // namespace

Result<FileMesh> read_off(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return forward_error(text);
  return OffParser(path.string(), without_byte_order_mark(*text)).parse();
}

}  // namespace seedframe
