#include "base/files.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace seedframe {
namespace fs = std::filesystem;
namespace {

/// `sync` forces an open descriptor to the disk and returns 0, or sets errno.
Status sync_by(int (*sync)(int), const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return system_failure("open", path, errno);
  const int result = sync(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (result != 0) return system_failure("sync", path, error);
  return {};
}

/// `finish` gets the descriptor at the end: 0, or -1 and errno.
template <class Finish>
Status write_file_and(const Finish& finish, int flags, const fs::path& path,
                      std::string_view bytes) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | flags, 0644);
  if (descriptor < 0) return system_failure("write", path, errno);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      ::close(descriptor);
      return system_failure("write", path, error);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  const int finished = finish(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (finished != 0) return system_failure("finish writing", path, error);
  return {};
}

}  // namespace

ErrorKind kind_of_errno(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
    case EIO:
    case EROFS:
    case EMFILE:
    case ENFILE:
    case ENOMEM:
      return ErrorKind::kExhausted;
    default:
      return ErrorKind::kEnvironment;
  }
}

tl::unexpected<Error> system_failure(const char* action, const fs::path& path, int error) {
  return fail(kind_of_errno(error), "cannot {} {}: {}", action, path.string(),
              std::strerror(error));
}

Result<std::string> read_file(const fs::path& path, std::uintmax_t most) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    return fail(ErrorKind::kEnvironment, "cannot read {}: it is a folder", path.string());
  }
  // A pipe would be waited for, a device read without end.
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return fail(ErrorKind::kInput, "cannot read {}: it is a device, a pipe or a socket, no file",
                path.string());
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return system_failure("read", path, errno == 0 ? EIO : errno);
  const auto too_large = [&] {
    return fail(ErrorKind::kInput,
                "{} has more than {} bytes, the most that are read of such a file", path.string(),
                most);
  };
  std::string bytes;
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > most) return too_large();
  if (!error) bytes.reserve(size);
  std::array<char, 1 << 16> chunk{};
  while (stream.read(chunk.data(), chunk.size()) || stream.gcount() > 0) {
    bytes.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > most) return too_large();
  }
  if (stream.bad()) return system_failure("read", path, EIO);
  return bytes;
}

Status sync_path(const fs::path& path) { return sync_by(::fsync, path); }

Status sync_filesystem(const fs::path& path) { return sync_by(::syncfs, path); }

Status write_file(const fs::path& path, std::string_view bytes) {
  return write_file_and(::fsync, O_CREAT | O_TRUNC, path, bytes);
}

Status write_file_unsynced(const fs::path& path, std::string_view bytes) {
  return write_file_and([](int) { return 0; }, O_CREAT | O_TRUNC, path, bytes);
}

Status overwrite_file_unsynced(const fs::path& path, std::string_view bytes) {
  struct stat there {};
  if (::lstat(path.c_str(), &there) == 0 && there.st_nlink > 1) {
    return system_failure("overwrite", path, EMLINK);
  }
  const auto size = static_cast<off_t>(bytes.size());
  return write_file_and([size](int descriptor) { return ::ftruncate(descriptor, size); }, 0, path,
                        bytes);
}

Status write_file_atomically(const fs::path& path, std::string_view bytes) {
  fs::path temporary = path;
  temporary += ".tmp";
  if (Status written = write_file(temporary, bytes); !written) return written;
  return rename_file(temporary, path);
}

Status rename_file(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) return system_failure("replace", to, errno);
  return sync_path(to.has_parent_path() ? to.parent_path() : fs::path("."));
}

Status replace_folder(const fs::path& temporary, const fs::path& final) {
  if (::rename(temporary.c_str(), final.c_str()) == 0) return {};
  if (errno != ENOTEMPTY && errno != EEXIST) return system_failure("rename to", final, errno);
  std::error_code error;
  fs::remove_all(final, error);
  if (::rename(temporary.c_str(), final.c_str()) != 0) {
    return system_failure("rename to", final, errno);
  }
  return {};
}

Status commit_folder(const fs::path& temporary, const fs::path& final) {
  if (Status synced = sync_path(temporary); !synced) return synced;
  if (Status replaced = replace_folder(temporary, final); !replaced) return replaced;
  return sync_path(final.parent_path());
}

Status make_folders_in(const fs::path& root, const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(root, error)) return make_folders(path);
  return fail(ErrorKind::kEnvironment, "{} is gone: the folder was moved or removed meanwhile",
              root.string());
}

Status make_folders(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) return system_failure("make the folder", path, error.value());
  return {};
}

}  // namespace seedframe
