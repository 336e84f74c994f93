// One process at a time works in a folder: one scheduler per campaign.
#pragma once

#include <chrono>
#include <filesystem>

#include "base/error.h"

namespace seedframe {

/// Holds an flock on a file in the folder; the system lets go of it when the process ends, however
/// it ends, so a dead scheduler leaves no lock behind.
class FolderLock {
 public:
  /// kInput errors: another process holds it; something else than a file has its name.
  /// `patience` outlasts those who only look whether it is held.
  static Result<FolderLock> acquire(
      const std::filesystem::path& file,
      std::chrono::milliseconds patience = std::chrono::milliseconds(200));
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : descriptor_(other.descriptor_) {
    other.descriptor_ = -1;
  }
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace seedframe
