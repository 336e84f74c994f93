#include "export/export_folder.h"

#include <fstream>

#include <fcntl.h>
#include <linux/fs.h>
#include <stdio.h>

#include "base/files.h"
#include "export/export_index.h"

namespace seedframe {
namespace fs = std::filesystem;
namespace {

Status remove_tree(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) {
    return fail(ErrorKind::kEnvironment, "cannot remove {}: {}", path.string(), error.message());
  }
  return {};
}

/// Whether the folder may be replaced: it is not there, empty, or an export.
Status check_replaceable(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error) || fs::exists(folder / kMarkerFile, error)) return {};
  if (fs::is_directory(folder, error) && fs::is_empty(folder, error)) return {};
  return fail(
      ErrorKind::kInput,
      "{} is there already and is not an export of Seedframe (it has no {}): choose another "
      "output folder, or move it away",
      folder.string(), kMarkerFile);
}

}  // namespace

ExportFolder::ExportFolder(fs::path partial, fs::path destination)
    : partial_(std::move(partial)), destination_(std::move(destination)) {}

ExportFolder::ExportFolder(ExportFolder&& other) noexcept
    : partial_(std::exchange(other.partial_, {})),
      destination_(std::move(other.destination_)),
      made_(std::move(other.made_)) {}

ExportFolder::~ExportFolder() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove_all(partial_, ignored);
}

Result<ExportFolder> ExportFolder::create(const fs::path& output, const std::string& name) {
  fs::path destination = output / name;
  if (Status free = check_replaceable(destination); !free) return forward_error(free);
  fs::path partial = output / ("." + name + ".partial");
  // What an export that was killed has left.
  if (Status removed = remove_tree(partial); !removed) return forward_error(removed);
  if (Status made = make_folders(partial); !made) {
    return tl::unexpected(
        Error{made.error().kind, made.error().message + ": -o names another place for exports"});
  }
  return ExportFolder(std::move(partial), std::move(destination));
}

Status ExportFolder::make_folder(const fs::path& relative) {
  const std::lock_guard lock(made_->mutex);
  if (!made_->paths.insert(relative).second) return {};
  return make_folders(partial_ / relative);
}

Status ExportFolder::write(const fs::path& relative, std::string_view bytes) {
  if (Status made = make_folder(relative.parent_path()); !made) return made;
  std::ofstream stream(partial_ / relative, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) {
    return fail(ErrorKind::kEnvironment, "cannot write {}", (partial_ / relative).string());
  }
  return {};
}

Status ExportFolder::place(const fs::path& source, const fs::path& relative, bool link) {
  if (Status made = make_folder(relative.parent_path()); !made) return made;
  std::error_code error;
  if (link) {
    fs::create_hard_link(source, partial_ / relative, error);
    if (!error) return {};
  }
  fs::copy_file(source, partial_ / relative, error);
  if (error) {
    return fail(ErrorKind::kEnvironment, "cannot copy {} to {}: {}", source.string(),
                (partial_ / relative).string(), error.message());
  }
  return {};
}

Status ExportFolder::commit(std::string_view marker) {
  if (Status written = write(kMarkerFile, marker); !written) return written;
  if (Status synced = sync_filesystem(partial_); !synced) return synced;
  // Exchanging the two names leaves no moment without an export.
  const int exchanged =
      ::renameat2(AT_FDCWD, partial_.c_str(), AT_FDCWD, destination_.c_str(), RENAME_EXCHANGE);
  if (exchanged == 0) {
    if (Status removed = remove_tree(partial_); !removed) return removed;
  } else if (Status renamed = commit_folder(partial_, destination_); !renamed) {
    // There is no old export, or the file system cannot exchange names.
    return renamed;
  }
  partial_.clear();
  return sync_path(destination_.parent_path());
}

}  // namespace seedframe
