// One Blender process and the channel to it. Never blocks; knows nothing of frames.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "base/error.h"

namespace seedframe {

struct WorkerCommand {
  std::filesystem::path blender;
  std::filesystem::path scripts;
  std::filesystem::path log;  ///< is appended to
  int threads = 1;
  std::map<std::string, std::string> environment;  ///< on top of worker_environment
};

/// The command line, for logs and for `seedframe explain`.
std::vector<std::string> worker_arguments(const WorkerCommand& command);

class WorkerProcess {
 public:
  /// Returns at once; that the program could be executed shows only by its "ready". The worker dies
  /// with the calling thread.
  static Result<std::unique_ptr<WorkerProcess>> start(const WorkerCommand& command);
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// To poll for POLLIN, and for POLLOUT while has_unsent().
  int channel() const { return channel_; }

  void send(std::string_view line);
  bool has_unsent() const { return !unsent_.empty(); }
  void send_more();

  /// Takes what has come and appends its complete lines, without line feeds. False once the worker
  /// has closed the channel (it is dead or dying), or sends a line without end.
  bool receive(std::vector<std::string>& lines);

  /// Asks the worker to end, by closing the channel.
  void close_channel();
  /// Gives it so long to end by itself and kills it then. How it ended, for a message.
  std::string end(std::chrono::milliseconds patience);

  /// The last lines that this process wrote to its log.
  std::string log_tail() const;
  /// Starts the log anew when it has grown beyond a few megabytes.
  void bound_log();

 private:
  WorkerProcess(pid_t pid, int channel, int log, off_t log_begin);

  pid_t pid_;
  bool ended_ = false;
  int channel_;
  int log_;
  off_t log_begin_;  ///< where this process' output begins
  std::string received_;
  std::string unsent_;
};

}  // namespace seedframe
