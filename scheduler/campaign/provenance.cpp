#include "campaign/provenance.h"

#include <algorithm>
#include <map>
#include <vector>

#include <OpenColorIO/OpenColorIO.h>
#include <OpenEXR/OpenEXRConfig.h>
#include <draco/core/draco_version.h>
#include <fmt/format.h>
#include <openssl/crypto.h>
#include <png.h>
#include <sqlite3.h>

#include "annotate/labels.h"
#include "base/files.h"
#include "base/sha256.h"
#include "frames/manifest.h"
#include "rays/ray_mesh.h"

namespace seedframe {
namespace {

constexpr int kVersion = 2;

/// Keeps what earlier runs of the campaign saw: this one may have looked at a few frames only.
Status merge(const Json& earlier, const std::string& what, const std::string& ocio_hash,
             Json& json) {
  for (const char* table : {"assets", "textures"}) {
    const auto before = json_field<std::map<std::string, std::string>>(earlier, table, what);
    if (!before) return forward_error(before);
    for (const auto& [name, sha256] : *before) json[table].emplace(name, sha256);
  }
  const auto attempts = json_field<std::vector<Json>>(earlier, "attempts", what);
  if (!attempts) return forward_error(attempts);
  for (const Json& attempt : *attempts) {
    const auto ocio = json_field<std::string>(attempt, "ocio_config_sha256", what);
    if (!ocio) return forward_error(ocio);
    if (*ocio == ocio_hash) continue;
    return fail(ErrorKind::kInput,
                "{}: the OpenColorIO config is not the one that the campaign's images were made "
                "with (SHA-256 {}…): set image.ocio_config to that one, or submit a new campaign",
                what, ocio->substr(0, 12));
  }
  json["attempts"] = *attempts;
  return {};
}

/// Over the programs of a worker, by name.
Result<std::string> hash_of_scripts(const std::filesystem::path& folder) {
  std::map<std::string, std::string> hashes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".py") continue;
    Result<std::string> hash = sha256_of_file(entry.path());
    if (!hash) return hash;
    hashes[entry.path().filename().string()] = std::move(*hash);
  }
  return sha256_hex(canonical_json(hashes));
}

/// What is the same for all attempts of a run.
Result<Json> common_facts(const std::string& ocio_hash, const RunSetup& setup) {
  const WorkerOptions& worker = setup.options.worker;
  Json facts = {{"seedframe", SEEDFRAME_VERSION},  {"frame_spec", kFrameSpecVersion},
                {"manifest", kManifestVersion},    {"labels", kLabelsVersion},
                {"libraries", library_versions()}, {"twin_isa", ray_tracing_isa()},
                {"ocio_config_sha256", ocio_hash}, {"threads", worker.threads}};
  if (!setup.color) return facts;
  const Result<std::string> scripts = hash_of_scripts(worker.scripts);
  if (!scripts) return forward_error(scripts);
  facts["blender_sha256"] = setup.blender.sha256;
  facts["scripts_sha256"] = *scripts;
  facts["persistent_data"] = worker.conditions.persistent_data;
  return facts;
}

}  // namespace

Json library_versions() {
  return {
      {"draco", draco::kDracoVersion},         {"embree", ray_tracing_version()},
      {"libpng", png_get_libpng_ver(nullptr)}, {"opencolorio", OCIO_NAMESPACE::GetVersion()},
      {"openexr", OPENEXR_VERSION_STRING},     {"openssl", OpenSSL_version(OPENSSL_VERSION_STRING)},
      {"sqlite", sqlite3_libversion()}};
}

std::map<std::string, std::string> asset_hashes(const UsedFiles& used) {
  std::map<std::string, std::string> hashes;
  for (const auto& [name, asset] : used.assets) hashes[name] = asset->mesh_sha256;
  return hashes;
}

std::map<std::string, std::string> image_hashes(const UsedFiles& used) {
  std::map<std::string, std::string> hashes;
  for (const auto& [sha256, file] : used.images) {
    const std::filesystem::path& path = file->path;
    hashes[path.parent_path().filename().string() + "/" + path.filename().string()] = sha256;
  }
  return hashes;
}

Result<Provenance> Provenance::load(const CampaignFiles& files, const PreparedCampaign& prepared,
                                    const UsedFiles& used, const RunSetup& setup) {
  const std::string ocio_hash = setup.color ? setup.color->config_hash() : std::string();
  Json overrides = Json::array();
  for (const Override& change : prepared.source.overrides) {
    overrides.push_back(change.path + "=" + change.value);
  }
  Json json = {{"version", kVersion},          {"config_sha256", sha256_hex(prepared.source.text)},
               {"overrides", overrides},       {"seed", prepared.settings.seed},
               {"assets", asset_hashes(used)}, {"textures", image_hashes(used)},
               {"attempts", Json::array()}};
  std::error_code error;
  if (std::filesystem::exists(files.provenance(), error)) {
    const std::string what = files.provenance().string();
    const Result<std::string> text = read_file(files.provenance());
    if (!text) return forward_error(text);
    const Result<Json> earlier = parse_json(*text, what);
    if (!earlier) return forward_error(earlier);
    if (Status merged = merge(*earlier, what, ocio_hash, json); !merged) {
      return forward_error(merged);
    }
  }
  Result<Json> common = common_facts(ocio_hash, setup);
  if (!common) return forward_error(common);
  return Provenance(files.provenance(), std::move(json), std::move(*common));
}

Json Provenance::json_of_worker(const ReadyMessage& ready) const {
  Json attempt = common_;
  attempt["blender"] = ready.blender;
  attempt["build"] = ready.build;
  attempt["kernel"] = ready.kernel;
  attempt["embree"] = ready.embree;
  attempt["reciprocals"] = ready.reciprocals;
  attempt["libc"] = ready.libc;
  attempt["device"] = ready.device;
  return attempt;
}

std::string Provenance::text_of_worker(const ReadyMessage& ready) const {
  return canonical_json(json_of_worker(ready));
}

Result<std::string> Provenance::of_worker(const ReadyMessage& ready) {
  return add(json_of_worker(ready));
}

Result<std::string> Provenance::of_record(const std::string& attempt) {
  Result<Json> json = parse_json(attempt, "the provenance of an attempt");
  if (!json) return forward_error(json);
  return add(std::move(*json));
}

Result<std::string> Provenance::of_twin() { return add(common_); }

Result<std::string> Provenance::add(Json attempt) {
  std::string text = canonical_json(attempt);
  Json& attempts = json_["attempts"];
  if (std::find(attempts.begin(), attempts.end(), attempt) != attempts.end()) return text;
  attempts.push_back(std::move(attempt));
  if (Status written = write(); !written) {
    attempts.erase(attempts.size() - 1);  // or nobody would write it
    return forward_error(written);
  }
  return text;
}

Status Provenance::add_inputs(const UsedFiles& used) {
  const Json before = json_;
  for (const auto& [table, hashes] :
       {std::pair("assets", asset_hashes(used)), std::pair("textures", image_hashes(used))}) {
    for (const auto& [name, sha256] : hashes) json_[table].emplace(name, sha256);
  }
  if (json_ == before) return {};
  Status written = write();
  if (!written) json_ = before;
  return written;
}

std::string Provenance::departure(const std::string& attempt) const {
  const Json now = Json::parse(attempt);
  std::string difference;
  for (const Json& before : earlier_) {
    difference = describe_difference(now, before);
    if (difference.empty()) return {};
  }
  if (difference.empty()) return {};
  return fmt::format(
      "this run renders with {}, as no earlier run of the campaign: the same frame could get other "
      "pixels (docs/determinism.md); 'seedframe explain' tells what made a frame",
      difference);
}

Status Provenance::write() const { return write_file_atomically(path_, readable_json(json_)); }

std::string describe_difference(const Json& found, const Json& expected) {
  std::vector<std::string> differences;
  for (const auto& [key, value] : expected.items()) {
    const Json other = found.contains(key) ? found[key] : Json();
    if (other == value || key == "threads") continue;
    const auto text = [](const Json& each) {
      return each.is_string() ? each.get<std::string>().substr(0, 16) : each.dump();
    };
    differences.push_back(fmt::format("{} {} instead of {}", key, text(other), text(value)));
  }
  return fmt::format("{}", fmt::join(differences, ", "));
}

}  // namespace seedframe
