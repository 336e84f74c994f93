// Our own reader, because tinyobjloader takes "v 1 abc 2" for (1, 0, 2), reports a corner without a
// vertex as a warning and drops usemtl names when the .mtl file is missing.
#include "mesh_files/obj_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "mesh_files/beside_files.h"
#include "mesh_files/mesh_builder.h"
#include "mesh_files/mtl_reader.h"
#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace {

class ObjParser {
 public:
  explicit ObjParser(const std::filesystem::path& path)
      : builder_(path.string()), files_(path, builder_) {}

  Result<FileMesh> parse(const std::string& text) {
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
    // Of each file, where several were joined.
    line = trimmed(without_byte_order_mark(line.substr(0, line.find('#'))));
    const std::string_view keyword = take_word(line);
    if (keyword == "v") return parse_position(line);
    if (keyword == "vt") return parse_uv(line);
    if (keyword == "f") return parse_face(line);
    if (keyword == "usemtl") {
      builder_.use_slot(trimmed(line));
    } else {
      pass_over(keyword, trimmed(line));
    }
    return {};
  }

  // What makes no triangles.
  void pass_over(std::string_view keyword, std::string_view rest) {
    const auto is_one_of = [keyword](std::initializer_list<std::string_view> words) {
      return std::find(words.begin(), words.end(), keyword) != words.end();
    };
    if (is_one_of({"", "o", "g", "s", "mg", "bevel", "c_interp", "d_interp", "lod", "maplib"})) {
      return;
    }
    if (keyword == "vn") {
      builder_.not_kept(kNormals);
    } else if (keyword == "mtllib") {
      for (auto& [name, material] : read_mtl(std::string(rest), files_, builder_)) {
        builder_.add_material(name, std::move(material));
      }
    } else if (keyword == "usemap") {
      builder_.not_kept("images ('usemap')");
    } else if (is_one_of({"p", "l"})) {
      builder_.not_kept("points and lines");
    } else if (is_one_of({"vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm",
                          "trim", "hole", "scrv", "sp", "end", "con", "ctech", "stech"})) {
      builder_.not_kept("free-form curves and surfaces");
    } else if (is_one_of({"shadow_obj", "trace_obj", "call", "csh"})) {
      builder_.not_kept("other files that it names");
    } else {
      builder_.drop("lines that begin with an unknown word are skipped", place());
    }
  }

  std::string place() const { return fmt::format("line {}", line_number_); }

  template <class... Args>
  tl::unexpected<Error> fail_here(fmt::format_string<Args...> format, Args&&... args) const {
    return builder_.fail_at(std::to_string(line_number_), "{}",
                            fmt::format(format, std::forward<Args>(args)...));
  }

  Status parse_position(std::string_view line) {
    std::array<double, 3> position{}, color{};
    std::size_t found = 0;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto value = parse_number<double>(word);
      if (found++ >= position.size()) {  // a weight or a colour may follow
        if (found <= 6) color[found - 4] = value.value_or(std::nan(""));
        continue;
      }
      if (!value || !std::isfinite(static_cast<float>(*value))) {
        return fail_here("expected a finite number, found '{}'", word);
      }
      position[found - 1] = *value;
    }
    if (found < position.size()) {
      return fail_here("expected at least {} numbers, found {}", position.size(), found);
    }
    builder_.add_position(position);
    colors_.push_back(found >= 6 ? code_of_srgb(color) : kNoColor);
    return {};
  }

  // Numbers that are missing behind the first are 0.
  Status parse_uv(std::string_view line) {
    std::array<double, 2> uv{};
    for (std::size_t i = 0; i < uv.size(); ++i) {
      const std::string_view word = take_word(line);
      if (word.empty() && i > 0) break;
      uv[i] = parse_number<double>(word).value_or(std::numeric_limits<double>::quiet_NaN());
    }
    builder_.add_uv(uv, place());
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
    corner.color = colors_[*position];
    if (slash == std::string_view::npos) return corner;
    word.remove_prefix(slash + 1);
    word = word.substr(0, word.find('/'));
    if (word.empty()) return corner;
    const auto uv = parse_index(word, builder_.uv_count(), "texture coordinate");
    if (uv) {
      corner.uv = *uv;
    } else if (parse_number<std::int64_t>(
                   word)) {  // some programs number UVs that they don't write
      builder_.drop("corners whose texture coordinates do not stand above them have UV (0, 0)",
                    place());
    } else {
      return forward_error(uv);
    }
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
  std::vector<PolygonCorner> corners_;
  std::vector<ColorCode> colors_;  // of positions
  MeshBuilder builder_;
  BesideFiles files_;
};

}  // namespace

Result<FileMesh> read_obj(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return forward_error(text);
  return ObjParser(path).parse(*text);
}

}  // namespace seedframe
