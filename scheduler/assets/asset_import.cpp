#include "assets/asset_import.h"

#include <algorithm>
#include <cmath>

#include "assets/thumbnail.h"
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
  if (const double scale = request.scale.value_or(1.0); !std::isfinite(scale) || scale <= 0.0) {
    return fail(ErrorKind::kInput, "the scale must be more than 0 metres per unit, found {}",
                scale);
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

// A tenth of what compression may move the surface by.
double tolerated_rounding(double pixels) { return std::min(5e-6, 0.1 * kPixelShare / pixels); }

Result<MeshFile> read_file_of(const AssetImport& request) {
  auto file =
      read_mesh_file(request.file, {.up = request.up,
                                    .scale = request.scale.value_or(1.0),
                                    .most_rounding = tolerated_rounding(request.levels.pixels)});
  if (file) file->mesh.smooth_angle_rad = portable::radians(request.smooth_angle_deg);
  return file;
}

// Most formats do not say what their unit is, and a part of 40 units is more likely 40 mm than 40
// m.
void warn_of_size(const AssetImport& request, const MeshFile& file, const MeshMeasures& measures,
                  std::vector<std::string>& warnings) {
  constexpr double kLargest = 100.0;
  constexpr double kSmallest = 1e-4;
  constexpr double kLargestGuessed = 2.0;
  const double size_m = measures.size_m;
  if (!request.scale && !file.has_unit && size_m > kLargestGuessed) {
    const Eigen::Vector3d side = measures.box.size();
    warnings.push_back(fmt::format(
        "{:.1f} × {:.1f} × {:.1f} m: the file does not say its unit, and metres were taken; if it "
        "is in millimetres, --unit mm; if it is right, --unit m",
        side.x(), side.y(), side.z()));
    return;
  }
  if (size_m >= kSmallest && size_m <= kLargest) return;
  const double factor = size_m > kLargest ? 1e-3 : 1e3;
  warnings.push_back(fmt::format(
      "the longest side is {:.4g} m: if that is wrong, try --scale {:g}, which makes it {:.4g} m",
      size_m, request.scale.value_or(1.0) * factor, size_m * factor));
}

// The two that are seen in files with y up: who wrote it, and a thing that stands on y = 0.
void warn_of_up(const AssetImport& request, const MeshFile& file,
                std::vector<std::string>& warnings) {
  if (request.up || file.has_up) return;
  const BoundingBox box = bounding_box(file.mesh);
  const Eigen::Vector3d low = box.low + file.origin_m;
  const Eigen::Vector3d high = box.high + file.origin_m;
  const double size = (high - low).maxCoeff();
  const auto stands_on = [&](int axis) { return std::abs(low[axis]) <= 1e-3 * size; };
  const auto centred = [&](int axis) { return std::abs(low[axis] + high[axis]) <= 0.02 * size; };
  std::string why;
  if (centred(0) && centred(2) && stands_on(1) && !stands_on(2)) {
    why = "it stands on y = 0 and is centred in x and z";
  } else if (file.by_y_up_program && !(centred(1) && stands_on(2))) {
    why = "Blender wrote it, with y up unless it was told otherwise";
  }
  if (why.empty()) return;
  warnings.push_back(fmt::format(
      "z was taken for up, but it may be y: {}; --up y turns it, --up z says that it is right",
      why));
}

void warn_of_rounding(const MeshFile& file, double size_m, std::vector<std::string>& warnings) {
  if (!file.origin_m.isZero(0.0)) {
    warnings.push_back(fmt::format(
        "it was moved to the origin: the file has it at ({:.12g}, {:.12g}, {:.12g}) m, where "
        "32-bit floats are too coarse for it",
        file.origin_m.x(), file.origin_m.y(), file.origin_m.z()));
  }
  constexpr double kCoarse = 1e-4;
  if (file.spacing_m > kCoarse * size_m) {
    warnings.push_back(fmt::format(
        "the file itself has only 32-bit floats, which are {:.2g} m apart this far from the "
        "origin, 1/{:.0f} of its size: what was finer is lost; export it nearer to the origin",
        file.spacing_m, size_m / file.spacing_m));
  }
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
  const auto begin = [&](const char* step) {
    if (request.on_step) request.on_step(step);
  };
  if (Status status = check_request(request); !status) return forward_error(status);
  begin("reading it");
  const auto file = read_file_of(request);
  if (!file) return forward_error(file);
  begin("repairing it");
  const auto repaired = repair_mesh(file->mesh, request.repair, what);
  if (!repaired) return forward_error(repaired);
  LevelOptions options = request.levels;
  options.rounding_m = file->rounding_m;
  options.on_step = request.on_step;
  const auto levels = make_levels(repaired->mesh, options, what);
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
  asset.origin_m = file->origin_m;
  begin("measuring it");
  asset.measures = measure_mesh(levels->front().mesh);
  begin("looking for triangles that run through each other");
  const auto crossings = count_self_intersections(repaired->mesh, what);
  if (!crossings) return forward_error(crossings);
  asset.self_intersections = *crossings;
  asset.levels.reserve(levels->size());
  begin("reading its images");
  MadeMaterials made = make_materials(file->materials, asset.slots);
  asset.materials = std::move(made.materials);
  std::map<std::string, std::string>& files = made.files;
  for (const StoredLevel& level : *levels) {
    asset.levels.push_back(record_of(level, asset.levels.size()));
    files[asset.levels.back().file] = level.stream;
  }
  report.unit_was_guessed = !request.scale && !file->has_unit;
  report.not_kept = file->not_kept;
  report.warnings = file->dropped;
  report.warnings.insert(report.warnings.end(), made.dropped.begin(), made.dropped.end());
  warn_of_size(request, *file, asset.measures, report.warnings);
  warn_of_up(request, *file, report.warnings);
  warn_of_rounding(*file, asset.measures.size_m, report.warnings);
  warn_of_surface(asset, report.warnings);
  if (request.levels.most_levels > 0 && asset.levels[0].triangles > kMostSimplifiedTriangles) {
    report.warnings.push_back(fmt::format(
        "no coarser levels: they are made of up to {} triangles; simplify the mesh before it is "
        "imported",
        kMostSimplifiedTriangles));
  }
  if (request.dry_run) return report;
  begin("writing it");
  files[asset_files::kThumbnail] = thumbnail_png(levels->front().mesh);
  Status written = write_asset(request.root / request.name, asset, files);
  if (!written) return forward_error(written);
  return report;
}

}  // namespace seedframe
