#include "render/worker_log.h"

#include <cerrno>
#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/files.h"

namespace seedframe {
namespace {

constexpr std::size_t kLargestLog = 4 << 20;
constexpr int kFlags = O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC;

}  // namespace

Result<WorkerLog> WorkerLog::open(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), kFlags, 0644);
  if (file < 0) return system_failure("write the worker log", path, errno);
  struct stat info {};
  const std::size_t size = fstat(file, &info) == 0 ? static_cast<std::size_t>(info.st_size) : 0;
  return WorkerLog(path, file, size);
}

WorkerLog::WorkerLog(WorkerLog&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      size_(other.size_),
      kept_(std::move(other.kept_)) {}

WorkerLog::~WorkerLog() {
  if (file_ >= 0) ::close(file_);
}

void WorkerLog::append(std::string_view bytes) {
  kept_ += bytes;
  if (kept_.size() > 2 * kKept) kept_.erase(0, kept_.size() - kKept);
  if (size_ + bytes.size() > kLargestLog && size_ > 0) begin_anew();
  if (file_ >= 0 && ::write(file_, bytes.data(), bytes.size()) > 0) size_ += bytes.size();
}

void WorkerLog::begin_anew() {
  std::filesystem::path old = path_;
  old += ".1";
  if (std::rename(path_.c_str(), old.c_str()) != 0) return;
  if (file_ >= 0) ::close(file_);
  file_ = ::open(path_.c_str(), kFlags, 0644);
  size_ = 0;
}

std::string WorkerLog::tail(std::size_t most) const {
  std::size_t end = kept_.size();
  while (end > 0 && kept_[end - 1] == '\n') --end;
  const std::size_t begin = end > most ? end - most : 0;
  return kept_.substr(begin, end - begin);
}

}  // namespace seedframe
