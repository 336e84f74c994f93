#include "frames/take_rendered.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/files.h"
#include "frames/rendered_frame.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// An open folder.
class HeldFolder {
 public:
  HeldFolder(int parent, const char* name)
      : descriptor_(::openat(parent, name, O_DIRECTORY | O_NOFOLLOW | O_RDONLY | O_CLOEXEC)) {}
  ~HeldFolder() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  HeldFolder(const HeldFolder&) = delete;
  HeldFolder& operator=(const HeldFolder&) = delete;

  int descriptor() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }

 private:
  int descriptor_;
};

/// False if there is none.
Result<bool> take_file(const HeldFolder& from, const fs::path& to) {
  if (::renameat(from.descriptor(), to.filename().c_str(), AT_FDCWD, to.c_str()) != 0) {
    if (errno == ENOENT) return false;
    return fail(ErrorKind::kEnvironment, "cannot move what a worker rendered to {}: {}",
                to.string(), std::strerror(errno));
  }
  struct stat info = {};
  if (::lstat(to.c_str(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_nlink != 1) {
    return fail(ErrorKind::kRender, "the worker's {} is not a plain file of its own",
                to.filename().string());
  }
  return true;
}

}  // namespace

Status take_rendered(const fs::path& workers, const std::string& name, const fs::path& attempt) {
  if (Status made = make_folders(attempt); !made) return made;
  const HeldFolder all(AT_FDCWD, workers.c_str());
  const HeldFolder own(all.descriptor(), name.c_str());
  if (!own.is_open()) {
    return fail(ErrorKind::kRender,
                "the folder that the worker was given, {}, is gone or another one",
                (workers / name).string());
  }
  const fs::path passes = rendered_passes(attempt);
  const Result<bool> taken = take_file(own, passes);
  if (!taken) return forward_error(taken);
  if (!*taken) {
    return fail(ErrorKind::kRender, "the worker said 'done' and left no {}",
                passes.filename().string());
  }
  const Result<bool> sharp = take_file(own, sharp_passes(passes));
  if (!sharp) return forward_error(sharp);
  std::error_code ignored;
  fs::remove_all(workers / name, ignored);  // follows no links
  return {};
}

}  // namespace seedframe
