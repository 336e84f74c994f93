// SHA-256 of files, each of which is read once.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "base/allowed_folders.h"
#include "base/error.h"

namespace seedframe {

struct HashedFile {
  std::filesystem::path path;
  std::string sha256;
};

/// Safe to use from several threads.
class FileHashes {
 public:
  /// Refuses files outside of `allowed` (kInput).
  Result<std::shared_ptr<const HashedFile>> of(const std::filesystem::path& file,
                                               const AllowedFolders& allowed);

 private:
  std::mutex mutex_;
  std::unordered_map<std::string, std::shared_ptr<const HashedFile>> hashed_;  ///< by path
};

}  // namespace seedframe
