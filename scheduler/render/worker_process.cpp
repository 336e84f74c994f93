#include "render/worker_process.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "render/child_process.h"

namespace seedframe {
namespace {

constexpr std::size_t kLongestLine = 1 << 20;
constexpr off_t kLargestLog = 4 << 20;
constexpr off_t kTailBytes = 2000;

void set_non_blocking(int fd) { fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK); }

off_t size_of(int fd) {
  struct stat info {};
  return fstat(fd, &info) == 0 ? info.st_size : 0;
}

/// Blender computes vertex normals (before 4.0) with as many threads as there were CPUs for it when
/// it started, and adds them up in whatever order the threads come: the last bits differ from run
/// to run. Started on one CPU it computes them in order; the worker script then takes back all
/// CPUs, and Cycles uses its own number of threads (docs/determinism.md). Starts take turns, so
/// that workers that start together do not share one CPU.
int next_start_cpu() {
  static std::atomic<std::size_t> starts = 0;
  const std::vector<int> cpus = allowed_cpus();
  return cpus.empty() ? -1 : cpus[starts++ % cpus.size()];
}

Result<int> open_log(const std::filesystem::path& path) {
  const int log = open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (log < 0) {
    return fail(ErrorKind::kEnvironment, "cannot open the worker log {}: {}", path.string(),
                std::strerror(errno));
  }
  return log;
}

}  // namespace

std::vector<std::string> worker_arguments(const WorkerCommand& command) {
  const std::string channel = std::to_string(kChildChannel);
  return {command.blender.string(),
          "--background",
          "--factory-startup",
          "--disable-autoexec",
          "-noaudio",
          "--threads",
          std::to_string(command.threads),
          "--python-exit-code",
          "3",
          "--python",
          (command.scripts / "render_worker.py").string(),
          "--",
          "--read-fd",
          channel,
          "--write-fd",
          channel,
          "--cpus",
          fmt::format("{}", fmt::join(allowed_cpus(), ","))};
}

Result<std::unique_ptr<WorkerProcess>> WorkerProcess::start(const WorkerCommand& command) {
  const Result<int> log = open_log(command.log);
  if (!log) return forward_error(log);
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    close(*log);
    return fail(ErrorKind::kEnvironment, "cannot make a channel to a worker: {}",
                std::strerror(errno));
  }
  set_non_blocking(ends[0]);
  ChildCommand child;
  child.arguments = worker_arguments(command);
  child.environment = worker_environment({command.environment.begin(), command.environment.end()});
  child.output = *log;
  child.channel = ends[1];
  child.cpu = next_start_cpu();
  const off_t log_begin = size_of(*log);
  const Result<pid_t> pid = start_child(child);
  close(ends[1]);
  if (!pid) {
    close(ends[0]);
    close(*log);
    return forward_error(pid);
  }
  return std::unique_ptr<WorkerProcess>(new WorkerProcess(*pid, ends[0], *log, log_begin));
}

WorkerProcess::WorkerProcess(pid_t pid, int channel, int log, off_t log_begin)
    : pid_(pid), channel_(channel), log_(log), log_begin_(log_begin) {}

WorkerProcess::~WorkerProcess() {
  end(std::chrono::milliseconds(0));
  close(log_);
}

void WorkerProcess::send(std::string_view line) {
  unsent_ += line;
  send_more();
}

void WorkerProcess::send_more() {
  while (!unsent_.empty()) {
    // A dead worker must not raise SIGPIPE here; that it is dead shows when receiving.
    const ssize_t bytes = ::send(channel_, unsent_.data(), unsent_.size(), MSG_NOSIGNAL);
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) {
      if (errno != EAGAIN && errno != EWOULDBLOCK) unsent_.clear();
      return;
    }
    unsent_.erase(0, static_cast<std::size_t>(bytes));
  }
}

bool WorkerProcess::receive(std::vector<std::string>& lines) {
  std::array<char, 1 << 16> buffer;
  bool open = true;
  while (open) {
    const ssize_t bytes = read(channel_, buffer.data(), buffer.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
    if (bytes <= 0) {
      open = false;
    } else {
      received_.append(buffer.data(), static_cast<std::size_t>(bytes));
      if (received_.size() > kLongestLine) open = false;
    }
  }
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = received_.find('\n', begin)) != std::string::npos;) {
    lines.push_back(received_.substr(begin, end - begin));
    begin = end + 1;
  }
  received_.erase(0, begin);
  return open;
}

void WorkerProcess::close_channel() {
  if (channel_ >= 0) close(channel_);
  channel_ = -1;
}

std::string WorkerProcess::end(std::chrono::milliseconds patience) {
  close_channel();
  if (ended_) return "has ended";
  ended_ = true;
  std::optional<int> status = wait_for_child(pid_, patience);
  if (!status) status = kill_child(pid_);
  return describe_wait_status(status);
}

std::string WorkerProcess::log_tail() const {
  const off_t size = size_of(log_);
  const off_t own_begin = log_begin_ <= size ? log_begin_ : 0;  // the log was started anew
  const off_t begin = std::max(own_begin, size - kTailBytes);
  std::string text(static_cast<std::size_t>(size - begin), '\0');
  const ssize_t bytes = pread(log_, text.data(), text.size(), begin);
  text.resize(bytes < 0 ? 0 : static_cast<std::size_t>(bytes));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

void WorkerProcess::bound_log() {
  if (size_of(log_) <= kLargestLog) return;
  if (ftruncate(log_, 0) == 0) log_begin_ = 0;
}

}  // namespace seedframe
