#include "frames/manifest.h"

#include "base/files.h"
#include "base/sha256.h"
#include "frames/campaign_files.h"

namespace seedframe {
namespace fs = std::filesystem;

std::string Manifest::pixel_hash() const { return sha256_hex(canonical_json(pixel_hashes)); }

std::string Manifest::image_file() const { return frame_files::image(image.format); }

bool Manifest::picture_is(const ImageEncoding& encoding) const {
  return !pixel_hashes.contains("image") || image == encoding;
}

Json to_json(const Manifest& manifest) {
  Json files = Json::object();
  for (const auto& [name, file] : manifest.files) {
    files[name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  }
  Json json = {{"version", kManifestVersion},
               {"frame_id", manifest.frame_id},
               {"pixels", manifest.pixel_hashes},
               {"twin",
                {{"pixels", manifest.twin.pixels},
                 {"inside_px", manifest.twin.inside_px},
                 {"edge_px", manifest.twin.edge_px}}},
               {"files", files}};
  // Left out where nothing was asked for, as in all manifests from before there was a choice.
  if (manifest.image != ImageEncoding{}) json["image"] = to_json(manifest.image);
  return json;
}

namespace {

Result<TwinTally> read_tally(const Json& manifest, const std::string& what) {
  const auto json = json_field<Json>(manifest, "twin", what);
  if (!json) return forward_error(json);
  TwinTally tally;
  for (const auto& [key, value] :
       {std::pair("pixels", &tally.pixels), std::pair("inside_px", &tally.inside_px),
        std::pair("edge_px", &tally.edge_px)}) {
    const auto number = json_field<std::int64_t>(*json, key, what);
    if (!number) return forward_error(number);
    *value = *number;
  }
  return tally;
}

}  // namespace

Result<Manifest> parse_manifest(std::string_view text, const std::string& what) {
  const Result<Json> json = parse_json(text, what);
  if (!json) return forward_error(json);
  const Result<int> version = json_field<int>(*json, "version", what);
  if (!version) return forward_error(version);
  if (*version != kManifestVersion) {
    return fail(ErrorKind::kCorrupt, "{} is of version {}; this program reads version {}", what,
                *version, kManifestVersion);
  }
  const auto frame_id = json_field<std::string>(*json, "frame_id", what);
  if (!frame_id) return forward_error(frame_id);
  const auto pixels = json_field<std::map<std::string, std::string>>(*json, "pixels", what);
  if (!pixels) return forward_error(pixels);
  const auto files = json_field<std::map<std::string, Json>>(*json, "files", what);
  if (!files) return forward_error(files);
  const auto twin = read_tally(*json, what);
  if (!twin) return forward_error(twin);
  Manifest manifest{*frame_id, *pixels, {}, *twin};
  if (const auto image = json->find("image"); image != json->end()) {
    const auto encoding = image_encoding_from_json(*image, what);
    if (!encoding) return forward_error(encoding);
    manifest.image = *encoding;
  }
  for (const auto& [name, entry] : *files) {
    const auto bytes = json_field<std::uint64_t>(entry, "bytes", what);
    if (!bytes) return forward_error(bytes);
    const auto sha256 = json_field<std::string>(entry, "sha256", what);
    if (!sha256) return forward_error(sha256);
    if (name.empty() || name.find('/') != std::string::npos) {
      return fail(ErrorKind::kCorrupt, "{}: '{}' is not the name of a file of a frame", what, name);
    }
    manifest.files[name] = {*bytes, *sha256};
  }
  return manifest;
}

Result<Manifest> read_manifest(const fs::path& frame_folder) {
  std::error_code ignored;
  const fs::file_status what = fs::symlink_status(frame_folder, ignored);
  if (fs::exists(what) && !fs::is_directory(what)) {
    return fail(ErrorKind::kCorrupt, "{} is {}, not the folder of a frame", frame_folder.string(),
                fs::is_symlink(what) ? "a link" : "a file");
  }
  const fs::path path = frame_folder / frame_files::kManifest;
  const Result<std::string> text = read_file(path);
  if (!text) return fail(ErrorKind::kCorrupt, "{}", text.error().message);
  return parse_manifest(*text, path.string());
}

Result<Manifest> verify_frame(const fs::path& frame_folder, const std::string& frame_id,
                              VerifyDepth depth) {
  Result<Manifest> manifest = read_manifest(frame_folder);
  if (!manifest) return manifest;
  if (manifest->frame_id != frame_id) {
    return fail(ErrorKind::kCorrupt, "{} holds another frame: id {} instead of {}",
                frame_folder.string(), manifest->frame_id, frame_id);
  }
  for (const auto& [name, file] : manifest->files) {
    const fs::path path = frame_folder / name;
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(path, error);
    if (error) return fail(ErrorKind::kCorrupt, "{} is missing", path.string());
    if (bytes != file.bytes) {
      return fail(ErrorKind::kCorrupt, "{} has {} bytes instead of {}", path.string(), bytes,
                  file.bytes);
    }
    if (depth == VerifyDepth::kSizes) continue;
    const Result<std::string> sha256 = sha256_of_file(path);
    if (!sha256) return forward_error(sha256);
    if (*sha256 != file.sha256) {
      return fail(ErrorKind::kCorrupt, "{} has changed since it was written (SHA-256)",
                  path.string());
    }
  }
  return manifest;
}

}  // namespace seedframe
