// Workers that are processes of this machine.
#pragma once

#include <memory>
#include <vector>

#include "render/local_worker.h"
#include "render/worker.h"

namespace seedframe {

class LocalExecutor : public Executor {
 public:
  explicit LocalExecutor(WorkerOptions options);
  ~LocalExecutor() override;
  LocalExecutor(const LocalExecutor&) = delete;
  LocalExecutor& operator=(const LocalExecutor&) = delete;

  /// The process dies with the thread that calls this.
  Result<std::shared_ptr<Worker>> start(int number) override;
  Status check(const ReadyMessage& ready) const override;
  Clock::time_point now() const override { return Clock::now(); }
  void wait(Clock::time_point deadline) override;
  void wake() override;

 private:
  /// Those that are still there.
  std::vector<std::shared_ptr<LocalWorker>> workers();

  WorkerOptions options_;
  int wake_fd_;
  std::vector<std::weak_ptr<LocalWorker>> started_;
};

}  // namespace seedframe
