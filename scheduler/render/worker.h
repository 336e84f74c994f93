// What renders frames, as the pool sees it: processes of this machine (local_executor.h), later
// jobs of a cluster; in tests a fake with a clock of its own.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "render/message.h"

namespace seedframe {

/// How a worker ended.
struct WorkerEnd {
  std::string how;             ///< "exited with status 3", for a message
  bool out_of_memory = false;  ///< the system killed it for lack of memory
};

/// One that has been started. No call waits for it. Destroying it ends it at once.
class Worker {
 public:
  virtual ~Worker() = default;

  /// Lines with their line feeds (message.h). That nobody reads them shows by receive.
  virtual void send(std::string_view lines) = 0;
  /// Appends the complete lines that have come, without line feeds. False once no more can come: it
  /// is dead, dying or sends a line without end.
  virtual bool receive(std::vector<std::string>& lines) = 0;
  /// The end of what it has printed, at most so many bytes.
  virtual std::string log_tail(std::size_t most) const = 0;

  /// Tells it that nothing more is sent, and makes it end if it has not done so after `patience`.
  /// Nothing is received any more.
  virtual void stop(std::chrono::milliseconds patience) = 0;
  /// Without any patience.
  virtual void kill() = 0;
  /// After stop or kill: how it ended, once it has, or has been given up as impossible to end.
  virtual std::optional<WorkerEnd> end() = 0;
};

/// Where workers come from, and the clock that they are measured by.
class Executor {
 public:
  using Clock = std::chrono::steady_clock;
  virtual ~Executor() = default;

  /// Returns at once; whether a worker comes of it shows by its "ready". Numbers count from 0; one
  /// is used again when its worker is gone. An error ends the run.
  virtual Result<std::shared_ptr<Worker>> start(int number) = 0;
  /// Whether one that says this of itself is as it was to be; an error ends the run.
  virtual Status check(const ReadyMessage& ready) const = 0;

  virtual Clock::time_point now() const = 0;
  /// Sleeps until a worker has something to receive or has ended, wake was called since the last
  /// wait, or the deadline has come. It may return sooner.
  virtual void wait(Clock::time_point deadline) = 0;
  /// From any thread, async-signal-safe.
  virtual void wake() = 0;
};

}  // namespace seedframe
