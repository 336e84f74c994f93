// One scheduler per campaign.
#pragma once

#include <chrono>
#include <filesystem>

#include "base/error.h"

namespace seedframe {

/// Holds an flock on campaign.lock; the system lets go of it when the process ends, however it
/// ends, so a dead scheduler leaves no lock behind.
class CampaignLock {
 public:
  /// kInput errors: another process holds it; something else than a file has its name.
  /// `patience` outlasts those who only look whether it is held.
  static Result<CampaignLock> acquire(
      const std::filesystem::path& file,
      std::chrono::milliseconds patience = std::chrono::milliseconds(200));
  ~CampaignLock();
  CampaignLock(CampaignLock&& other) noexcept : descriptor_(other.descriptor_) {
    other.descriptor_ = -1;
  }
  CampaignLock& operator=(CampaignLock&&) = delete;

 private:
  explicit CampaignLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace seedframe
