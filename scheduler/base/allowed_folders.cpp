#include "base/allowed_folders.h"

#include <algorithm>

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// Empty if links cannot be followed: they form a circle, or a folder on the way is locked.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path target = fs::weakly_canonical(fs::absolute(path.empty() ? "." : path, error), error);
  if (error) return {};
  return target.has_filename() ? target : target.parent_path();  // without a '/' at the end
}

/// Compares names of folders, not letters: /data2 is not below /data.
bool is_below(const fs::path& folder, const fs::path& target) {
  return std::mismatch(folder.begin(), folder.end(), target.begin(), target.end()).first ==
         folder.end();
}

bool is_special(const fs::path& target) {
  std::error_code missing;
  const fs::file_status status = fs::status(target, missing);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

AllowedFolders::AllowedFolders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) add(folder);
}

void AllowedFolders::add(const fs::path& folder) {
  fs::path target = resolved(folder);
  if (target.empty()) return;
  if (std::find(folders_.begin(), folders_.end(), target) != folders_.end()) return;
  folders_.push_back(std::move(target));
}

Status AllowedFolders::check(const fs::path& path, const std::string& what) const {
  // The system would read such a path only up to the NUL.
  if (path.native().find('\0') != std::string::npos) {
    return fail(ErrorKind::kInput, "{}: a path cannot contain a NUL character", what);
  }
  const fs::path target = resolved(path);
  if (target.empty()) {
    return fail(ErrorKind::kInput,
                "{}: cannot find out where {} leads: it is too long, has links in a circle, or is "
                "in a folder that may not be read",
                what, path.string());
  }
  const bool allowed = std::any_of(folders_.begin(), folders_.end(), [&](const fs::path& folder) {
    return is_below(folder, target);
  });
  if (!allowed) {
    std::string list;
    for (const fs::path& folder : folders_) {
      list += (list.empty() ? "" : ", ");
      list += folder.string();
    }
    return fail(ErrorKind::kInput,
                "{} leads to {}, which is outside of the folders that may be read ({}): move it "
                "into one of these, or allow another one with --allow DIR",
                what, target.string(), list);
  }
  if (is_special(target)) {
    return fail(ErrorKind::kInput,
                "{} leads to {}: expected a file or a folder, found a device, "
                "a pipe or a socket",
                what, target.string());
  }
  return {};
}

}  // namespace seedframe
