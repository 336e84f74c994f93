#include "base/folder_lock.h"

#include <cerrno>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace seedframe {

Result<FolderLock> FolderLock::acquire(const std::filesystem::path& file,
                                       std::chrono::milliseconds patience) {
  // Through a link, a file would be made or locked wherever somebody wants it.
  const int descriptor =
      ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0644);
  const int error = errno;
  std::error_code ignored;
  const std::filesystem::file_status what = std::filesystem::symlink_status(file, ignored);
  if (std::filesystem::exists(what) && !std::filesystem::is_regular_file(what)) {
    if (descriptor >= 0) ::close(descriptor);
    return fail(ErrorKind::kInput,
                "{} is not a plain file, as a folder's lock is: remove it, and try again",
                file.string());
  }
  if (descriptor < 0) {
    return fail(ErrorKind::kEnvironment, "cannot open {}: {}", file.string(), std::strerror(error));
  }
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    ::close(descriptor);
    return fail(ErrorKind::kInput,
                "another seedframe is at work on {}: wait for it, or stop it with Ctrl-C",
                file.parent_path().string());
  }
  return FolderLock(descriptor);
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace seedframe
