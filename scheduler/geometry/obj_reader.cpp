// Our own reader, because tinyobjloader takes "v 1 abc 2" for (1, 0, 2), reports a corner without a
// vertex as a warning and drops usemtl names when the .mtl file is missing.
#include "geometry/obj_reader.h"

#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/files.h"
#include "geometry/polygon.h"

namespace seedframe {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

struct Corner {
  std::uint32_t position = kNone;
  std::uint32_t uv = kNone;
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// Takes the next word off the front of `line`; empty at its end.
std::string_view take_word(std::string_view& line) {
  line = trimmed(line);
  std::size_t length = 0;
  while (length < line.size() && !is_space(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

template <class T>
std::optional<T> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

class ObjParser {
 public:
  explicit ObjParser(std::string file) : file_(std::move(file)) {}

  Result<Mesh> parse(const std::string& text) {
    std::string_view rest = text;
    std::string line;
    while (!rest.empty()) {
      take_line(rest, line);
      if (Status status = parse_line(line); !status) return forward_error(status);
    }
    if (mesh_.triangles.empty()) {
      return fail(ErrorKind::kInput, "{} has no polygons: expected lines like 'f 1 2 3'", file_);
    }
    drop_unused_vertices();
    if (mesh_.slot_names.empty()) mesh_.slot_names.emplace_back("default");
    if (Status status = check_mesh(mesh_, file_); !status) return forward_error(status);
    return std::move(mesh_);
  }

 private:
  // A backslash at the end of a line joins the next one to it.
  void take_line(std::string_view& rest, std::string& line) {
    line.clear();
    line_number_ = next_line_number_;
    bool joined = true;
    while (joined && !rest.empty()) {
      const std::size_t end = rest.find('\n');
      std::string_view part = trimmed(rest.substr(0, end));
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
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
    if (keyword == "usemtl") use_slot(trimmed(line));
    // Everything else (normals, groups, names, .mtl files, lines, curves) makes no triangles.
    return {};
  }

  template <class... Args>
  tl::unexpected<Error> fail_here(fmt::format_string<Args...> format, Args&&... args) const {
    return fail(ErrorKind::kInput, "{}:{}: {}", file_, line_number_,
                fmt::format(format, std::forward<Args>(args)...));
  }

  Result<std::vector<float>> parse_floats(std::string_view line, std::size_t least) const {
    std::vector<float> values;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto value = parse_number<double>(word);
      if (!value || !std::isfinite(static_cast<float>(*value))) {
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
    const auto values = parse_floats(line, 3);  // a weight or a colour may follow
    if (!values) return forward_error(values);
    positions_.push_back({(*values)[0], (*values)[1], (*values)[2]});
    return {};
  }

  Status parse_uv(std::string_view line) {
    const auto values = parse_floats(line, 1);
    if (!values) return forward_error(values);
    uvs_.push_back({(*values)[0], values->size() > 1 ? (*values)[1] : 0.0f});
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
  Result<Corner> parse_corner(std::string_view word) const {
    const std::size_t slash = word.find('/');
    Corner corner;
    const auto position = parse_index(word.substr(0, slash), positions_.size(), "vertex");
    if (!position) return forward_error(position);
    corner.position = *position;
    if (slash == std::string_view::npos) return corner;
    word.remove_prefix(slash + 1);
    word = word.substr(0, word.find('/'));
    if (word.empty()) return corner;
    const auto uv = parse_index(word, uvs_.size(), "texture coordinate");
    if (!uv) return forward_error(uv);
    corner.uv = *uv;
    return corner;
  }

  Status parse_face(std::string_view line) {
    std::vector<Corner> corners;
    std::vector<Eigen::Vector3d> points;
    for (std::string_view word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto corner = parse_corner(word);
      if (!corner) return forward_error(corner);
      corners.push_back(*corner);
      const auto& p = positions_[corner->position];
      points.emplace_back(p[0], p[1], p[2]);
    }
    if (corners.size() < 3) {
      return fail_here("a polygon needs 3 corners or more, found {}", corners.size());
    }
    if (mesh_.slot_names.empty()) use_slot("default");
    for (const auto& [a, b, c] : triangulate(points))
      add_triangle(corners[a], corners[b], corners[c]);
    return {};
  }

  void add_triangle(const Corner& a, const Corner& b, const Corner& c) {
    // A repeated vertex leaves a line, which nobody sees.
    if (a.position == b.position || b.position == c.position || c.position == a.position) return;
    mesh_.triangles.push_back({a.position, b.position, c.position});
    mesh_.triangle_slots.push_back(slot_);
    for (const Corner& corner : {a, b, c}) {
      mesh_.corner_uvs.push_back(corner.uv == kNone ? std::array<float, 2>{} : uvs_[corner.uv]);
    }
  }

  void use_slot(std::string_view name) {
    const auto [entry, is_new] = slots_.try_emplace(std::string(name), slots_.size());
    if (is_new) mesh_.slot_names.emplace_back(name);
    slot_ = static_cast<std::uint32_t>(entry->second);
  }

  // A stray vertex would enlarge the box that objects are measured and placed by.
  void drop_unused_vertices() {
    std::vector<std::uint32_t> new_index(positions_.size(), kNone);
    for (const auto& triangle : mesh_.triangles) {
      for (const std::uint32_t index : triangle) new_index[index] = 0;
    }
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if (new_index[i] == kNone) continue;
      new_index[i] = static_cast<std::uint32_t>(mesh_.positions.size());
      mesh_.positions.push_back(positions_[i]);
    }
    for (auto& triangle : mesh_.triangles) {
      for (std::uint32_t& index : triangle) index = new_index[index];
    }
  }

  std::string file_;
  std::size_t line_number_ = 0;
  std::size_t next_line_number_ = 1;
  std::vector<std::array<float, 3>> positions_;
  std::vector<std::array<float, 2>> uvs_;
  std::map<std::string, std::size_t> slots_;
  std::uint32_t slot_ = 0;
  Mesh mesh_;
};

}  // namespace

Result<Mesh> read_obj(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return forward_error(text);
  return ObjParser(path.string()).parse(*text);
}

}  // namespace seedframe
