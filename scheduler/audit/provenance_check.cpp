#include "audit/provenance_check.h"

#include <algorithm>
#include <map>

#include "base/files.h"
#include "base/sha256.h"
#include "campaign/provenance.h"
#include "rays/ray_mesh.h"

namespace seedframe {
namespace {

constexpr const char* kFile = "provenance.json";

void compare(const Json& found, const char* key, const Json& expected,
             std::vector<std::string>& wrong) {
  const Json value = found.value(key, Json());
  if (value == expected) return;
  wrong.push_back(
      fmt::format("{}: {} is {} instead of {}", kFile, key, value.dump(), expected.dump()));
}

void compare_table(const Json& found, const char* key,
                   const std::map<std::string, std::string>& expected,
                   std::vector<std::string>& wrong) {
  const Json table = found.value(key, Json::object());
  for (const auto& [name, sha256] : expected) {
    const Json value = table.is_object() ? table.value(name, Json()) : Json();
    if (value == sha256) continue;
    wrong.push_back(fmt::format("{}: {}: {} has the SHA-256 {} instead of {}", kFile, key, name,
                                value.dump(), sha256));
  }
}

/// Every attempt that the store knows; the file may have those of workers that made nothing.
void compare_attempts(const Json& found, const std::vector<std::string>& known,
                      std::vector<std::string>& wrong) {
  const Json attempts = found.value("attempts", Json::array());
  for (const std::string& text : known) {
    const Json attempt = Json::parse(text, nullptr, false);
    if (!attempt.is_object()) continue;  // nobody knew
    if (std::find(attempts.begin(), attempts.end(), attempt) == attempts.end()) {
      wrong.push_back(
          fmt::format("{} does not have what attempts were made with, as the job store has it: {}",
                      kFile, text));
    }
  }
}

}  // namespace

std::vector<std::string> wrong_provenance(const Campaign& campaign,
                                          const PreparedCampaign* prepared, const UsedFiles& used) {
  const auto known = campaign.store.provenances();
  if (!known) return {known.error().message};
  if (known->empty()) return {};  // nothing has been made yet
  const auto text = read_file(campaign.files.provenance());
  if (!text) return {text.error().message};
  const auto json = parse_json(*text, campaign.files.provenance().string());
  if (!json) return {json.error().message};
  if (!json->is_object()) return {fmt::format("{} is not an object", kFile)};
  std::vector<std::string> wrong;
  compare_attempts(*json, *known, wrong);
  if (prepared == nullptr) return wrong;
  Json overrides = Json::array();
  for (const Override& change : prepared->source.overrides) {
    overrides.push_back(change.path + "=" + change.value);
  }
  compare(*json, "config_sha256", sha256_hex(prepared->source.text), wrong);
  compare(*json, "overrides", overrides, wrong);
  compare(*json, "seed", prepared->settings.seed, wrong);
  compare_table(*json, "assets", asset_hashes(used), wrong);
  compare_table(*json, "textures", image_hashes(used), wrong);
  return wrong;
}

Result<bool> traced_like_here(const JobStore& store) {
  const auto known = store.provenances();
  if (!known) return forward_error(known);
  return std::all_of(known->begin(), known->end(), [](const std::string& text) {
    const Json attempt = Json::parse(text, nullptr, false);
    return attempt.is_object() && attempt.value("twin_isa", "") == ray_tracing_isa() &&
           attempt.value("libraries", Json::object()).value("embree", "") == ray_tracing_version();
  });
}

}  // namespace seedframe
