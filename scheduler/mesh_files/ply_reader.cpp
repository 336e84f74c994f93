// Our own reader, because CGAL's drops UVs and materials and, like most, allocates what the header
// claims.
#include "mesh_files/ply_reader.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "base/files.h"
#include "mesh_files/beside_files.h"
#include "mesh_files/byte_reader.h"
#include "mesh_files/mesh_builder.h"
#include "mesh_files/ply_header.h"
#include "mesh_files/text_scanner.h"

namespace seedframe {
namespace {

template <class T>
std::optional<double> take_double(std::string_view& rest, bool big_endian) {
  const auto value = take_value<T>(rest, big_endian);
  if (!value) return std::nullopt;
  return static_cast<double>(*value);
}

std::optional<double> take_binary(std::string_view& rest, PlyType type, bool big_endian) {
  switch (type) {
    case PlyType::kInt8:
      return take_double<std::int8_t>(rest, big_endian);
    case PlyType::kUint8:
      return take_double<std::uint8_t>(rest, big_endian);
    case PlyType::kInt16:
      return take_double<std::int16_t>(rest, big_endian);
    case PlyType::kUint16:
      return take_double<std::uint16_t>(rest, big_endian);
    case PlyType::kInt32:
      return take_double<std::int32_t>(rest, big_endian);
    case PlyType::kUint32:
      return take_double<std::uint32_t>(rest, big_endian);
    case PlyType::kFloat32:
      return take_double<float>(rest, big_endian);
    case PlyType::kFloat64:
      return take_double<double>(rest, big_endian);
  }
  return std::nullopt;
}

// The values of one property of one vertex or face; a scalar is a list of one.
using Values = std::vector<double>;

class PlyParser {
 public:
  explicit PlyParser(const std::filesystem::path& path)
      : file_(path.string()), builder_(file_), files_(path, builder_) {}

  Result<FileMesh> parse(std::string_view bytes) {
    rest_ = bytes;
    auto header = take_ply_header(rest_, file_);
    if (!header) return forward_error(header);
    format_ = header->format;
    for (const PlyElement& element : header->elements) {
      if (Status status = parse_element(element); !status) return forward_error(status);
    }
    add_images(header->images);
    return builder_.finish("an element 'face' with a list 'vertex_indices'");
  }

 private:
  Status parse_element(const PlyElement& element) {
    if (element.properties.empty()) return {};  // takes no bytes, however many there are
    if (Status status = find_properties(element); !status) return status;
    std::vector<Values> row(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::string place = fmt::format("{} {}", element.name, i);
      for (std::size_t p = 0; p < row.size(); ++p) {
        if (take_property(element.properties[p], row[p])) continue;
        return builder_.fail_at(
            place, "expected '{}', found {}; {} were promised", element.properties[p].name,
            trimmed(rest_).empty() ? "the end of the file" : "no such number", element.count);
      }
      Status added;
      if (element.name == "vertex") added = add_vertex(row, place);
      if (element.name == "face") added = add_face(row, place);
      if (!added) return added;
    }
    return {};
  }

  Status find_properties(const PlyElement& element) {
    list_what_is_not_kept(element);
    color_ = {element.find({"red", "r", "diffuse_red"}),
              element.find({"green", "g", "diffuse_green"}),
              element.find({"blue", "b", "diffuse_blue"})};
    if (color_[0] >= 0 && color_[1] >= 0 && color_[2] >= 0) {
      most_ = largest_of(element.properties[static_cast<std::size_t>(color_[0])].type);
    } else {
      most_ = 0.0;
    }
    if (element.name == "vertex") {
      if (builder_.position_count() > 0) {
        return builder_.fail_at("", "a second element 'vertex': expected one");
      }
      position_ = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
      floats_ =
          position_[0] >= 0 &&
          element.properties[static_cast<std::size_t>(position_[0])].type == PlyType::kFloat32 &&
          format_ != PlyHeader::Format::kText;
      uv_ = {element.find({"s", "u", "texture_u"}), element.find({"t", "v", "texture_v"})};
      if (position_[0] < 0 || position_[1] < 0 || position_[2] < 0) {
        return builder_.fail_at("", "vertices need the properties x, y and z");
      }
    }
    if (element.name == "face") {
      corners_ = element.find({"vertex_indices", "vertex_index"});
      face_uvs_ = element.find({"texcoord"});
      slot_ = element.find({"material_index", "texnumber"});
      if (corners_ < 0) {
        return builder_.fail_at("", "faces need the list vertex_indices or vertex_index");
      }
    }
    return {};
  }

  // Of the material of each number; of all, without numbers.
  void add_images(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      auto image = files_.image(names[i]);
      if (!image) continue;
      FileMaterial material;
      material.base_color = {1.0, 1.0, 1.0};
      material.textures["color"].image = std::move(image);
      builder_.add_material(fmt::format("material{}", i), material);
      if (i == 0) builder_.add_material("default", material);
    }
  }

  void list_what_is_not_kept(const PlyElement& element) {
    if (element.name != "vertex" && element.name != "face") {
      if (element.count > 0) builder_.not_kept(fmt::format("the element '{}'", element.name));
      return;
    }
    if (element.name == "vertex" && element.find({"nx"}) >= 0) builder_.not_kept(kNormals);
  }

  // Nothing where there is no number.
  std::optional<double> take_number(PlyType type) {
    if (format_ != PlyHeader::Format::kText) {
      return take_binary(rest_, type, format_ == PlyHeader::Format::kBigEndian);
    }
    // Lines mean nothing behind the header.
    while (!rest_.empty() && (is_space(rest_.front()) || rest_.front() == '\n')) {
      rest_.remove_prefix(1);
    }
    std::size_t length = 0;
    while (length < rest_.size() && !is_space(rest_[length]) && rest_[length] != '\n') ++length;
    if (length == 0) return std::nullopt;
    const auto number = parse_number<double>(rest_.substr(0, length));
    rest_.remove_prefix(length);
    // Colours and the like may be written in any way; who needs the number refuses this one.
    return number.value_or(std::numeric_limits<double>::quiet_NaN());
  }

  // False at the end of the file and where there is no number. Long lists cost as many bytes as
  // they claim values, so memory stays within the file's size.
  bool take_property(const PlyProperty& property, Values& values) {
    values.clear();
    double count = 1.0;
    if (property.is_list) {
      const auto claimed = take_number(property.count_type);
      const bool usable =
          claimed && *claimed >= 0.0 && *claimed <= static_cast<double>(rest_.size());
      if (!usable) return false;
      count = *claimed;
    }
    for (double i = 0.0; i < count; ++i) {
      const auto value = take_number(property.type);
      if (!value) return false;
      values.push_back(*value);
    }
    return true;
  }

  // NaN where there is not one number, or one that no float can hold.
  static double number_at(const std::vector<Values>& row, int property) {
    const Values& values = row[static_cast<std::size_t>(property)];
    const bool usable =
        values.size() == 1 && std::abs(values[0]) <= std::numeric_limits<float>::max();
    return usable ? values[0] : std::numeric_limits<double>::quiet_NaN();
  }

  /// What stands for 1 in colours of that type; 0 for types that nobody has them in.
  static double largest_of(PlyType type) {
    switch (type) {
      case PlyType::kUint8:
        return 255.0;
      case PlyType::kUint16:
        return 65535.0;
      case PlyType::kFloat32:
      case PlyType::kFloat64:
        return 1.0;
      default:
        return 0.0;
    }
  }
  /// kNoColor for an element without colours.
  ColorCode color_at(const std::vector<Values>& row) const {
    if (most_ == 0.0) return kNoColor;
    return code_of_srgb({number_at(row, color_[0]) / most_, number_at(row, color_[1]) / most_,
                         number_at(row, color_[2]) / most_});
  }

  Status add_vertex(const std::vector<Values>& row, const std::string& place) {
    std::array<double, 3> position{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      position[axis] = number_at(row, position_[axis]);
      if (std::isnan(position[axis])) {
        return builder_.fail_at(place, "expected a finite coordinate");
      }
      if (floats_) builder_.stored_as(static_cast<float>(position[axis]));
    }
    builder_.add_position(position);
    vertex_colors_.push_back(color_at(row));
    if (uv_[0] >= 0 && uv_[1] >= 0) {
      builder_.add_uv({number_at(row, uv_[0]), number_at(row, uv_[1])}, place);
    }
    return {};
  }

  Status add_face(const std::vector<Values>& row, const std::string& place) {
    const Values& indices = row[static_cast<std::size_t>(corners_)];
    std::vector<PolygonCorner> corners;
    corners.reserve(indices.size());
    const std::size_t vertices = builder_.position_count();
    const bool vertex_uvs = uv_[0] >= 0 && uv_[1] >= 0;
    const ColorCode color = color_at(row);
    for (const double index : indices) {
      if (!(index >= 0.0 && index < static_cast<double>(vertices)) || index != std::floor(index)) {
        return builder_.fail_at(place, "names vertex {}, but the file has {} (the first is 0)",
                                index, vertices);
      }
      const auto position = static_cast<std::uint32_t>(index);
      corners.push_back({position, vertex_uvs ? position : PolygonCorner::kNone,
                         color == kNoColor ? vertex_colors_[position] : color});
    }
    add_face_uvs(row, corners, place);
    if (slot_ >= 0) {
      double slot = number_at(row, slot_);
      if (!(std::abs(slot) < static_cast<double>(kMostImportedSlots))) {
        builder_.drop("faces whose material is no number have material 0", place);
        slot = 0.0;
      }
      builder_.use_slot(fmt::format("material{}", static_cast<int>(std::max(0.0, slot))));
    }
    return builder_.add_polygon(corners, place);
  }

  // UVs of the face's own corners win over those of its vertices.
  void add_face_uvs(const std::vector<Values>& row, std::vector<PolygonCorner>& corners,
                    const std::string& place) {
    if (face_uvs_ < 0) return;
    const Values& uvs = row[static_cast<std::size_t>(face_uvs_)];
    if (uvs.empty()) return;  // a face without a texture
    if (uvs.size() != 2 * corners.size()) {
      builder_.drop("faces whose texcoord has not two numbers a corner have none of it", place);
      return;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      corners[i].uv = builder_.add_uv({uvs[2 * i], uvs[2 * i + 1]}, place);
    }
  }

  std::string file_;
  MeshBuilder builder_;
  BesideFiles files_;
  std::string_view rest_;
  PlyHeader::Format format_ = PlyHeader::Format::kText;
  bool floats_ = false;                      // coordinates are stored as 32-bit floats
  std::array<int, 3> position_{-1, -1, -1};  // places of properties in a row
  std::array<int, 2> uv_{-1, -1};
  std::array<int, 3> color_{-1, -1, -1};  // of the element at hand
  double most_ = 0.0;                     // stands for 1 in it; 0: it has no colours
  std::vector<ColorCode> vertex_colors_;
  int corners_ = -1;
  int face_uvs_ = -1;
  int slot_ = -1;
};

}  // namespace

Result<FileMesh> read_ply(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return forward_error(bytes);
  return PlyParser(path).parse(*bytes);
}

}  // namespace seedframe
