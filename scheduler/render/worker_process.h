// One Blender process, the channel to it and its log. Never blocks; knows nothing of frames.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "base/error.h"
#include "render/worker_log.h"
#include "render/worker_options.h"

namespace seedframe {

/// How a worker ended.
struct WorkerEnd {
  std::string how;                ///< "exited with status 3", for a message
  bool killed_by_others = false;  ///< SIGKILL, and not ours
};

class WorkerProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Worker `number` of a pool. Returns at once; that the program could be executed shows only by
  /// its "ready". The worker dies with the calling thread.
  static Result<std::unique_ptr<WorkerProcess>> start(const WorkerOptions& options, int number);
  /// Kills it if it has not ended.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  // To poll for POLLIN; -1 when closed.
  int channel() const { return channel_; }  ///< also for POLLOUT, while has_unsent()
  int log_pipe() const { return log_pipe_; }
  int end_event() const { return pid_fd_; }  ///< readable once the process has ended

  void send(std::string_view line);
  bool has_unsent() const { return !unsent_.empty(); }
  void send_more();

  /// Takes what has come and appends its complete lines, without line feeds. False once the worker
  /// has closed the channel (it is dead or dying), or sends a line without end.
  bool receive(std::vector<std::string>& lines);

  /// Moves what it printed into its log; of a worker that prints without end, a part.
  void read_log();
  /// The last lines that this process printed.
  std::string log_tail(std::size_t most) const { return log_.tail(most); }

  /// Asks it to end: closes the channel, sends SIGTERM after `patience` and SIGKILL half a second
  /// later, each by take_end_steps.
  void begin_end(std::chrono::milliseconds patience);
  /// Without any patience.
  void kill();
  /// When take_end_steps has something to do, should the process not end before.
  Clock::time_point next_end_step() const { return next_step_; }
  /// Goes on with what begin_end or kill began, as far as it is time. How the process ended, once
  /// it has; also when not even SIGKILL ends it (it is stuck in the kernel, and left behind).
  std::optional<WorkerEnd> take_end_steps();

 private:
  enum class Signal { kNone, kTerminate, kKill };

  WorkerProcess(pid_t pid, int pid_fd, int channel, int log_pipe, WorkerLog log);
  void close_channel();
  void send_signal(Signal signal, std::chrono::milliseconds time_for_it);

  pid_t pid_;
  int pid_fd_;
  int channel_;
  int log_pipe_;
  WorkerLog log_;
  std::optional<WorkerEnd> end_;
  Signal sent_ = Signal::kNone;
  Clock::time_point next_step_ = Clock::time_point::max();
  std::string received_;
  std::string unsent_;
};

}  // namespace seedframe
