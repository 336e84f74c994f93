#include "cli/asset_report.h"

#include <cmath>
#include <iterator>

#include <fmt/ranges.h>

#include "base/message_text.h"
#include "base/utf8.h"

namespace seedframe {
namespace {

namespace fs = std::filesystem;

std::string size_text(const Eigen::Vector3d& metres) {
  constexpr double kLong = 10.0;
  if (metres.maxCoeff() >= kLong) {
    return fmt::format("{:.1f} × {:.1f} × {:.1f} m", metres.x(), metres.y(), metres.z());
  }
  const Eigen::Vector3d mm = 1000.0 * metres;
  return fmt::format("{:.1f} × {:.1f} × {:.1f} mm", mm.x(), mm.y(), mm.z());
}

std::string length_text(double metres) {
  if (metres >= 1.0) return fmt::format("{:.3g} m", metres);
  if (metres >= 1e-3) return fmt::format("{:.3g} mm", 1e3 * metres);
  if (metres >= 1e-6) return fmt::format("{:.3g} µm", 1e6 * metres);
  return fmt::format("{:.0f} nm", 1e9 * metres);
}

std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string surface_text(const MeshMeasures& measures) {
  std::string text = measures.watertight
                         ? "watertight"
                         : fmt::format("open, {}", counted(measures.boundary_edges, "border edge"));
  text += fmt::format(", {}", counted(measures.parts, "part"));
  if (measures.genus) text += fmt::format(", genus {}", *measures.genus);
  text += fmt::format(", area {:.4g} cm²", 1e4 * measures.area_m2);
  if (measures.volume_m3) text += fmt::format(", volume {:.4g} cm³", 1e6 * *measures.volume_m3);
  return text;
}

std::string axes_text(const MeshMeasures& measures) {
  std::string text = size_text(measures.principal_size_m) + " along";
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = measures.principal_axes.col(i);
    // To hundredths, and 0 instead of -0.
    const Eigen::Array3d shown = (100.0 * axis.array()).round() / 100.0 + 0.0;
    text += fmt::format(" ({:.2f}, {:.2f}, {:.2f})", shown.x(), shown.y(), shown.z());
  }
  return text;
}

// What was mended, and what was found and left.
std::string repairs_text(const RepairReport& repairs) {
  const std::pair<std::size_t, const char*> mended[] = {
      {repairs.unused_vertices, "stray vertices removed"},
      {repairs.degenerate_triangles, "triangles without area removed"},
      {repairs.duplicate_triangles, "duplicate triangles removed"},
      {repairs.joined_edges, "pairs of borders joined"},
      {repairs.non_manifold_edges, "non-manifold edges taken apart"},
      {repairs.non_manifold_vertices, "non-manifold vertices taken apart"},
      {repairs.turned_triangles, "triangles turned round"},
      {repairs.inside_out_parts, "inside-out parts turned round"},
      {repairs.unused_slots, "material slots without triangles removed"},
      {repairs.filled_holes, "holes filled"},
      {repairs.kept_slivers, "slivers without area kept"}};
  std::string text;
  for (const auto& [count, what] : mended) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  }
  return text.empty() ? "nothing to repair" : text;
}

std::string levels_text(const AssetDescription& asset) {
  std::string text =
      fmt::format("  {:<9}{:>10}{:>10}{:>11}{:>11}{:>11}  {:<15}{}\n", "level", "triangles",
                  "vertices", "bytes", "bits/coord", "error", "of the size", "for views of");
  for (const LevelRecord& level : asset.levels) {
    const double share = level.error_m > 0.0 ? asset.measures.size_m / level.error_m : 0.0;
    text +=
        fmt::format("  {:<9}{:>10}{:>10}{:>11}{:>11.2f}{:>11}  {:<15}{:g} px at most\n", level.file,
                    level.triangles, level.vertices, level.bytes, level.bits_per_coordinate(),
                    length_text(level.error_m),
                    share > 0.0 ? fmt::format("1/{:.0f}", std::floor(share)) : "0", level.pixels);
  }
  return text;
}

// Names of files and of what is in them may be of any bytes.
Json texts_json(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back(as_utf8(text));
  return list;
}

std::string thumbnail_of(const fs::path& folder) {
  std::error_code error;
  const fs::path path = folder / asset_files::kThumbnail;
  return fs::is_regular_file(path, error) ? path.string() : std::string();
}

}  // namespace

std::string import_text(const ImportReport& report, bool written) {
  const AssetDescription& asset = report.description;
  std::string text = fmt::format("{}{}: {}, {}\n", asset.name, written ? "" : " (not written)",
                                 asset.source, size_text(asset.measures.box.size()));
  if (report.unit_was_guessed) {
    text += "  unit     metres, as the file does not say: --unit mm, cm, m or in\n";
  }
  text += fmt::format("  surface  {}\n", surface_text(asset.measures));
  text += fmt::format("  axes     {}\n", axes_text(asset.measures));
  text += fmt::format("  repairs  {}\n", repairs_text(asset.repairs));
  text += levels_text(asset);
  if (!asset.materials.empty()) {
    text +=
        fmt::format("  looks    'material: own' gives {} of {} slots what the file gives them\n",
                    asset.materials.size(), asset.slots.size());
  }
  if (!report.not_kept.empty()) {
    text += fmt::format("  not kept {}\n", fmt::join(report.not_kept, "; "));
  }
  for (const std::string& warning : report.warnings) {
    text += fmt::format("  warning: {}\n", warning);
  }
  return printable(text);
}

Json import_json(const ImportReport& report) {
  Json json = asset_json(report.description);
  json["unit_was_guessed"] = report.unit_was_guessed;
  json["warnings"] = texts_json(report.warnings);
  json["not_kept"] = texts_json(report.not_kept);
  return json;
}

std::string list_line(const AssetDescription& asset, const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::string coarser;
  for (const LevelRecord& level : asset.levels) {
    bytes += level.bytes;
    if (&level != asset.levels.data()) coarser += fmt::format(" {}", level.triangles);
  }
  const std::string thumbnail = thumbnail_of(folder);
  return printable(
      fmt::format("{:<18} {:<16} {:>8} triangles {:>8.1f} KiB  {:<24} coarser:{:<24} {}{}",
                  asset.name, asset.category.empty() ? "(distractor)" : asset.category,
                  asset.levels[0].triangles, static_cast<double>(bytes) / 1024.0,
                  size_text(asset.measures.box.size()), coarser.empty() ? " none" : coarser,
                  asset.description, thumbnail.empty() ? "" : "  " + thumbnail));
}

Json list_json(const AssetDescription& asset, const fs::path& folder) {
  Json json = asset_json(asset);
  json.erase("repairs");  // not read back
  json["measures"].erase("principal_axes");
  json["measures"].erase("principal_size_m");
  const std::string thumbnail = thumbnail_of(folder);
  json["folder"] = as_utf8(folder.string());
  json["thumbnail"] = thumbnail.empty() ? Json() : Json(as_utf8(thumbnail));
  return json;
}

}  // namespace seedframe
