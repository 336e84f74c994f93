#include "assets/asset_import.h"

#include <cmath>

#include "base/files.h"
#include "base/portable_math.h"
#include "base/sha256.h"
#include "base/utf8.h"
#include "mesh/mesh_self_intersections.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

Status check_request(const AssetImport& request) {
  if (!is_asset_name(request.name)) {
    return fail(ErrorKind::kInput,
                "'{}' cannot name an asset: use letters, digits, '_' and '-', 64 at most",
                request.name);
  }
  if (!std::isfinite(request.scale) || request.scale <= 0.0) {
    return fail(ErrorKind::kInput, "the scale must be more than 0 metres per unit, found {}",
                request.scale);
  }
  if (!(request.smooth_angle_deg >= 0.0 && request.smooth_angle_deg <= 180.0)) {
    return fail(ErrorKind::kInput, "the smoothing angle must be 0 to 180 degrees, found {}",
                request.smooth_angle_deg);
  }
  if (!(request.levels.pixels >= 4.0 && request.levels.pixels <= 1e6)) {
    return fail(ErrorKind::kInput, "the pixels of the nearest view must be 4 to 1000000, found {}",
                request.levels.pixels);
  }
  if (request.levels.most_levels < 0 || request.levels.most_levels > 8) {
    return fail(ErrorKind::kInput, "the number of levels must be 0 to 8, found {}",
                request.levels.most_levels);
  }
  constexpr std::size_t kLongestRim = 1000;  // filling takes the cube of it
  if (request.repair.fill_holes > kLongestRim) {
    return fail(ErrorKind::kInput, "holes to fill have at most {} edges, found {}", kLongestRim,
                request.repair.fill_holes);
  }
  std::error_code error;
  const fs::path folder = request.root / request.name;
  if (!request.dry_run && !request.replace && fs::exists(folder, error)) {
    return fail(ErrorKind::kInput, "{} exists; choose another name, or replace it with --force",
                folder.string());
  }
  return {};
}

Result<Mesh> read_scaled(const AssetImport& request) {
  auto mesh = read_mesh_file(request.file, request.up);
  if (!mesh) return mesh;
  for (auto& position : mesh->positions) {
    for (float& value : position) value = static_cast<float>(value * request.scale);
  }
  mesh->smooth_angle_rad = portable::radians(request.smooth_angle_deg);
  if (Status status = check_mesh(*mesh, request.file.string()); !status) {
    return forward_error(status);
  }
  return mesh;
}

// Most formats do not say what their unit is, and a part of 40 units is more likely 40 mm than 40
// m.
void warn_of_size(const AssetImport& request, double size_m, std::vector<std::string>& warnings) {
  constexpr double kLargest = 100.0;
  constexpr double kSmallest = 1e-4;
  if (size_m >= kSmallest && size_m <= kLargest) return;
  const double factor = size_m > kLargest ? 1e-3 : 1e3;
  warnings.push_back(fmt::format(
      "the longest side is {:.4g} m: if that is wrong, try --scale {:g}, which makes it {:.4g} m",
      size_m, request.scale * factor, size_m * factor));
}

void warn_of_surface(const AssetDescription& asset, std::vector<std::string>& warnings) {
  const MeshMeasures& measures = asset.measures;
  if (!measures.watertight) {
    warnings.push_back(fmt::format(
        "the surface is open ({} border edges): it has no volume, and placement cannot tell its "
        "inside; --fill-holes N closes holes of up to N edges",
        measures.boundary_edges));
  }
  if (asset.self_intersections > 0) {
    warnings.push_back(
        fmt::format("{}{} pairs of triangles run through each other: left as they "
                    "are; the volume counts what parts share once for each",
                    asset.self_intersections == kMostSelfIntersections ? "over " : "",
                    asset.self_intersections));
  }
}

LevelRecord record_of(const StoredLevel& level, std::size_t number) {
  return {.file = asset_files::level_file(number),
          .sha256 = sha256_hex(level.stream),
          .triangles = level.mesh.triangles.size(),
          .vertices = level.mesh.positions.size(),
          .bytes = level.stream.size(),
          .position_bits = level.position_bits,
          .pixels = level.pixels,
          .bound_m = level.bound_m,
          .error_m = level.error_m};
}

}  // namespace

Result<ImportReport> import_asset(const AssetImport& request) {
  const std::string what = request.file.string();
  if (Status status = check_request(request); !status) return forward_error(status);
  const auto read = read_scaled(request);
  if (!read) return forward_error(read);
  const auto repaired = repair_mesh(*read, request.repair, what);
  if (!repaired) return forward_error(repaired);
  const auto levels = make_levels(repaired->mesh, request.levels, what);
  if (!levels) return forward_error(levels);

  ImportReport report;
  AssetDescription& asset = report.description;
  asset.name = request.name;
  asset.description = request.description;
  asset.category = request.category;
  asset.smooth_angle_deg = request.smooth_angle_deg;
  asset.slots = repaired->mesh.slot_names;
  asset.source = as_utf8(request.file.filename().string());
  asset.repairs = repaired->report;
  asset.measures = measure_mesh(levels->front().mesh);
  const auto crossings = count_self_intersections(repaired->mesh, what);
  if (!crossings) return forward_error(crossings);
  asset.self_intersections = *crossings;
  asset.levels.reserve(levels->size());
  std::vector<std::string> streams;
  streams.reserve(levels->size());
  for (const StoredLevel& level : *levels) {
    asset.levels.push_back(record_of(level, asset.levels.size()));
    streams.push_back(level.stream);
  }
  warn_of_size(request, asset.measures.size_m, report.warnings);
  warn_of_surface(asset, report.warnings);
  if (request.levels.most_levels > 0 && asset.levels[0].triangles > kMostSimplifiedTriangles) {
    report.warnings.push_back(fmt::format(
        "no coarser levels: they are made of up to {} triangles; simplify the mesh before it is "
        "imported",
        kMostSimplifiedTriangles));
  }
  if (request.dry_run) return report;
  Status written = write_asset(request.root / request.name, asset, streams);
  if (!written) return forward_error(written);
  return report;
}

}  // namespace seedframe
