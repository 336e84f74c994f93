// Reading whole files, and writing files and folders so that a crash leaves the old one or the new
// one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace seedframe {

/// "cannot <action> <path>: <why>", for an errno. kExhausted when it may pass by itself or by
/// making room: a full, failing or read-only disk, too many open files, no memory. Otherwise
/// kEnvironment.
tl::unexpected<Error> system_failure(const char* action, const std::filesystem::path& path,
                                     int error);
/// As system_failure judges it.
ErrorKind kind_of_errno(int error);

/// The most bytes that are read of any file as a whole.
inline constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 30;

/// A file of more than `most` bytes is an error (kInput), as is one without an end, such as a
/// device.
Result<std::string> read_file(const std::filesystem::path& path,
                              std::uintmax_t most = kLargestFile);

/// Writes `bytes` to `path` and forces them to the disk. A symbolic link there is an error, or
/// somebody could have another file overwritten. Not atomic: for files inside a folder that is
/// itself renamed into place.
Status write_file(const std::filesystem::path& path, std::string_view bytes);

/// write_file without the wait for the disk: the caller must call sync_filesystem before anything
/// depends on the file.
Status write_file_unsynced(const std::filesystem::path& path, std::string_view bytes);

/// The same for a file that is there, which is not emptied first: ext4 waits for the disk when a
/// file was empty on the way, and finds room for new files slowly where many were removed. An error
/// if the file has other names, under which it would change too.
Status overwrite_file_unsynced(const std::filesystem::path& path, std::string_view bytes);

/// Writes beside `path`, forces to disk and renames over it.
Status write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Gives a file that is on the disk another name, and forces that to the disk; a file that has the
/// name already is replaced.
Status rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Forces a file's contents, or a folder's entries, to the disk.
Status sync_path(const std::filesystem::path& path);

/// Forces all that was written to the file system of `path`, by anybody, to the disk: one wait for
/// any number of files, folders and renames.
Status sync_filesystem(const std::filesystem::path& path);

/// Renames a folder; one that already has the final name is replaced.
Status replace_folder(const std::filesystem::path& temporary, const std::filesystem::path& final);

/// Renames a finished folder to its final name and forces the rename to the disk.
/// A folder that already has the final name is replaced.
Status commit_folder(const std::filesystem::path& temporary, const std::filesystem::path& final);

Status make_folders(const std::filesystem::path& path);
/// The same, for a folder somewhere in `root`, which is not made: a kEnvironment error if it is
/// gone, say because somebody moved it while we write there.
Status make_folders_in(const std::filesystem::path& root, const std::filesystem::path& path);

}  // namespace seedframe
