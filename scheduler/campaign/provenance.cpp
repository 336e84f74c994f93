#include "campaign/provenance.h"

#include <algorithm>
#include <map>
#include <vector>

#include <OpenColorIO/OpenColorIO.h>
#include <OpenEXR/OpenEXRConfig.h>
#include <draco/core/draco_version.h>
#include <openssl/crypto.h>
#include <png.h>
#include <sqlite3.h>

#include "base/files.h"
#include "base/sha256.h"
#include "geometry/ray_mesh.h"

namespace seedframe {
namespace {

constexpr int kVersion = 1;

/// Keeps what earlier runs of the campaign saw: this one may have looked at a few frames only.
Status merge(const Json& earlier, const std::string& what, Json& json) {
  const auto ocio = json_field<std::string>(earlier, "ocio_config_sha256", what);
  if (!ocio) return forward_error(ocio);
  if (*ocio != json["ocio_config_sha256"]) {
    return fail(ErrorKind::kInput,
                "{}: the OpenColorIO config is not the one that the campaign's images were made "
                "with (SHA-256 {}…): set image.ocio_config to that one, or submit a new campaign",
                what, ocio->substr(0, 12));
  }
  for (const char* table : {"assets", "textures"}) {
    const auto before = json_field<std::map<std::string, std::string>>(earlier, table, what);
    if (!before) return forward_error(before);
    for (const auto& [name, sha256] : *before) json[table].emplace(name, sha256);
  }
  const auto workers = json_field<std::vector<Json>>(earlier, "workers", what);
  if (!workers) return forward_error(workers);
  json["workers"] = *workers;
  const auto isas = json_field<std::vector<std::string>>(earlier, "twin_isa", what);
  if (!isas) return forward_error(isas);
  for (const std::string& isa : *isas) {
    if (isa != json["twin_isa"][0]) json["twin_isa"].push_back(isa);
  }
  return {};
}

}  // namespace

Json library_versions() {
  return {
      {"draco", draco::kDracoVersion},         {"embree", ray_tracing_version()},
      {"libpng", png_get_libpng_ver(nullptr)}, {"opencolorio", OCIO_NAMESPACE::GetVersion()},
      {"openexr", OPENEXR_VERSION_STRING},     {"openssl", OpenSSL_version(OPENSSL_VERSION_STRING)},
      {"sqlite", sqlite3_libversion()}};
}

Result<Provenance> Provenance::load(const CampaignFiles& files, const PreparedCampaign& prepared,
                                    const std::string& ocio_hash) {
  Json overrides = Json::array();
  for (const Override& change : prepared.source.overrides) {
    overrides.push_back(change.path + "=" + change.value);
  }
  Json textures = Json::object();
  for (const auto& [sha256, file] : prepared.expander.image_files()) {
    textures[file.parent_path().filename().string() + "/" + file.filename().string()] = sha256;
  }
  Json json = {{"version", kVersion},
               {"seedframe", SEEDFRAME_VERSION},
               {"config_sha256", sha256_hex(prepared.source.text)},
               {"overrides", overrides},
               {"seed", prepared.config.seed},
               {"assets", prepared.expander.asset_hashes()},
               {"textures", textures},
               {"ocio_config_sha256", ocio_hash},
               {"libraries", library_versions()},
               {"twin_isa", {ray_tracing_isa()}},
               {"workers", Json::array()}};
  std::error_code error;
  if (std::filesystem::exists(files.provenance(), error)) {
    const Result<std::string> text = read_file(files.provenance());
    if (!text) return forward_error(text);
    const Result<Json> earlier = parse_json(*text, files.provenance().string());
    if (!earlier) return forward_error(earlier);
    if (Status merged = merge(*earlier, files.provenance().string(), json); !merged) {
      return forward_error(merged);
    }
  }
  return Provenance(files.provenance(), std::move(json));
}

Status Provenance::add_worker(const ReadyMessage& ready) {
  Json worker = {{"blender", ready.blender}, {"build", ready.build}, {"cpu", ready.cpu}};
  Json& workers = json_["workers"];
  if (std::find(workers.begin(), workers.end(), worker) != workers.end()) return {};
  workers.push_back(std::move(worker));
  return write();
}

Status Provenance::write() const { return write_file_atomically(path_, readable_json(json_)); }

}  // namespace seedframe
