// One Blender process, the channel to it and its log. Knows nothing of frames.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include "base/error.h"
#include "render/worker.h"
#include "render/worker_log.h"
#include "render/worker_options.h"

namespace seedframe {

class LocalWorker : public Worker {
 public:
  using Clock = std::chrono::steady_clock;

  /// Worker `number` of a pool. Returns at once; that the program could be executed shows only by
  /// its "ready". The worker dies with the calling thread.
  static Result<std::shared_ptr<LocalWorker>> start(const WorkerOptions& options, int number);
  ~LocalWorker() override;
  LocalWorker(const LocalWorker&) = delete;
  LocalWorker& operator=(const LocalWorker&) = delete;

  void send(std::string_view lines) override;
  bool receive(std::vector<std::string>& lines) override;
  std::string log_tail(std::size_t most) const override { return log_.tail(most); }
  /// Closes the channel, sends SIGTERM after `patience` and SIGKILL half a second later, each by
  /// end(). Should not even that end it (it is stuck in the kernel), it is left behind.
  void stop(std::chrono::milliseconds patience) override;
  void kill() override;
  std::optional<WorkerEnd> end() override;

  /// What poll(2) has to wait for.
  void add_events(std::vector<pollfd>& events) const;
  /// Sends what was left to be sent, and moves what the process printed into its log; of one that
  /// prints without end, a part.
  void move_bytes();
  /// When end() has something to do, should the process not end before.
  Clock::time_point next_end_step() const { return next_step_; }

 private:
  enum class Signal { kNone, kTerminate, kKill };

  LocalWorker(pid_t pid, int pid_fd, int channel, int log_pipe, WorkerLog log);
  void close_channel();
  void send_more();
  void read_log();
  void send_signal(Signal signal, std::chrono::milliseconds time_for_it);

  pid_t pid_;
  int pid_fd_;  ///< readable once the process has ended
  int channel_;
  int log_pipe_;
  WorkerLog log_;
  std::function<std::int64_t()> out_of_memory_kills_;
  std::int64_t kills_before_ = 0;  ///< of the kernel, when it was started
  std::optional<WorkerEnd> end_;
  Signal sent_ = Signal::kNone;
  Clock::time_point next_step_ = Clock::time_point::max();
  std::string received_;
  std::string unsent_;
};

}  // namespace seedframe
