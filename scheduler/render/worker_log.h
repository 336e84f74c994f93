// What one worker process prints, of bounded size on disk and in memory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace seedframe {

/// Appends to a file. When that has grown to 4 MiB it becomes "<name>.1", in place of an older one,
/// and a new one begins. That it cannot be written (a full disk) stops nothing: the last 64 KiB are
/// kept in memory too.
class WorkerLog {
 public:
  static Result<WorkerLog> open(const std::filesystem::path& path);
  ~WorkerLog();
  WorkerLog(WorkerLog&& other) noexcept;
  WorkerLog& operator=(WorkerLog&&) = delete;

  void append(std::string_view bytes);

  /// The last of what was appended to this object, at most so many bytes, without line feeds at its
  /// end.
  std::string tail(std::size_t most = kKept) const;

  static constexpr std::size_t kKept = 64 << 10;

 private:
  WorkerLog(std::filesystem::path path, int file, std::size_t size)
      : path_(std::move(path)), file_(file), size_(size) {}
  void begin_anew();

  std::filesystem::path path_;
  int file_;
  std::size_t size_;  ///< of the file, bytes
  std::string kept_;  ///< up to twice kKept, so that it is seldom moved
};

}  // namespace seedframe
