// Which folders a campaign may read from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace seedframe {

/// Folders with all that lies below them. A config and an asset may come from a stranger: what they
/// name is opened only after check().
class AllowedFolders {
 public:
  /// Nothing is allowed.
  AllowedFolders() = default;
  explicit AllowedFolders(const std::vector<std::filesystem::path>& folders);

  /// Keeps where the folder lies once symbolic links are followed; a relative path starts at the
  /// working directory.
  void add(const std::filesystem::path& folder);

  /// Refuses (kInput) a path that leads out of all folders once symbolic links and ".." are
  /// followed, and one that leads to a device, a pipe or a socket. What does not exist passes: who
  /// opens it says so. `what` begins the message.
  Status check(const std::filesystem::path& path, const std::string& what) const;

  /// Canonical, in the order in which they were added.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }

 private:
  std::vector<std::filesystem::path> folders_;
};

}  // namespace seedframe
