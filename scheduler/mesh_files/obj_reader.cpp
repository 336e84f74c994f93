// Our own reader, because tinyobjloader takes "v 1 abc 2" for (1, 0, 2), reports a corner without a
// vertex as a warning and drops usemtl names when the .mtl file is missing.
#include "mesh_files/obj_reader.h"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "mesh_files/mesh_builder.h"
#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace {

class ObjParser {
 public:
  explicit ObjParser(const std::string& file) : builder_(file) {}

  Result<Mesh> parse(const std::string& text) {
    std::string_view rest = without_byte_order_mark(text);
    std::string line;
    while (!rest.empty()) {
      take_joined_line(rest, line);
      if (Status status = parse_line(line); !status) return forward_error(status);
    }
    return builder_.finish("lines like 'f 1 2 3'");
  }

 private:
  // A backslash at the end of a line joins the next one to it.
  void take_joined_line(std::string_view& rest, std::string& line) {
    line.clear();
    line_number_ = next_line_number_;
    bool joined = true;
    while (joined && !rest.empty()) {
      std::string_view part = trimmed(take_line(rest));
      ++next_line_number_;
      joined = part.ends_with('\\');
      if (joined) part.remove_suffix(1);
      line.append(part).append(" ");
    }
  }

  Status parse_line(std::string_view line) {
    line = trimmed(line.substr(0, line.find('#')));
    const std::string_view keyword = take_word(line);
    if (keyword == "v") return parse_position(line);
    if (keyword == "vt") return parse_uv(line);
    if (keyword == "f") return parse_face(line);
    if (keyword == "usemtl") builder_.use_slot(trimmed(line));
    // Everything else (normals, groups, names, .mtl files, lines, curves) makes no triangles.
    return {};
  }

  template <class... Args>
  tl::unexpected<Error> fail_here(fmt::format_string<Args...> format, Args&&... args) const {
    return builder_.fail_at(std::to_string(line_number_), "{}",
                            fmt::format(format, std::forward<Args>(args)...));
  }

  // `least` numbers or more, of which the first `used` must be finite.
  Result<std::vector<float>> parse_floats(std::string_view line, std::size_t least,
                                          std::size_t used) const {
    std::vector<float> values;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto value = parse_number<double>(word);
      const bool wanted = values.size() < used;
      if (!value || (wanted && !std::isfinite(static_cast<float>(*value)))) {
        return fail_here("expected a finite number, found '{}'", word);
      }
      values.push_back(static_cast<float>(*value));
    }
    if (values.size() < least) {
      return fail_here("expected at least {} numbers, found {}", least, values.size());
    }
    return values;
  }

  Status parse_position(std::string_view line) {
    const auto values = parse_floats(line, 3, 3);  // a weight or a colour may follow
    if (!values) return forward_error(values);
    builder_.add_position({(*values)[0], (*values)[1], (*values)[2]});
    return {};
  }

  Status parse_uv(std::string_view line) {
    if (line_without_uvs_ > 0) {
      return fail_here("texture coordinates must stand above the polygons that name them (line {})",
                       line_without_uvs_);
    }
    const auto values = parse_floats(line, 1, 2);
    if (!values) return forward_error(values);
    builder_.add_uv({(*values)[0], values->size() > 1 ? (*values)[1] : 0.0f});
    return {};
  }

  // Counted from 1, or from the last one backwards.
  Result<std::uint32_t> parse_index(std::string_view word, std::size_t count,
                                    const char* noun) const {
    const auto number = parse_number<std::int64_t>(word);
    if (!number || *number == 0) {
      return fail_here("expected the number of a {}, 1 or more, or negative; found '{}'", noun,
                       word);
    }
    const auto known = static_cast<std::int64_t>(count);
    const std::int64_t index = *number > 0 ? *number - 1 : known + *number;
    if (index < 0 || index >= known) {
      return fail_here("there is no {} {}: {} stand above this line", noun, *number, known);
    }
    return static_cast<std::uint32_t>(index);
  }

  // "3", "3/7", "3//5" or "3/7/5": position, UV and normal.
  Result<PolygonCorner> parse_corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    PolygonCorner corner;
    const auto position = parse_index(word.substr(0, slash), builder_.position_count(), "vertex");
    if (!position) return forward_error(position);
    corner.position = *position;
    if (slash == std::string_view::npos) return corner;
    word.remove_prefix(slash + 1);
    word = word.substr(0, word.find('/'));
    if (word.empty()) return corner;
    // Some programs number UVs that they do not write.
    if (builder_.uv_count() == 0 && parse_number<std::int64_t>(word)) {
      line_without_uvs_ = line_number_;
      return corner;
    }
    const auto uv = parse_index(word, builder_.uv_count(), "texture coordinate");
    if (!uv) return forward_error(uv);
    corner.uv = *uv;
    return corner;
  }

  Status parse_face(std::string_view line) {
    corners_.clear();
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto corner = parse_corner(word);
      if (!corner) return forward_error(corner);
      corners_.push_back(*corner);
    }
    return builder_.add_polygon(corners_, std::to_string(line_number_));
  }

  std::size_t line_number_ = 0;
  std::size_t next_line_number_ = 1;
  std::size_t line_without_uvs_ = 0;  // the last that names a UV where the file has none; 0: none
  std::vector<PolygonCorner> corners_;
  MeshBuilder builder_;
};

}  // namespace

Result<Mesh> read_obj(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return forward_error(text);
  return ObjParser(path.string()).parse(*text);
}

}  // namespace seedframe
