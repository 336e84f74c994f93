#include "formats/bop_models.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "assets/symmetry.h"
#include "base/canonical_json.h"
#include "mesh/corner_normals.h"
#include "mesh/mesh_diameter.h"

namespace seedframe {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY files are written as memory has it");

template <class T>
void append(std::string& bytes, T value) {
  const std::size_t end = bytes.size();
  bytes.resize(end + sizeof value);
  std::memcpy(bytes.data() + end, &value, sizeof value);
}

using Coordinates = std::array<float, 3>;

/// A vertex of the mesh once for each normal that it has: readers know one normal a vertex.
struct ShadedMesh {
  std::vector<std::pair<Coordinates, Coordinates>> vertices;  ///< position in metres, unit normal
  std::vector<std::array<std::int32_t, 3>> triangles;
};

ShadedMesh shaded_mesh(const Mesh& mesh) {
  const std::vector<Coordinates> normals =
      corner_normals(mesh.positions, mesh.triangles, mesh.smooth_angle_rad);
  ShadedMesh shaded;
  std::vector<std::vector<std::pair<Coordinates, std::int32_t>>> copies(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<std::int32_t, 3>& triangle = shaded.triangles.emplace_back();
    for (std::size_t corner = 0; corner < triangle.size(); ++corner) {
      const std::uint32_t vertex = mesh.triangles[i][corner];
      auto& known = copies[vertex];
      Coordinates normal = normals[3 * i + corner];
      if (normal == Coordinates{}) {  // its triangles have no area, and nobody sees them
        normal = known.empty() ? Coordinates{0.0F, 0.0F, 1.0F} : known.front().first;
      }
      auto copy = std::find_if(known.begin(), known.end(),
                               [&](const auto& each) { return each.first == normal; });
      if (copy == known.end()) {
        known.emplace_back(normal, static_cast<std::int32_t>(shaded.vertices.size()));
        shaded.vertices.emplace_back(mesh.positions[vertex], normal);
        copy = std::prev(known.end());
      }
      triangle[corner] = copy->second;
    }
  }
  return shaded;
}

std::string ply_of(const Mesh& mesh) {
  const ShadedMesh shaded = shaded_mesh(mesh);
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face "
      "{}\nproperty list uchar int vertex_indices\nend_header\n",
      shaded.vertices.size(), shaded.triangles.size());
  for (const auto& [position, normal] : shaded.vertices) {
    for (const float metres : position) {
      append(bytes, static_cast<float>(static_cast<double>(metres) * kMillimetresPerMetre));
    }
    for (const float coordinate : normal) append(bytes, coordinate);
  }
  for (const auto& triangle : shaded.triangles) {
    append(bytes, std::uint8_t{3});
    for (const std::int32_t corner : triangle) append(bytes, corner);
  }
  return bytes;
}

/// As the toolkit reads them: 4 × 4 matrices in rows, millimetres.
void add_symmetries(const Symmetries& symmetries, Json& info) {
  const Eigen::Vector3d& centre = symmetries.centre;
  for (const Eigen::Vector3d& axis : symmetries.axes) {
    const Eigen::Vector3d offset = centre * kMillimetresPerMetre;
    info["symmetries_continuous"].push_back({{"axis", {axis.x(), axis.y(), axis.z()}},
                                             {"offset", {offset.x(), offset.y(), offset.z()}}});
  }
  for (const Eigen::Matrix3d& rotation : symmetries.rotations) {
    const Eigen::Vector3d shift = (centre - rotation * centre) * kMillimetresPerMetre;
    Json matrix = Json::array();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) matrix.push_back(rotation(row, column));
      matrix.push_back(shift[row]);
    }
    for (const double last : {0.0, 0.0, 0.0, 1.0}) matrix.push_back(last);
    info["symmetries_discrete"].push_back(std::move(matrix));
  }
}

Json info_of(const Mesh& mesh) {
  constexpr double kSameShape = 0.02;  // of the diameter
  const double diameter_m = mesh_diameter(mesh);
  const BoundingBox box = bounding_box(mesh);
  const Eigen::Vector3d low = box.low * kMillimetresPerMetre;
  const Eigen::Vector3d size = box.size() * kMillimetresPerMetre;
  Json info = {{"diameter", diameter_m * kMillimetresPerMetre},
               {"min_x", low.x()},
               {"min_y", low.y()},
               {"min_z", low.z()},
               {"size_x", size.x()},
               {"size_y", size.y()},
               {"size_z", size.z()}};
  add_symmetries(find_symmetries(mesh, kSameShape * diameter_m), info);
  return info;
}

}  // namespace

std::map<std::string, int> bop_object_ids(const std::vector<OfferedAsset>& assets) {
  std::map<std::string, int> ids;
  for (const OfferedAsset& offered : assets) {
    ids.emplace(offered.asset->name, static_cast<int>(ids.size()) + 1);
  }
  return ids;
}

void add_bop_models(const std::vector<OfferedAsset>& assets, CommonPart& common) {
  const std::map<std::string, int> ids = bop_object_ids(assets);
  Json infos = Json::object();
  Json names = Json::object();
  for (const OfferedAsset& offered : assets) {
    const Asset& asset = *offered.asset;
    const int id = ids.at(asset.name);
    common.files[fmt::format("models/obj_{:06}.ply", id)] = ply_of(asset.mesh);
    infos[std::to_string(id)] = info_of(asset.mesh);
    names[std::to_string(id)] = {{"asset", asset.name}, {"category", asset.category}};
  }
  common.files["models/models_info.json"] = readable_json(infos);
  common.files["models.json"] = readable_json(names);
}

}  // namespace seedframe
