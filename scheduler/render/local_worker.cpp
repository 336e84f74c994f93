#include "render/local_worker.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/files.h"

namespace seedframe {
namespace {

constexpr std::size_t kLongestLine = 1 << 20;
constexpr int kLogPipeBytes = 1 << 20;
constexpr auto kTimeForTerminate = std::chrono::milliseconds(500);
constexpr auto kTimeForKill = std::chrono::seconds(10);

void set_non_blocking(int fd) { fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK); }

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

/// Our ends and the worker's of channel and log; what is still open when this dies is closed.
struct Pipes {
  std::array<int, 2> channel = {-1, -1};  ///< ours, the worker's
  std::array<int, 2> log = {-1, -1};      ///< ours (to read), the worker's

  ~Pipes() {
    for (const int fd : {channel[0], channel[1], log[0], log[1]}) {
      if (fd >= 0) close(fd);
    }
  }
  Status make() {
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, channel.data()) != 0 ||
        pipe2(log.data(), O_CLOEXEC) != 0) {
      return fail(kind_of_errno(errno), "cannot make a channel to a worker: {}",
                  std::strerror(errno));
    }
    set_non_blocking(channel[0]);
    set_non_blocking(log[0]);
    fcntl(log[0], F_SETPIPE_SZ, kLogPipeBytes);  // so that a chatty worker seldom waits for us
    return {};
  }
};

std::vector<std::string> arguments_of(const WorkerOptions& options) {
  const std::string channel = std::to_string(kChildChannel);
  std::vector<std::string> arguments = options.wrapper;
  for (std::string& each : blender_command(options.blender, options.scripts, options.threads,
                                           options.scripts / "render_worker.py")) {
    arguments.push_back(std::move(each));
  }
  arguments.insert(arguments.end(), {"--read-fd", channel, "--write-fd", channel, "--cpus",
                                     fmt::format("{}", fmt::join(allowed_cpus(), ","))});
  if (options.conditions.device != RenderDevice::kCpu) {
    arguments.insert(arguments.end(), {"--device", name_of(options.conditions.device)});
  }
  if (options.conditions.persistent_data) arguments.emplace_back("--persistent-data");
  return arguments;
}

/// `number` tells who looks at processes which worker this one is.
std::vector<std::string> whole_environment(const WorkerOptions& options, int number) {
  std::map<std::string, std::string> changes = options.environment;
  changes["SEEDFRAME_WORKER"] = std::to_string(number);
  changes.merge(environment_of(options.conditions, options.preload));
  return worker_environment({changes.begin(), changes.end()});
}

}  // namespace

Result<std::shared_ptr<LocalWorker>> LocalWorker::start(const WorkerOptions& options, int number) {
  Result<WorkerLog> log = WorkerLog::open(options.log_path(number));
  if (!log) return forward_error(log);
  Pipes pipes;
  if (Status made = pipes.make(); !made) return forward_error(made);
  ChildCommand child;
  child.arguments = arguments_of(options);
  child.environment = whole_environment(options, number);
  child.output = pipes.log[1];
  child.channel = pipes.channel[1];
  child.cpu = next_start_cpu();
  child.limits = options.limits;
  child.ignores_terminate = options.ignores_terminate;
  const Result<pid_t> pid = start_child(child);
  if (!pid) return forward_error(pid);
  const int pid_fd = static_cast<int>(syscall(SYS_pidfd_open, *pid, 0));  // close-on-exec by itself
  const int error = errno;
  std::shared_ptr<LocalWorker> worker(
      new LocalWorker(*pid, pid_fd, std::exchange(pipes.channel[0], -1),
                      std::exchange(pipes.log[0], -1), std::move(*log)));
  worker->out_of_memory_kills_ = options.out_of_memory_kills;
  worker->kills_before_ = options.out_of_memory_kills();
  if (pid_fd < 0) {
    return fail(kind_of_errno(error), "cannot watch a worker: {}", std::strerror(error));
  }
  return worker;
}

LocalWorker::LocalWorker(pid_t pid, int pid_fd, int channel, int log_pipe, WorkerLog log)
    : pid_(pid), pid_fd_(pid_fd), channel_(channel), log_pipe_(log_pipe), log_(std::move(log)) {}

LocalWorker::~LocalWorker() {
  close_channel();
  if (!end_) kill_child(pid_);
  read_log();
  if (log_pipe_ >= 0) close(log_pipe_);
  if (pid_fd_ >= 0) close(pid_fd_);
}

void LocalWorker::send(std::string_view lines) {
  unsent_ += lines;
  send_more();
}

void LocalWorker::send_more() {
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

bool LocalWorker::receive(std::vector<std::string>& lines) {
  std::array<char, 1 << 16> buffer;
  // What it has started may hold the channel open after it. Looked at before the last is read.
  pollfd process = {pid_fd_, POLLIN, 0};
  const bool lives = poll(&process, 1, 0) == 0;
  bool open = true;
  while (open) {
    const ssize_t bytes = read(channel_, buffer.data(), buffer.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      open = lives;
      break;
    }
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

void LocalWorker::close_channel() {
  if (channel_ >= 0) close(channel_);
  channel_ = -1;
}

void LocalWorker::add_events(std::vector<pollfd>& events) const {
  // poll(2) passes over descriptors that are closed.
  events.push_back({channel_, static_cast<short>(unsent_.empty() ? POLLIN : POLLIN | POLLOUT), 0});
  events.push_back({log_pipe_, POLLIN, 0});
  events.push_back({pid_fd_, POLLIN, 0});
}

void LocalWorker::move_bytes() {
  send_more();
  read_log();
}

void LocalWorker::read_log() {
  constexpr int kReads = 16;  // a megabyte
  std::array<char, 1 << 16> buffer;
  for (int i = 0; i < kReads && log_pipe_ >= 0; ++i) {
    const ssize_t bytes = read(log_pipe_, buffer.data(), buffer.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (bytes <= 0) {
      close(log_pipe_);
      log_pipe_ = -1;
      return;
    }
    log_.append({buffer.data(), static_cast<std::size_t>(bytes)});
  }
}

void LocalWorker::stop(std::chrono::milliseconds patience) {
  close_channel();
  if (sent_ == Signal::kNone) next_step_ = std::min(next_step_, Clock::now() + patience);
}

void LocalWorker::kill() {
  close_channel();
  if (sent_ != Signal::kKill) send_signal(Signal::kKill, kTimeForKill);
}

void LocalWorker::send_signal(Signal signal, std::chrono::milliseconds time_for_it) {
  ::kill(-pid_, signal == Signal::kKill ? SIGKILL : SIGTERM);
  sent_ = signal;
  next_step_ = Clock::now() + time_for_it;
}

std::optional<WorkerEnd> LocalWorker::end() {
  if (end_) return end_;
  const std::optional<int> status = wait_for_child(pid_, std::chrono::milliseconds(0));
  const bool due = Clock::now() >= next_step_;
  if (status) {
    const bool killed = WIFSIGNALED(*status) && WTERMSIG(*status) == SIGKILL;
    const bool by_others = killed && sent_ != Signal::kKill;
    end_ = WorkerEnd{describe_wait_status(status),
                     by_others && out_of_memory_kills_() > kills_before_};
    ::kill(-pid_, SIGKILL);  // whatever it has started
    read_log();
  } else if (due && sent_ == Signal::kKill) {
    end_ = WorkerEnd{describe_wait_status(status), false};
  } else if (due && sent_ == Signal::kTerminate) {
    send_signal(Signal::kKill, kTimeForKill);
  } else if (due) {
    send_signal(Signal::kTerminate, kTimeForTerminate);
  }
  return end_;
}

}  // namespace seedframe
