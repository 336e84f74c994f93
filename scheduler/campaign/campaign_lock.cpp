#include "campaign/campaign_lock.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace seedframe {

Result<CampaignLock> CampaignLock::acquire(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    return fail(ErrorKind::kEnvironment, "cannot open {}: {}", file.string(), std::strerror(errno));
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor);
    return fail(ErrorKind::kInput,
                "another seedframe is at work on {}: wait for it, or stop it with Ctrl-C",
                file.parent_path().string());
  }
  return CampaignLock(descriptor);
}

CampaignLock::~CampaignLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace seedframe
