#include "assets/asset_files.h"

#include <algorithm>
#include <cmath>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr int kVersion = 2;

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
  return fail(ErrorKind::kCorrupt, "{} has version {}; this Seedframe reads version {}: {}", what,
              *version, kVersion,
              *version > kVersion ? "use a newer Seedframe" : "import the asset again");
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

// Four digits, and no digit less than the truth: what is stored as a bound must be one.
double rounded_up(double value) {
  if (!(value > 0.0)) return 0.0;
  const double per_unit = std::pow(10.0, 3.0 - std::floor(std::log10(value)));
  return std::ceil(value * per_unit) / per_unit;
}

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

// Millimetre parts in metres: more digits than a micrometre would be quantisation noise.
Json in_micrometres(const Eigen::Vector3d& metres) {
  Json list = Json::array();
  for (const double side : metres) list.push_back(rounded(side, 1e6));
  return list;
}

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json to_json(const MeshMeasures& measures, std::size_t self_intersections) {
  Json axes = Json::array();
  for (int i = 0; i < 3; ++i) {
    Json axis = Json::array();
    for (const double x : Eigen::Vector3d(measures.principal_axes.col(i))) {
      axis.push_back(rounded(x, 1e6));
    }
    axes.push_back(std::move(axis));
  }
  return {{"size_m", in_micrometres(measures.box.size())},
          {"area_m2", measures.area_m2},
          {"volume_m3", or_null(measures.volume_m3)},
          {"watertight", measures.watertight},
          {"boundary_edges", measures.boundary_edges},
          {"bad_edges", measures.bad_edges},
          {"parts", measures.parts},
          {"genus", or_null(measures.genus)},
          {"self_intersections", self_intersections},
          {"principal_axes", axes},
          {"principal_size_m", in_micrometres(measures.principal_size_m)}};
}

Json to_json(const RepairReport& repairs) {
  return {{"unused_vertices", repairs.unused_vertices},
          {"degenerate_triangles", repairs.degenerate_triangles},
          {"kept_slivers", repairs.kept_slivers},
          {"duplicate_triangles", repairs.duplicate_triangles},
          {"joined_edges", repairs.joined_edges},
          {"non_manifold_edges", repairs.non_manifold_edges},
          {"non_manifold_vertices", repairs.non_manifold_vertices},
          {"turned_triangles", repairs.turned_triangles},
          {"inside_out_parts", repairs.inside_out_parts},
          {"unused_slots", repairs.unused_slots},
          {"filled_holes", repairs.filled_holes},
          {"added_triangles", repairs.added_triangles}};
}

Json to_json(const LevelRecord& level, double size_m) {
  // Rounding must not lift an error over its bound either.
  const double error_m =
      std::min(rounded_up(level.error_m), std::max(level.error_m, level.bound_m));
  return {{"file", level.file},
          {"sha256", level.sha256},
          {"triangles", level.triangles},
          {"vertices", level.vertices},
          {"bytes", level.bytes},
          {"bits_per_coordinate", rounded(level.bits_per_coordinate(), 100.0)},
          {"position_bits", level.position_bits},
          {"pixels", level.pixels},
          {"bound_m", level.bound_m},
          {"error_m", error_m},
          {"error_share", rounded_up(level.error_m / size_m)}};
}

Status first_failure(std::initializer_list<Status> statuses) {
  const auto failed =
      std::find_if(statuses.begin(), statuses.end(), [](const Status& status) { return !status; });
  return failed == statuses.end() ? Status() : *failed;
}

Status read_level(const Json& json, const std::string& what, LevelRecord& out) {
  return first_failure(
      {read_field(json, "file", what, out.file), read_field(json, "sha256", what, out.sha256),
       read_field(json, "triangles", what, out.triangles),
       read_field(json, "vertices", what, out.vertices), read_field(json, "bytes", what, out.bytes),
       read_field(json, "position_bits", what, out.position_bits),
       read_field(json, "pixels", what, out.pixels), read_field(json, "bound_m", what, out.bound_m),
       read_field(json, "error_m", what, out.error_m)});
}

Status read_levels(const Json& json, const std::string& what, std::vector<LevelRecord>& out) {
  Json list;
  if (Status status = read_field(json, "levels", what, list); !status) return status;
  constexpr std::size_t kMostLevels = 16;
  if (!list.is_array() || list.empty() || list.size() > kMostLevels) {
    return fail(ErrorKind::kCorrupt, "{}: 'levels' must be a list of 1 to {}", what, kMostLevels);
  }
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string place = fmt::format("{}: levels[{}]", what, k);
    LevelRecord level;
    if (Status status = read_level(list[k], place, level); !status) return status;
    if (level.file != asset_files::level_file(k)) {
      return fail(ErrorKind::kCorrupt, "{}: expected the file {}, found '{}'", place,
                  asset_files::level_file(k), level.file);
    }
    out.push_back(std::move(level));
  }
  return {};
}

// A number, or null for none.
template <class T>
Status read_optional(const Json& json, const char* key, const std::string& what,
                     std::optional<T>& out) {
  Json value;
  if (Status status = read_field(json, key, what, value); !status) return status;
  if (value.is_null()) return {};
  T number{};
  if (Status status = read_field(json, key, what, number); !status) return status;
  out = number;
  return {};
}

Status read_measures(const Json& json, const std::string& what, AssetDescription& out) {
  MeshMeasures& measures = out.measures;
  Json object;
  if (Status status = read_field(json, "measures", what, object); !status) return status;
  const std::string place = what + ": measures";
  std::vector<double> size;
  Status read =
      first_failure({read_field(object, "size_m", place, size),
                     read_field(object, "area_m2", place, measures.area_m2),
                     read_optional(object, "volume_m3", place, measures.volume_m3),
                     read_field(object, "watertight", place, measures.watertight),
                     read_field(object, "boundary_edges", place, measures.boundary_edges),
                     read_field(object, "bad_edges", place, measures.bad_edges),
                     read_field(object, "parts", place, measures.parts),
                     read_optional(object, "genus", place, measures.genus),
                     read_field(object, "self_intersections", place, out.self_intersections)});
  if (!read) return read;
  if (size.size() != 3) {
    return fail(ErrorKind::kCorrupt, "{}: 'size_m' must be three numbers", place);
  }
  measures.box.high = Eigen::Vector3d(size[0], size[1], size[2]);
  measures.size_m = measures.box.size().maxCoeff();
  return {};
}

}  // namespace

std::string asset_files::level_file(std::size_t level) {
  return level == 0 ? kMesh : fmt::format("lod{}.drc", level);
}

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
  if (Status status = check_version(*json, what); !status) return forward_error(status);
  AssetDescription out;
  const Status read = first_failure(
      {read_field(*json, "name", what, out.name),
       read_field(*json, "description", what, out.description),
       read_field(*json, "category", what, out.category),
       read_field(*json, "smooth_angle_deg", what, out.smooth_angle_deg),
       read_field(*json, "slots", what, out.slots), read_field(*json, "source", what, out.source),
       read_levels(*json, what, out.levels), read_measures(*json, what, out)});
  if (!read) return forward_error(read);
  if (const auto found = json->find("keypoints"); found != json->end()) {
    auto keypoints = keypoints_from_json(*found, what + ": keypoints");
    if (!keypoints) return forward_error(keypoints);
    out.keypoints = std::move(*keypoints);
  }
  if (const auto found = json->find("materials"); found != json->end()) {
    auto materials = materials_from_json(*found, what + ": materials");
    if (!materials) return forward_error(materials);
    out.materials = std::move(*materials);
  }
  if (Status status = check_description(out, folder, what); !status) return forward_error(status);
  return out;
}

Json asset_json(const AssetDescription& asset) {
  Json levels = Json::array();
  for (const LevelRecord& level : asset.levels) {
    levels.push_back(to_json(level, asset.measures.size_m));
  }
  Json json = {{"version", kVersion},
               {"name", asset.name},
               {"description", asset.description},
               {"category", asset.category},
               {"smooth_angle_deg", asset.smooth_angle_deg},
               {"slots", asset.slots},
               {"source", asset.source},
               {"levels", levels},
               {"measures", to_json(asset.measures, asset.self_intersections)},
               {"repairs", to_json(asset.repairs)}};
  if (!asset.keypoints.points.empty()) json["keypoints"] = to_json(asset.keypoints);
  if (!asset.materials.empty()) json["materials"] = to_json(asset.materials);
  if (!asset.origin_m.isZero(0.0)) {
    json["origin_m"] = {asset.origin_m.x(), asset.origin_m.y(), asset.origin_m.z()};
  }
  return json;
}

Status set_keypoints(const fs::path& folder, const KeypointSet& keypoints) {
  const fs::path path = folder / asset_files::kDescription;
  // Everything that is there must be right: it is written back.
  if (const auto asset = read_asset_description(folder); !asset) return forward_error(asset);
  if (Status possible = check_keypoints(keypoints, path.string()); !possible) return possible;
  const auto text = read_file(path);
  if (!text) return forward_error(text);
  auto json = parse_json(*text, path.string());
  if (!json) return forward_error(json);
  json->erase("keypoints");
  if (!keypoints.points.empty()) (*json)["keypoints"] = to_json(keypoints);
  return write_file_atomically(path, readable_json(*json));
}

Status write_asset(const fs::path& folder, const AssetDescription& asset,
                   const std::map<std::string, std::string>& files) {
  // Hidden, so that no library takes it for an asset.
  const fs::path temporary = folder.parent_path() / ("." + asset.name + ".importing");
  std::error_code error;
  fs::remove_all(temporary, error);  // left by an import that was killed
  Status written = make_folders(temporary);
  for (auto file = files.begin(); written && file != files.end(); ++file) {
    const fs::path path = temporary / file->first;
    written = make_folders(path.parent_path());
    if (written) written = write_file(path, file->second);
  }
  if (written) {
    written = write_file(temporary / asset_files::kDescription, readable_json(asset_json(asset)));
  }
  if (written) written = commit_folder(temporary, folder);
  if (!written) fs::remove_all(temporary, error);
  return written;
}

Status remove_asset(const fs::path& folder) {
  const fs::path hidden = folder.parent_path() / ("." + folder.filename().string() + ".removing");
  std::error_code error;
  fs::remove_all(hidden, error);  // left by a removal that was killed
  if (Status renamed = rename_file(folder, hidden); !renamed) return renamed;
  fs::remove_all(hidden, error);
  if (!error) return {};
  return system_failure("remove", hidden, error.value());
}

}  // namespace seedframe
