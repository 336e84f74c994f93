#include "mesh_files/gltf_reader.h"

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "mesh_files/gltf_file.h"
#include "mesh_files/gltf_materials.h"
#include "mesh_files/mesh_builder.h"
#include "mesh_files/position_welder.h"

namespace seedframe {
namespace {

constexpr std::uint64_t kTriangles = 4;
constexpr std::uint64_t kTriangleFan = 6;

struct Placed {
  std::uint64_t node = 0;
  Eigen::Affine3d parent = Eigen::Affine3d::Identity();
};

// object[key] as `count` finite numbers; `fallback` without the key, nothing if it is wrong.
std::optional<std::vector<double>> numbers(const Json& object, const char* key,
                                           std::vector<double> fallback) {
  const auto found = object.find(key);
  if (found == object.end()) return fallback;
  if (!found->is_array() || found->size() != fallback.size()) return std::nullopt;
  std::vector<double> values;
  values.reserve(fallback.size());
  for (const Json& value : *found) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) return std::nullopt;
    values.push_back(value.get<double>());
  }
  return values;
}

std::optional<Eigen::Affine3d> local_transform(const Json& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (node.contains("matrix")) {
    const auto matrix = numbers(node, "matrix", std::vector<double>(16, 0.0));
    if (!matrix) return std::nullopt;
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->data());  // column by column
    const Eigen::RowVector4d last = transform.matrix().row(3);
    if (last != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) return std::nullopt;
    return transform;
  }
  const auto move = numbers(node, "translation", {0.0, 0.0, 0.0});
  const auto turn = numbers(node, "rotation", {0.0, 0.0, 0.0, 1.0});
  const auto scale = numbers(node, "scale", {1.0, 1.0, 1.0});
  if (!move || !turn || !scale) return std::nullopt;
  const Eigen::Quaterniond rotation((*turn)[3], (*turn)[0], (*turn)[1], (*turn)[2]);
  if (!(rotation.norm() > 1e-6)) return std::nullopt;
  transform.translate(Eigen::Vector3d((*move)[0], (*move)[1], (*move)[2]));
  transform.rotate(rotation.normalized());
  transform.scale(Eigen::Vector3d((*scale)[0], (*scale)[1], (*scale)[2]));
  return transform;
}

// Corner numbers of the triangles of a primitive with `count` corners.
std::vector<std::array<std::uint64_t, 3>> triangles_of(std::uint64_t mode, std::uint64_t count) {
  std::vector<std::array<std::uint64_t, 3>> triangles;
  if (count < 3) return triangles;
  triangles.reserve(mode == kTriangles ? count / 3 : count - 2);
  if (mode == kTriangles) {
    for (std::uint64_t i = 0; i + 2 < count; i += 3) triangles.push_back({i, i + 1, i + 2});
    return triangles;
  }
  for (std::uint64_t i = 0; i + 2 < count; ++i) {
    if (mode == kTriangleFan) {
      triangles.push_back({0, i + 1, i + 2});
    } else if (i % 2 == 0) {  // a strip, whose triangles turn round in turn
      triangles.push_back({i, i + 1, i + 2});
    } else {
      triangles.push_back({i + 1, i, i + 2});
    }
  }
  return triangles;
}

class GltfParser {
 public:
  explicit GltfParser(const GltfFile& file)
      : file_(file), builder_(file.name()), materials_(file, builder_) {}

  Result<FileMesh> parse() {
    auto waiting = roots();
    if (!waiting) return forward_error(waiting);
    const Json nodes = file_.json().value("nodes", Json::array());
    std::vector<bool> seen(nodes.size(), false);
    while (!waiting->empty()) {
      const Placed placed = waiting->back();
      waiting->pop_back();
      // A tree by the standard; a loop would never end.
      if (placed.node < seen.size() && seen[placed.node]) {
        return file_.fail_at(fmt::format("nodes[{}]", placed.node), "is a child of two nodes");
      }
      if (placed.node < seen.size()) seen[placed.node] = true;
      if (Status status = visit(placed, *waiting); !status) return forward_error(status);
    }
    list_what_is_not_kept();
    return builder_.finish("a scene with meshes of triangles");
  }

 private:
  // The nodes of the default scene, or all that have no parent.
  Result<std::vector<Placed>> roots() const {
    std::vector<Placed> found;
    const Json scenes = file_.json().value("scenes", Json::array());
    if (scenes.is_array() && !scenes.empty()) {
      const auto number = gltf_index(file_.json(), "scene", 0);
      if (!number) return file_.fail_at("scene", "expected the number of a scene");
      const auto scene = file_.entry("scenes", *number);
      if (!scene) return forward_error(scene);
      if (Status status = add_nodes(**scene, "nodes", Eigen::Affine3d::Identity(), found);
          !status) {
        return forward_error(status);
      }
      return found;
    }
    const Json nodes = file_.json().value("nodes", Json::array());
    std::vector<bool> is_child(nodes.size(), false);
    std::vector<Placed> children;
    for (const Json& node : nodes) {
      Status status = add_nodes(node, "children", Eigen::Affine3d::Identity(), children);
      if (!status) return forward_error(status);
    }
    for (const Placed& child : children) {
      if (child.node < is_child.size()) is_child[child.node] = true;
    }
    for (std::size_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) found.push_back({.node = i});
    }
    return found;
  }

  Status add_nodes(const Json& object, const char* key, const Eigen::Affine3d& parent,
                   std::vector<Placed>& found) const {
    const Json list = object.is_object() ? object.value(key, Json::array()) : Json();
    if (!list.is_array()) return file_.fail_at(key, "expected a list of nodes");
    for (const Json& number : list) {
      const auto node = gltf_index(Json{{"n", number}}, "n");
      if (!node) return file_.fail_at(key, "expected the number of a node");
      found.push_back({.node = *node, .parent = parent});
    }
    return {};
  }

  Status visit(const Placed& placed, std::vector<Placed>& waiting) {
    const std::string place = fmt::format("nodes[{}]", placed.node);
    const auto node = file_.entry("nodes", placed.node);
    if (!node) return forward_error(node);
    const auto local = local_transform(**node);
    if (!local) return file_.fail_at(place, "its matrix, translation, rotation or scale is wrong");
    const Eigen::Affine3d world = placed.parent * *local;
    if (Status status = add_nodes(**node, "children", world, waiting); !status) return status;
    if (!(*node)->contains("mesh")) return {};
    const auto number = gltf_index(**node, "mesh");
    if (!number) return file_.fail_at(place, "'mesh' must be the number of a mesh");
    const auto mesh = file_.entry("meshes", *number);
    if (!mesh) return forward_error(mesh);
    const Json primitives = (*mesh)->value("primitives", Json::array());
    PositionWelder welder(builder_);
    if ((*node)->contains("skin")) builder_.not_kept("skins");
    for (const Json& primitive : primitives) {
      Status added = add_primitive(primitive, world, welder, fmt::format("meshes[{}]", *number));
      if (!added) return added;
    }
    return {};
  }

  Status add_primitive(const Json& primitive, const Eigen::Affine3d& world, PositionWelder& welder,
                       const std::string& place) {
    const auto mode = gltf_index(primitive, "mode", kTriangles);
    if (!mode || *mode > kTriangleFan) return file_.fail_at(place, "'mode' must be 0 to 6");
    if (*mode < kTriangles) {
      builder_.not_kept("points and lines");
      return {};
    }
    const Json attributes = primitive.value("attributes", Json());
    const auto position_index = gltf_index(attributes, "POSITION");
    if (!position_index) return file_.fail_at(place, "a primitive needs the attribute POSITION");
    const auto positions = file_.read_accessor(*position_index, 3);
    if (!positions) return forward_error(positions);
    // Many nodes may show one mesh: a small file can ask for much.
    corners_read_ += positions->count;
    if (corners_read_ > 3 * kMostImportedTriangles) {
      return file_.fail_at(place, "more than {} vertices", 3 * kMostImportedTriangles);
    }
    auto corners = corners_of(*positions, world, welder);
    add_uvs(attributes, corners, place);
    add_colors(attributes, corners, place);
    list_what_is_not_kept(primitive, attributes);
    auto order = corner_order(primitive, corners.size(), place);
    if (!order) return forward_error(order);
    use_material(primitive, place);
    const bool mirrored = world.linear().determinant() < 0.0;
    for (auto& [a, b, c] : triangles_of(*mode, order->size())) {
      std::array<PolygonCorner, 3> triangle{corners[(*order)[a]], corners[(*order)[b]],
                                            corners[(*order)[c]]};
      if (mirrored) std::swap(triangle[1], triangle[2]);
      if (Status status = builder_.add_polygon(triangle, place); !status) return status;
    }
    return {};
  }

  std::vector<PolygonCorner> corners_of(const GltfFile::Numbers& positions,
                                        const Eigen::Affine3d& world, PositionWelder& welder) {
    const double scale = std::cbrt(std::abs(world.linear().determinant()));
    std::vector<PolygonCorner> corners;
    corners.reserve(positions.count);
    for (std::uint64_t i = 0; i < positions.count; ++i) {
      const double* p = positions.values.data() + 3 * i;
      const Eigen::Vector3d at(p[0], p[1], p[2]);
      builder_.stored_as(static_cast<float>(scale * at.cwiseAbs().maxCoeff()));
      const Eigen::Vector3d moved = world * at;
      corners.push_back({.position = welder.index_of({moved.x(), moved.y(), moved.z()})});
    }
    return corners;
  }

  // glTF's v points down the image.
  void add_uvs(const Json& attributes, std::vector<PolygonCorner>& corners,
               const std::string& place) {
    if (!attributes.contains("TEXCOORD_0")) return;
    const auto index = gltf_index(attributes, "TEXCOORD_0");
    const auto uvs = index ? file_.read_accessor(*index, 2) : Result<GltfFile::Numbers>();
    if (!index || !uvs || uvs->count != corners.size()) {
      const std::string why = !index ? "not the number of an accessor"
                              : !uvs
                                  ? uvs.error().message
                                  : fmt::format("{} for {} positions", uvs->count, corners.size());
      builder_.drop(fmt::format("UVs (TEXCOORD_0) that cannot be read are left out ({})", why),
                    place);
      return;
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      corners[i].uv = builder_.add_uv({uvs->values[2 * i], 1.0 - uvs->values[2 * i + 1]}, place);
    }
  }

  // Linear; three numbers, or four with an opacity.
  void add_colors(const Json& attributes, std::vector<PolygonCorner>& corners,
                  const std::string& place) {
    if (!attributes.contains("COLOR_0")) return;
    const auto index = gltf_index(attributes, "COLOR_0");
    for (const std::uint64_t components : {3, 4}) {
      const auto colors =
          index ? file_.read_accessor(*index, components) : Result<GltfFile::Numbers>();
      if (!index || !colors || colors->count != corners.size()) continue;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const double* rgb = colors->values.data() + components * i;
        corners[i].color = code_of_linear({rgb[0], rgb[1], rgb[2]});
      }
      return;
    }
    builder_.drop("colours (COLOR_0) that cannot be read are left out", place);
  }

  void list_what_is_not_kept(const Json& primitive, const Json& attributes) {
    if (attributes.contains("NORMAL")) builder_.not_kept(kNormals);
    if (attributes.contains("TEXCOORD_1")) builder_.not_kept("UV sets beyond the first");
    if (primitive.contains("targets")) builder_.not_kept("morph targets");
  }

  // Of the whole file.
  void list_what_is_not_kept() {
    if (file_.json().contains("animations")) builder_.not_kept("animations");
    if (file_.json().contains("cameras")) builder_.not_kept("cameras");
  }

  Result<std::vector<std::uint64_t>> corner_order(const Json& primitive, std::uint64_t corners,
                                                  const std::string& place) const {
    std::vector<std::uint64_t> order;
    if (!primitive.contains("indices")) {
      for (std::uint64_t i = 0; i < corners; ++i) order.push_back(i);
      return order;
    }
    const auto index = gltf_index(primitive, "indices");
    if (!index) return file_.fail_at(place, "'indices' must be the number of an accessor");
    const auto indices = file_.read_accessor(*index, 1);
    if (!indices) return forward_error(indices);
    order.reserve(indices->count);
    for (const double corner : indices->values) {
      if (!(corner >= 0.0 && corner < static_cast<double>(corners)) ||
          corner != std::floor(corner)) {
        return file_.fail_at(place, "index {} is beyond the {} vertices", corner, corners);
      }
      order.push_back(static_cast<std::uint64_t>(corner));
    }
    return order;
  }

  void use_material(const Json& primitive, const std::string& place) {
    const auto index = gltf_index(primitive, "material");
    if (!index) {
      if (primitive.contains("material")) {
        builder_.drop("materials that are not the number of one are 'default'", place);
      }
      builder_.use_slot("default");
      return;
    }
    const auto material = file_.entry("materials", *index);
    if (!material) builder_.drop("materials that are not in the file have a number only", place);
    const Json name = material ? (*material)->value("name", Json()) : Json();
    const bool named = name.is_string() && !name.get<std::string>().empty();
    const auto known = slots_.find(*index);
    if (known != slots_.end()) {
      builder_.use_slot(known->second);
      return;
    }
    std::string slot = named ? name.get<std::string>() : fmt::format("material{}", *index);
    // Materials may have one name.
    if (!slot_names_.insert(slot).second) slot += fmt::format(" ({})", *index);
    slots_.emplace(*index, slot);
    builder_.use_slot(slot);
    if (material) builder_.add_material(slot, materials_.read(**material));
  }

  const GltfFile& file_;
  MeshBuilder builder_;
  GltfMaterials materials_;
  std::map<std::uint64_t, std::string> slots_;  // by the number of the material
  std::set<std::string> slot_names_;
  std::uint64_t corners_read_ = 0;
};

}  // namespace

Result<FileMesh> read_gltf(const std::filesystem::path& path) {
  try {
    const auto file = GltfFile::open(path);
    if (!file) return forward_error(file);
    return GltfParser(*file).parse();
  } catch (const Json::exception& error) {  // a key of an unexpected type
    return fail(ErrorKind::kInput, "{}: {}", path.string(), error.what());
  }
}

}  // namespace seedframe
