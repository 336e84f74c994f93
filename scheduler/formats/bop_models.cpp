#include "formats/bop_models.h"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/canonical_json.h"
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

std::string ply_of(const Mesh& mesh) {
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.triangles.size());
  for (const auto& position : mesh.positions) {
    for (const float metres : position) {
      append(bytes, static_cast<float>(static_cast<double>(metres) * kMillimetresPerMetre));
    }
  }
  for (const auto& triangle : mesh.triangles) {
    append(bytes, std::uint8_t{3});
    for (const auto corner : triangle) append(bytes, static_cast<std::int32_t>(corner));
  }
  return bytes;
}

Json info_of(const Mesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  const Eigen::Vector3d low = box.low * kMillimetresPerMetre;
  const Eigen::Vector3d size = box.size() * kMillimetresPerMetre;
  return {{"diameter", mesh_diameter(mesh) * kMillimetresPerMetre},
          {"min_x", low.x()},
          {"min_y", low.y()},
          {"min_z", low.z()},
          {"size_x", size.x()},
          {"size_y", size.y()},
          {"size_z", size.z()}};
}

}  // namespace

std::map<std::string, int> bop_object_ids(const std::vector<OfferedAsset>& assets) {
  std::map<std::string, int> ids;
  for (const OfferedAsset& offered : assets) {
    ids.emplace(offered.asset->name, static_cast<int>(ids.size()) + 1);
  }
  return ids;
}

Status write_bop_models(const std::vector<OfferedAsset>& assets, ExportFolder& folder) {
  const std::map<std::string, int> ids = bop_object_ids(assets);
  Json infos = Json::object();
  Json names = Json::object();
  for (const OfferedAsset& offered : assets) {
    const Asset& asset = *offered.asset;
    const int id = ids.at(asset.name);
    const std::string path = fmt::format("models/obj_{:06}.ply", id);
    if (Status written = folder.write(path, ply_of(asset.mesh)); !written) return written;
    infos[std::to_string(id)] = info_of(asset.mesh);
    names[std::to_string(id)] = {{"asset", asset.name}, {"category", asset.category}};
  }
  Status written = folder.write("models/models_info.json", readable_json(infos));
  if (!written) return written;
  return folder.write("models.json", readable_json(names));
}

}  // namespace seedframe
