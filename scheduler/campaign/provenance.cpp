#include "campaign/provenance.h"

#include <algorithm>

#include <OpenColorIO/OpenColorIO.h>
#include <OpenEXR/OpenEXRConfig.h>
#include <draco/core/draco_version.h>
#include <openssl/crypto.h>
#include <png.h>
#include <sqlite3.h>

#include "base/files.h"
#include "base/sha256.h"

namespace seedframe {
namespace {

constexpr int kVersion = 1;

}  // namespace

Json library_versions() {
  return {{"draco", draco::kDracoVersion},
          {"libpng", png_get_libpng_ver(nullptr)},
          {"opencolorio", OCIO_NAMESPACE::GetVersion()},
          {"openexr", OPENEXR_VERSION_STRING},
          {"openssl", OpenSSL_version(OPENSSL_VERSION_STRING)},
          {"sqlite", sqlite3_libversion()}};
}

Result<Provenance> Provenance::load(const CampaignFiles& files, const PreparedCampaign& prepared,
                                    const std::string& ocio_hash) {
  Json overrides = Json::array();
  for (const Override& change : prepared.source.overrides) {
    overrides.push_back(change.path + "=" + change.value);
  }
  Json textures = Json::object();
  for (const auto& [sha256, file] : prepared.expander.textures()) {
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
               {"workers", Json::array()}};
  std::error_code error;
  if (std::filesystem::exists(files.provenance(), error)) {
    const Result<std::string> text = read_file(files.provenance());
    if (!text) return forward_error(text);
    const Result<Json> earlier = parse_json(*text, files.provenance().string());
    if (!earlier) return forward_error(earlier);
    if (earlier->contains("workers")) json["workers"] = (*earlier)["workers"];
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
