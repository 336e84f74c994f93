// Workers of several nodes in one store, which knows them by numbers.
#pragma once

#include <string>
#include <vector>

#include "base/canonical_json.h"
#include "base/files.h"
#include "frames/campaign_files.h"

namespace seedframe {

/// Worker w of the n-th node is kNodeWorkers × n + w.
inline constexpr int kNodeWorkers = 1000;

/// The campaign's nodes, by number; none if no frame of it came from another machine. kCorrupt: the
/// list is damaged.
inline Result<std::vector<std::string>> read_nodes(const CampaignFiles& files) {
  std::error_code missing;
  if (!std::filesystem::exists(files.nodes(), missing)) return std::vector<std::string>();
  const Result<std::string> text = read_file(files.nodes());
  if (!text) return forward_error(text);
  const Json json = Json::parse(*text, nullptr, false);
  try {
    return json.get<std::vector<std::string>>();
  } catch (const Json::exception&) {
    return fail(ErrorKind::kCorrupt, "{} is not a list of nodes", files.nodes().string());
  }
}

}  // namespace seedframe
