#include "export/export_index.h"

#include "base/canonical_json.h"
#include "base/files.h"
#include "base/sha256.h"

namespace seedframe {
namespace {

// Also of the bytes of all formats: nothing is taken over from an export of another version.
constexpr int kVersion = 4;
constexpr std::size_t kHashDigits = 32;

}  // namespace

std::string dataset_hash(const Dataset& dataset) {
  Json keypoints = Json::array();
  for (const ClassKeypoints& points : dataset.keypoints) {
    keypoints.push_back({points.names, points.skeleton, points.mirrored});
  }
  Json assets = Json::array();
  for (const OfferedAsset& offered : dataset.assets) {
    assets.push_back({offered.asset->name, offered.asset->mesh_sha256});
  }
  return content_hash(canonical_json({dataset.categories, std::move(keypoints), std::move(assets),
                                      dataset.seed, dataset.has_images, dataset.has_depth}));
}

std::string marker_text(const ExportMarker& marker) {
  return readable_json({{"version", kVersion},
                        {"format", marker.format},
                        {"campaign", marker.campaign},
                        {"dataset", marker.dataset},
                        {"frames", marker.frames},
                        {"options", to_json(marker.options)}});
}

Result<ExportMarker> read_marker(const std::filesystem::path& export_folder) {
  const std::filesystem::path path = export_folder / kMarkerFile;
  const std::string what = path.string();
  const auto text = read_file(path);
  if (!text) return forward_error(text);
  const auto json = parse_json(*text, what);
  if (!json) return forward_error(json);
  const auto version = json_field<int>(*json, "version", what);
  if (!version) return forward_error(version);
  if (*version != kVersion) {
    return fail(ErrorKind::kCorrupt,
                "{} has version {}; this Seedframe reads version {}: export again", what, *version,
                kVersion);
  }
  ExportMarker marker;
  const auto format = json_field<std::string>(*json, "format", what);
  if (!format) return forward_error(format);
  marker.format = *format;
  const auto campaign = json_field<std::string>(*json, "campaign", what);
  if (!campaign) return forward_error(campaign);
  marker.campaign = *campaign;
  const auto dataset = json_field<std::string>(*json, "dataset", what);
  if (!dataset) return forward_error(dataset);
  marker.dataset = *dataset;
  const auto frames = json_field<std::int64_t>(*json, "frames", what);
  if (!frames) return forward_error(frames);
  marker.frames = *frames;
  auto options = export_options_from_json(json->value("options", Json()), what);
  if (!options) return forward_error(options);
  marker.options = std::move(*options);
  return marker;
}

std::string content_hash(std::string_view bytes) {
  return sha256_hex(bytes).substr(0, kHashDigits);
}

std::string content_hash_of_sha256(const std::string& sha256) {
  return sha256.substr(0, kHashDigits);
}

std::string index_line(const IndexEntry& entry) {
  Json files = Json::array();
  for (const IndexEntry::File& file : entry.files) files.push_back({file.path, file.hash});
  Json chunks = Json::array();
  for (const IndexEntry::Piece& piece : entry.pieces) {
    chunks.push_back({piece.document, piece.section, piece.bytes, piece.hash});
  }
  return canonical_json({{"frame", entry.frame},
                         {"key", entry.key},
                         {"split", entry.split},
                         {"counts", entry.counts},
                         {"files", std::move(files)},
                         {"chunks", std::move(chunks)}}) +
         "\n";
}

Result<IndexEntry> parse_index_line(const std::string& line, const std::string& what) {
  const auto json = parse_json(line, what);
  if (!json) return forward_error(json);
  IndexEntry entry;
  try {
    json->at("frame").get_to(entry.frame);
    json->at("key").get_to(entry.key);
    json->at("split").get_to(entry.split);
    json->at("counts").get_to(entry.counts);
    for (const Json& file : json->at("files")) {
      entry.files.push_back({file.at(0).get<std::string>(), file.at(1).get<std::string>()});
    }
    for (const Json& chunk : json->at("chunks")) {
      entry.pieces.push_back({chunk.at(0).get<std::string>(), chunk.at(1).get<int>(),
                              chunk.at(2).get<std::uint64_t>(), chunk.at(3).get<std::string>()});
    }
  } catch (const Json::exception& error) {
    return fail(ErrorKind::kCorrupt, "{}: {}", what, error.what());
  }
  return entry;
}

}  // namespace seedframe
