#include "base/machine_folder.h"

#include <cerrno>
#include <cstdlib>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/files.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kOwn = "task-";

fs::path lock_of(const fs::path& own) { return own / "lock"; }

fs::path usual_folder() {
  const char* variable = std::getenv("TMPDIR");
  const fs::path temporary = variable == nullptr || *variable == '\0' ? "/tmp" : variable;
  return temporary / fmt::format("seedframe-{}", ::getuid());
}

/// Ours alone: in /tmp, somebody else may have made it before.
Status make_private(const fs::path& folder) {
  if (folder.has_parent_path()) {
    if (Status made = make_folders(folder.parent_path()); !made) return made;
  }
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
    return system_failure("create", folder, errno);
  }
  struct stat info = {};
  if (::lstat(folder.c_str(), &info) != 0) return system_failure("look at", folder, errno);
  if (S_ISDIR(info.st_mode) && info.st_uid == ::getuid() && (info.st_mode & 0022) == 0) return {};
  return fail(
      ErrorKind::kEnvironment,
      "{} is not a folder that only this user may write to: remove it, or name another place "
      "with TMPDIR (for tasks of Slurm with --node-folder)",
      folder.string());
}

}  // namespace

Result<MachineFolder> MachineFolder::open(const fs::path& wanted) {
  MachineFolder machine(wanted.empty() ? usual_folder() : wanted);
  if (Status made = make_private(machine.root_); !made) return forward_error(made);
  for (const fs::path& folder : {machine.assets(), machine.meshes()}) {
    if (Status made = make_folders(folder); !made) return forward_error(made);
  }
  machine.remove_abandoned();
  return machine;
}

void MachineFolder::remove_abandoned() const {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(root_, ignored)) {
    if (!entry.path().filename().string().starts_with(kOwn)) continue;
    if (!fs::exists(lock_of(entry.path()), ignored)) continue;  // just being made
    const auto lock = FolderLock::acquire(lock_of(entry.path()), std::chrono::milliseconds(0));
    if (lock) fs::remove_all(entry.path(), ignored);
  }
}

Result<MachineFolder::Own> MachineFolder::make_own() const {
  std::string name = (root_ / (std::string(kOwn) + "XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr) return system_failure("create", name, errno);
  Result<FolderLock> lock = FolderLock::acquire(lock_of(name));
  if (!lock) return forward_error(lock);
  return Own(name, std::move(*lock));
}

MachineFolder::Own::~Own() {
  if (path_.empty()) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace seedframe
