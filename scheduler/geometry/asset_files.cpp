#include "geometry/asset_files.h"

#include <algorithm>
#include <cmath>

#include "geometry/draco_codec.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kVersion = 1;

template <class T>
Status read_field(const Json& object, const char* key, const std::string& what, T& out) {
  auto value = json_field<T>(object, key, what);
  if (!value) return forward_error(value);
  out = std::move(*value);
  return {};
}

Status check_version(const Json& json, const std::string& what) {
  const auto version = json_field<int>(json, "version", what);
  if (!version) return forward_error(version);
  if (*version == kVersion) return {};
  return fail(ErrorKind::kCorrupt, "{} has version {}; this Seedframe reads version {}{}", what,
              *version, kVersion, *version > kVersion ? ": use a newer Seedframe" : "");
}

Status check_description(const AssetDescription& description, const fs::path& folder,
                         const std::string& what) {
  if (description.name != fs::absolute(folder).lexically_normal().filename().string()) {
    return fail(ErrorKind::kCorrupt, "{}: the asset is named '{}', but its folder is {}", what,
                description.name, folder.string());
  }
  if (description.slots.empty()) {
    return fail(ErrorKind::kCorrupt, "{}: 'slots' must name one material slot or more", what);
  }
  if (!(description.smooth_angle_deg >= 0.0 && description.smooth_angle_deg <= 180.0)) {
    return fail(ErrorKind::kCorrupt, "{}: 'smooth_angle_deg' must be 0 to 180, found {}", what,
                description.smooth_angle_deg);
  }
  return {};
}

// Millimetre parts in metres: more digits than a micrometre would be quantisation noise.
double rounded_to_micrometre(double metres) { return std::round(metres * 1e6) / 1e6; }

Json describe(const Mesh& mesh, const std::string& stream, const AssetImport& request,
              const std::vector<std::string>& slots) {
  const Eigen::Vector3d size = bounding_box(mesh).size();
  Json size_m = Json::array();
  for (const double side : size) size_m.push_back(rounded_to_micrometre(side));
  return {{"version", kVersion},
          {"name", request.name},
          {"description", request.description},
          {"category", request.category},
          {"triangles", mesh.triangles.size()},
          {"vertices", mesh.positions.size()},
          {"bytes", stream.size()},
          {"size_m", size_m},
          {"smooth_angle_deg", request.smooth_angle_deg},
          {"slots", slots},
          {"mesh_sha256", sha256_hex(stream)},
          {"source", request.file.filename().string()}};
}

Status write_files(const fs::path& folder, const std::string& stream, const Json& description) {
  std::error_code error;
  fs::remove_all(folder, error);  // left by an import that was killed
  if (Status status = make_folders(folder); !status) return status;
  if (Status status = write_file(folder / asset_files::kMesh, stream); !status) return status;
  return write_file(folder / asset_files::kDescription, readable_json(description));
}

}  // namespace

bool is_asset_name(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  if (name.empty() || name.size() > kLongest) return false;
  return std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
}

Result<AssetDescription> read_asset_description(const fs::path& folder) {
  const fs::path path = folder / asset_files::kDescription;
  const std::string what = path.string();
  const auto text = read_file(path);
  if (!text) return forward_error(text);
  const auto json = parse_json(*text, what);
  if (!json) return forward_error(json);
  AssetDescription out;
  for (const Status& status :
       {check_version(*json, what), read_field(*json, "name", what, out.name),
        read_field(*json, "description", what, out.description),
        read_field(*json, "category", what, out.category),
        read_field(*json, "triangles", what, out.triangles),
        read_field(*json, "smooth_angle_deg", what, out.smooth_angle_deg),
        read_field(*json, "slots", what, out.slots),
        read_field(*json, "mesh_sha256", what, out.mesh_sha256)}) {
    if (!status) return forward_error(status);
  }
  if (Status status = check_description(out, folder, what); !status) return forward_error(status);
  return out;
}

Status write_asset(const fs::path& folder, const Mesh& mesh, const AssetImport& request) {
  const auto stream = encode_draco(mesh);
  if (!stream) return forward_error(stream);
  const auto compressed = decode_draco(*stream, request.file.string() + ", compressed");
  if (!compressed) return forward_error(compressed);
  // Hidden, so that no library takes it for an asset.
  const fs::path temporary = folder.parent_path() / ("." + request.name + ".importing");
  const Json description = describe(*compressed, *stream, request, mesh.slot_names);
  if (Status status = write_files(temporary, *stream, description); !status) return status;
  return commit_folder(temporary, folder);
}

}  // namespace seedframe
