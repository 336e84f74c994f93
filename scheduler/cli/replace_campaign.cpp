#include "cli/replace_campaign.h"

#include <algorithm>
#include <string>
#include <vector>

#include <unistd.h>

#include "base/files.h"
#include "campaign/campaign.h"
#include "console/say.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// What lies in the folder and belongs to no campaign.
std::vector<std::string> strange_entries(const CampaignFiles& files) {
  const std::vector<fs::path> own = files.own();
  std::vector<std::string> strange;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(files.root(), error)) {
    if (std::find(own.begin(), own.end(), entry.path()) == own.end()) {
      strange.push_back(entry.path().filename().string());
    }
  }
  std::sort(strange.begin(), strange.end());
  return strange;
}

/// How many frames would be lost; unknown where the store cannot be read.
std::string what_is_there(const fs::path& folder) {
  const Result<Campaign> campaign = open_campaign(folder);
  const Result<FrameCounts> counts =
      campaign ? campaign->store.counts() : Result<FrameCounts>(forward_error(campaign));
  if (!counts) return "a campaign whose job store cannot be read";
  return fmt::format("a campaign with {} finished frames of {}", counts->done, counts->total());
}

Status confirm(const std::string& what, const fs::path& folder) {
  if (::isatty(STDIN_FILENO) == 0) {
    return fail(ErrorKind::kInput, "{} holds {}: '--overwrite --yes' removes it without asking",
                folder.string(), what);
  }
  say_aside("{} holds {}. Remove it, with its exports and audits? [y/N] ", folder.string(), what);
  const int answer = std::getchar();
  if (answer == 'y' || answer == 'Y') return {};
  return fail(ErrorKind::kInput, "{} was left as it is", folder.string());
}

}  // namespace

Status clear_for_new_campaign(const fs::path& folder, bool yes) {
  const CampaignFiles files(folder);
  std::error_code error;
  if (!fs::exists(files.store(), error)) return {};
  const std::vector<std::string> strange = strange_entries(files);
  if (!strange.empty()) {
    return fail(ErrorKind::kInput, "{} holds what no campaign has ({}): move it away first",
                folder.string(), fmt::join(strange, ", "));
  }
  const Result<FolderLock> lock = FolderLock::acquire(files.lock());
  if (!lock) return forward_error(lock);
  if (!yes) {
    if (Status agreed = confirm(what_is_there(folder), folder); !agreed) return agreed;
  }
  // The store first: without it there is no campaign, whatever is left should this be interrupted.
  for (const fs::path& path : files.own()) {
    if (path == files.lock()) continue;
    fs::remove_all(path, error);
    if (error) return system_failure("remove", path, error.value());
  }
  return {};
}

}  // namespace seedframe
